//! Coulomb friction at the guide of a mechanism with a loose joint: compared with an integration by another program,
//! with Coulomb's law on the rows, with the energy balance, and with a slider in flight.

use crate::support::machines::engine;
use slider_crank::scene::{Branch, Clearance, Every, Friction, Joint, Load, Scene, Slider};
use slider_crank::simulate::{Options, Row, Summary, simulate, simulate_rows};

const GRAVITY: f64 = 9.80665;
const SLIDER: f64 = 0.3;

fn scene(joint: Joint, branch: Branch, offset: f64, [kinetic, at_rest]: [f64; 2]) -> Scene {
    let clearance = Clearance {
        bearing_radius: Some(0.01),
        young_modulus: Some(2e9),
        poisson_ratio: Some(0.3),
        restitution: Some(0.8),
        ..Clearance::new(joint, 2e-4)
    };
    Scene {
        clearance: Some(clearance),
        friction: Some(Friction {
            coefficient: kinetic,
            static_coefficient: at_rest,
        }),
        ..engine(offset)
            .branch(branch)
            .slider(Slider { mass: SLIDER })
            .tolerance(1e-12)
    }
}

fn run(scene: &Scene) -> Summary {
    simulate(scene, &Options::default()).expect("a run").summary
}

fn rows(scene: &Scene) -> Vec<Row> {
    let mut rows = Vec::new();
    let options = Options {
        estimate: false,
        reactions: true,
        ..Options::default()
    };
    simulate_rows(scene, &options, &mut rows).expect("a run");
    rows
}

/// Results of another program: virtual work in the coordinates θ, ψ, x and y of the slider, the guide by its reaction,
/// the classical Runge-Kutta method with steps of 5 ns; impacts, reversals and slips located by secants. With steps of
/// 10 ns its numbers differ by relative 1e-6 at most. At the end: θ, x, v, energy lost; numbers of impacts, sticks,
/// slips.
struct Reference {
    scene: Scene,
    push: f64,
    last: [f64; 4],
    events: [usize; 3],
}

fn references() -> [Reference; 4] {
    let wrist = |branch, offset| scene(Joint::WristPin, branch, offset, [0.3, 0.4]);
    let crank = |branch, offset, at_rest| scene(Joint::CrankPin, branch, offset, [0.3, at_rest]);
    [
        Reference {
            scene: crank(Branch::Left, -0.015, 0.3).start(3.07, 12.0),
            push: 0.0,
            last: [
                3.3139676071089506,
                -0.20771608485420803,
                0.22853355220417274,
                0.0040001187799592565,
            ],
            events: [4, 1, 1],
        },
        Reference {
            scene: crank(Branch::Right, 0.01, 0.4).constant_speed(0.7, -60.0),
            push: 25.0,
            last: [
                -0.5,
                0.20349757101689,
                -1.6775874394592267,
                0.18214781641379643,
            ],
            events: [4, 0, 0],
        },
        Reference {
            scene: wrist(Branch::Left, 0.01).start(2.7, 5.0),
            push: 25.0,
            last: [
                2.7723861690054625,
                -0.20397600693827003,
                -0.02296632260521539,
                0.01045105531009021,
            ],
            events: [3, 1, 1],
        },
        Reference {
            scene: wrist(Branch::Right, 0.02).constant_speed(-2.8, 4.0),
            push: -30.0,
            last: [
                -2.72,
                0.11420266108311308,
                0.11693481771071973,
                0.009155048515426381,
            ],
            events: [3, 1, 1],
        },
    ]
}

#[test]
fn motions_with_sticking_agree_with_another_integration() {
    for (number, reference) in references().into_iter().enumerate() {
        let mut scene = reference.scene.duration(0.02);
        if reference.push != 0.0 {
            scene = scene.force(Load::Constant(reference.push));
        }
        let summary = run(&scene);
        let count = |kind: &str| summary.events.iter().filter(|e| e.kind == kind).count();
        assert_eq!(
            ["impact", "stick", "slip"].map(count),
            reference.events,
            "{number}"
        );
        let joint = summary.clearance.expect("a loose joint");
        let found = [
            summary.last.theta_rad,
            joint.last.x_m,
            joint.last.v_m_per_s,
            joint.dissipated_j,
        ];
        for (got, want) in found.iter().zip(reference.last) {
            let error = (got / want - 1.0).abs();
            assert!(error < 2e-6, "{number}: {got} instead of {want}");
        }
        let residual = summary.energy_residual;
        assert!(residual.abs() < 1e-9, "{number}: {residual:e}");
    }
}

