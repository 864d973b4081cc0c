//! Joint forces of a mechanism with a loose joint: the Newton-Euler equations of each body, with accelerations from
//! differences of the rows' positions; no force without contact; the ideal joint as the limit.

use slider_crank::scene::{
    Branch, Clearance, ContactLaw, Crank, Every, Gravity, Joint, Load, Rod, Scene, Slider,
};
use slider_crank::simulate::{Options, Row, simulate_rows};

const CRANK: Crank = Crank {
    mass: 0.8,
    cg: 0.02,
    cg_lateral: -0.004,
    inertia: 4e-3,
};

fn rod() -> Rod {
    Rod {
        mass: 0.4,
        cg: 0.06,
        cg_lateral: 0.007,
        inertia: 9e-4,
        ..Rod::default()
    }
}

const SLIDER: Slider = Slider { mass: 0.3 };
const PUSH: f64 = -40.0;
const TORQUE: f64 = 1.5;

fn scene(joint: Joint, offset: f64, branch: Branch) -> Scene {
    let clearance = Clearance {
        bearing_radius: Some(0.01),
        // Stiffness of a plastic: contacts are long enough for exact differences over the rows.
        young_modulus: Some(2e9),
        poisson_ratio: Some(0.3),
        restitution: Some(0.8),
        ..Clearance::new(joint, 2e-4)
    };
    Scene {
        clearance: Some(clearance),
        ..Scene::new(0.05, 0.16)
            .offset(offset)
            .branch(branch)
            .crank(CRANK)
            .rod(rod())
            .slider(SLIDER)
            .gravity(Gravity {
                acceleration: 9.8,
                direction: -1.2,
            })
            .torque(Load::Constant(TORQUE))
            .force(Load::Constant(PUSH))
            .tolerance(1e-13)
    }
}

fn rows(scene: &Scene) -> Vec<Row> {
    let mut rows = Vec::new();
    let options = Options {
        estimate: false,
        reactions: true,
        driving_torque: true,
        ..Options::default()
    };
    simulate_rows(scene, &options, &mut rows).expect("a run");
    rows
}

type Vector = [f64; 2];

fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

fn times(factor: f64, a: Vector) -> Vector {
    [factor * a[0], factor * a[1]]
}

fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns a point at (along, left) in axes rotated by an angle.
fn turned([along, left]: Vector, angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    [along * cos - left * sin, along * sin + left * cos]
}

/// Positions of the bodies, from a row.
struct Places {
    crank: Vector,
    rod: Vector,
    slider: Vector,
    /// Direction of the rod, rad.
    psi: f64,
}

impl Places {
    fn new(scene: &Scene, row: &Row) -> Places {
        let g = &scene.geometry;
        let left = g.branch == Branch::Left;
        let psi = if left {
            std::f64::consts::PI + row.phi
        } else {
            -row.phi
        };
        let slider = [row.x, -g.offset];
        let pin = turned([g.crank, 0.0], row.theta);
        let rod = rod();
        let centre = match scene.clearance.expect("a loose joint").joint {
            Joint::CrankPin => plus(slider, turned([rod.cg - g.rod, rod.cg_lateral], psi)),
            Joint::WristPin => plus(pin, turned([rod.cg, rod.cg_lateral], psi)),
        };
        Places {
            crank: turned([CRANK.cg, CRANK.cg_lateral], row.theta),
            rod: centre,
            slider,
            psi,
        }
    }
}

/// Returns the second derivative at the middle of five values, to order 4.
fn second(values: [f64; 5], h: f64) -> f64 {
    let [a, b, c, d, e] = values;
    (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * h * h)
}

/// Returns the residual of each law at the middle of five rows, relative to the size of the forces.
fn residuals(scene: &Scene, rows: &[Row], h: f64) -> Vec<f64> {
    let places: Vec<Places> = rows.iter().map(|row| Places::new(scene, row)).collect();
    let values = |of: &dyn Fn(&Places) -> f64| second(std::array::from_fn(|i| of(&places[i])), h);
    let acceleration = |of: fn(&Places) -> Vector| [values(&|p| of(p)[0]), values(&|p| of(p)[1])];
    let crank = acceleration(|p| p.crank);
    let slider = acceleration(|p| p.slider);
    let centre = acceleration(|p| p.rod);
    let spin = values(&|p| p.psi);
    let alpha = second(std::array::from_fn(|i| rows[i].theta), h);
    let g = scene.gravity.expect("gravity").vector();
    let (row, place) = (&rows[2], &places[2]);
    let forces = row.reactions.expect("asked for");
    let needs = |mass: f64, a: Vector| times(mass, plus(a, times(-1.0, g)));
    let off = |sum: Vector, mass: f64, a: Vector| plus(sum, times(-1.0, needs(mass, a)));
    let on_crank = plus(forces.crank_bearing, times(-1.0, forces.crank_pin));
    let on_rod = plus(forces.crank_pin, times(-1.0, forces.wrist_pin));
    let on_slider = plus(forces.wrist_pin, [PUSH, forces.guide]);
    let outside = plus(forces.crank_bearing, [PUSH, forces.guide]);
    let momentum = plus(
        times(CRANK.mass, crank),
        plus(times(rod().mass, centre), times(SLIDER.mass, slider)),
    );
    let weights = times(CRANK.mass + rod().mass + SLIDER.mass, g);
    let mut found: Vec<f64> = [
        off(on_crank, CRANK.mass, crank),
        off(on_rod, rod().mass, centre),
        off(on_slider, SLIDER.mass, slider),
        plus(forces.shaking, momentum),
        plus(plus(outside, weights), forces.shaking),
    ]
    .concat();
    // Moments about the rod's centre of gravity: without friction the contact force acts along the line of the two
    // centres.
    let g = &scene.geometry;
    let own = rod();
    let from_centre = |along: f64| turned([along - own.cg, -own.cg_lateral], place.psi);
    let moment = cross(from_centre(0.0), forces.crank_pin)
        - cross(from_centre(g.rod), forces.wrist_pin)
        - own.inertia * spin;
    // Angular momentum about O, the crank's inertia being about O.
    let turning = CRANK.inertia * alpha
        + own.inertia * spin
        + own.mass * cross(place.rod, centre)
        + SLIDER.mass * cross(place.slider, slider);
    // Moments about O of the loads, the drive, the weights and the guide.
    let weight = |mass: f64, at: Vector| mass * cross(at, scene.gravity.expect("gravity").vector());
    let about = TORQUE
        + row.driving_torque.unwrap_or(0.0)
        + weight(CRANK.mass, place.crank)
        + weight(own.mass, place.rod)
        + cross(
            place.slider,
            plus([PUSH, forces.guide], weight_of_slider(scene)),
        );
    for residual in [moment, forces.shaking_moment + turning, about - turning] {
        found.push(residual / g.rod);
    }
    let size = 1.0 + forces.crank_bearing[0].hypot(forces.crank_bearing[1]) + forces.guide.abs();
    found.iter().map(|residual| residual.abs() / size).collect()
}

fn weight_of_slider(scene: &Scene) -> Vector {
    times(SLIDER.mass, scene.gravity.expect("gravity").vector())
}

#[test]
fn each_body_obeys_newton_and_euler() {
    let h = 2e-6;
    for joint in [Joint::CrankPin, Joint::WristPin] {
        for (offset, branch, speed, free) in [
            (0.01, Branch::Right, 70.0, false),
            (-0.02, Branch::Left, -90.0, false),
            (-0.01, Branch::Right, -60.0, true),
            (0.015, Branch::Left, 80.0, true),
        ] {
            let base = scene(joint, offset, branch)
                .duration(8e-3)
                .output_every(Every::Time(h));
            let scene = if free {
                base.start(0.7, speed)
            } else {
                base.constant_speed(0.7, speed)
            };
            let rows = rows(&scene);
            let force = |row: &Row| row.clearance.expect("a loose joint").force;
            // The last row is at the end, not one step after the previous row.
            let (mut pressed, mut flying) = (0, 0);
            for window in rows[..rows.len() - 1].windows(5).step_by(3) {
                let touching = window.iter().filter(|row| force(row) > 0.0).count();
                if touching != 0 && touching != 5 {
                    continue;
                }
                if touching == 5 {
                    pressed += 1
                } else {
                    flying += 1
                }
                for (law, off) in residuals(&scene, window, h).into_iter().enumerate() {
                    let t = window[2].t;
                    assert!(off < 2e-5, "{joint:?} {offset} law {law}: {off:e} at {t} s");
                }
            }
            assert!(pressed > 50 && flying > 300, "{pressed} {flying}");
        }
    }
}

#[test]
fn nothing_acts_in_a_joint_whose_parts_fly() {
    for joint in [Joint::CrankPin, Joint::WristPin] {
        let scene = scene(joint, 0.01, Branch::Right)
            .constant_speed(0.7, 70.0)
            .duration(0.05);
        let mut seen = [0; 2];
        for row in rows(&scene) {
            let forces = row.reactions.expect("asked for");
            let loose = match joint {
                Joint::CrankPin => forces.crank_pin,
                Joint::WristPin => forces.wrist_pin,
            };
            let contact = row.clearance.expect("a loose joint").force;
            let size = loose[0].hypot(loose[1]);
            assert!(
                (size - contact).abs() <= 1e-12 * contact,
                "{size} {contact}"
            );
            seen[usize::from(contact > 0.0)] += 1;
        }
        assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
    }
}

/// The longer joint makes a difference proportional to c. A link as short as c swings about the direction of the force,
/// which makes a difference proportional to √c.
#[test]
fn a_short_massless_link_carries_the_forces_of_the_ideal_joint() {
    for joint in [Joint::CrankPin, Joint::WristPin] {
        let mut ideal = scene(joint, 0.01, Branch::Right)
            .constant_speed(0.3, 60.0)
            .duration(0.006)
            .output_every(Every::Time(1e-4));
        ideal.clearance = None;
        let wanted = rows(&ideal);
        let all = |row: &Row| {
            let f = row.reactions.expect("asked for");
            [
                f.crank_bearing,
                f.crank_pin,
                f.wrist_pin,
                [f.guide, 0.0],
                f.shaking,
            ]
            .concat()
        };
        let off = |radial: f64| {
            let linked = Scene {
                clearance: Some(Clearance {
                    law: ContactLaw::MasslessLink,
                    ..Clearance::new(joint, radial)
                }),
                ..ideal.clone()
            };
            let found = rows(&linked);
            assert_eq!(found.len(), wanted.len());
            let (mut most, mut size) = (0.0, 0.0);
            for (got, want) in found.iter().zip(&wanted) {
                for (got, want) in all(got).iter().zip(all(want)) {
                    most = f64::max(most, (got - want).abs());
                    size = f64::max(size, want.abs());
                }
            }
            most / size
        };
        let (coarse, fine) = (off(1e-5), off(1e-7));
        assert!(
            fine < 1e-3 && (9.0..110.0).contains(&(coarse / fine)),
            "{coarse:e} {fine:e}"
        );
    }
}