/// In the equation of the slider, the force besides that of the wrist pin is friction according to Coulomb's law.
#[test]
fn rows_obey_coulomb() {
    let (kinetic, at_rest) = (0.3, 0.4);
    for joint in [Joint::CrankPin, Joint::WristPin] {
        for (offset, branch, speed, free) in [
            (0.01, Branch::Right, 12.0, false),
            (-0.02, Branch::Left, -90.0, false),
            (-0.01, Branch::Right, -40.0, true),
            (0.015, Branch::Left, 6.0, true),
        ] {
            let base = scene(joint, branch, offset, [kinetic, at_rest])
                .duration(0.2)
                .output_every(Every::Time(5e-5));
            let scene = match free {
                true => base.start(0.7, speed),
                false => base.constant_speed(0.7, speed),
            };
            let (mut sliding, mut held) = (0, 0);
            for row in rows(&scene) {
                let forces = row.reactions.expect("asked for");
                let friction = SLIDER * row.a - forces.wrist_pin[0];
                let normal = forces.guide.abs();
                let size = 1.0 + normal + forces.wrist_pin[0].abs();
                if row.v == 0.0 {
                    held += 1;
                    assert!(friction.abs() <= at_rest * normal + 1e-9 * size, "{row:?}");
                    assert_eq!(row.a, 0.0);
                } else {
                    sliding += 1;
                    let off = friction + kinetic * normal * row.v.signum();
                    assert!(off.abs() < 1e-9 * size, "{off:e} {row:?}");
                }
            }
            assert!(sliding > 100, "{sliding} sliding, {held} held");
        }
    }
}

/// A slider in flight is decelerated by μ g, from its own weight on the guide.
#[test]
fn a_slider_that_flies_is_slowed_by_its_weight() {
    let scene = scene(Joint::WristPin, Branch::Right, 0.01, [0.3, 0.3])
        .constant_speed(0.7, 70.0)
        .duration(0.1);
    let mut apart = 0;
    for row in rows(&scene) {
        if row.clearance.expect("a loose joint").force > 0.0 || row.v == 0.0 {
            continue;
        }
        apart += 1;
        let want = -0.3 * GRAVITY * row.v.signum();
        assert!((row.a - want).abs() < 1e-12 * GRAVITY, "{} {want}", row.a);
        let guide = row.reactions.expect("asked for").guide;
        assert!((guide - SLIDER * GRAVITY).abs() < 1e-12, "{guide}");
    }
    assert!(apart > 50, "{apart}");
}

/// Very small friction leaves the motion unchanged, and larger friction dissipates more energy.
#[test]
fn friction_takes_energy_and_little_of_it_takes_little() {
    let lost = |mu: f64| {
        let scene = scene(Joint::WristPin, Branch::Right, 0.01, [mu, mu])
            .start(0.7, 50.0)
            .duration(4e-3);
        let summary = run(&scene);
        assert!(summary.energy_residual.abs() < 1e-9);
        let joint = summary.clearance.expect("a loose joint");
        (joint.dissipated_j, joint.last.x_m)
    };
    let ((none, x), (little, near), (much, _)) = (lost(0.0), lost(1e-6), lost(0.5));
    assert!((x - near).abs() < 1e-8 && little >= none && little - none < 1e-5);
    assert!(much > none + 1e-3, "{none} {much}");
}

/// A very light slider, pressed by the weight of the rod, with high friction: no acceleration is consistent.
#[test]
fn a_slider_that_jams_is_said_to() {
    let mut scene = scene(Joint::CrankPin, Branch::Right, 0.08, [3.0, 3.0])
        .start(0.9, 20.0)
        .duration(0.05);
    scene.slider = Some(Slider { mass: 1e-3 });
    let stopped = run(&scene).stopped.expect("no motion").to_string();
    assert!(stopped.contains("jams"), "{stopped}");
}
