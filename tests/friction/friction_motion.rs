//! Motion with Coulomb friction: compared with closed solutions, with an independent integration of the Newton-Euler
//! equations, and with the energy balance.

use std::f64::consts::PI;

use crate::support::close;
use crate::support::machines::{self, leaning, rubbing};
use crate::support::random::{cases, magnitude};
use proptest::prelude::*;
use slider_crank::explain::explain;
use slider_crank::mechanism::Equation;
use slider_crank::plan::Method;
use slider_crank::scene::{
    Branch, Crank, Expression, Gravity, Instant, Load, Rod, Scene, Slider, Variables,
};
use slider_crank::simulate::{Options, Row, Simulation, simulate, simulate_rows};

fn run(scene: &Scene) -> Simulation {
    let run = simulate(scene, &Options::default()).expect("a run");
    assert_eq!(run.summary.stopped, None);
    run
}

fn kinds(run: &Simulation, kind: &str) -> usize {
    run.summary
        .events
        .iter()
        .filter(|event| event.kind == kind)
        .count()
}

/// Returns x of a massless crank and rod at a crank angle.
fn x(scene: &Scene, theta: f64) -> f64 {
    let g = &scene.geometry;
    let drop = g.offset + g.crank * theta.sin();
    g.crank * theta.cos() + g.branch.sign() * (g.rod * g.rod - drop * drop).sqrt()
}

/// A slider on a massless crank and rod carries its own weight: it decelerates by μ g and stays where it stops.
#[test]
fn a_slider_alone_stops_after_v2_over_2_mu_g() {
    for (branch, offset, up, theta, omega) in [
        (Branch::Right, 0.02, 1.0, 1.0, 5.0),
        (Branch::Left, -0.03, -1.0, 2.2, -4.0),
        (Branch::Right, 0.0, -1.0, 4.5, 3.0),
    ] {
        let weight = Gravity {
            acceleration: 9.81,
            direction: up * PI / 2.0,
        };
        let mut scene = rubbing(Scene::new(0.1, 0.3).offset(offset).branch(branch), 0.3, 0.4)
            .slider(Slider { mass: 2.0 })
            .start(theta, omega)
            .duration(1.0);
        scene.gravity = Some(weight);
        let rate = (x(&scene, theta + 1e-5) - x(&scene, theta - 1e-5)) / 2e-5;
        let v = rate * omega;
        let (stops, way) = (v.abs() / (0.3 * 9.81), v * v.abs() / (2.0 * 0.3 * 9.81));
        let run = run(&scene);
        let rest = &run.summary.events[0];
        assert_eq!((rest.kind, run.summary.events.len()), ("rest", 1));
        close("time of rest", rest.t_s, stops, 1.0, 1e-9);
        close(
            "place of rest",
            x(&scene, rest.theta_rad),
            x(&scene, theta) + way,
            1.0,
            1e-9,
        );
        assert_eq!(run.summary.last.theta_rad, rest.theta_rad);
        assert_eq!(run.summary.last.omega_rad_per_s, 0.0);
        assert_eq!(run.at(0.9), Some((rest.theta_rad, 0.0)));
        close(
            "half-way",
            x(&scene, run.at(0.5 * stops).unwrap().0),
            x(&scene, theta) + 0.75 * way,
            1.0,
            1e-9,
        );
    }
}

/// With a spring the amplitude decreases by 2 μ m g/k in each of hundreds of half swings.
#[test]
fn an_oscillator_with_dry_friction_loses_the_same_amplitude_in_each_half_swing() {
    let (mass, stiffness, mu, g) = (2.0, 800.0, 0.002, 9.81);
    let swings = |mu_static: f64, first: f64| {
        let mut scene = rubbing(Scene::new(0.1, 0.3), mu, mu_static)
            .slider(Slider { mass })
            .start(first, 0.0)
            .gravity(Gravity {
                acceleration: g,
                ..Gravity::standard()
            })
            .duration(150.0);
        scene.geometry.offset = 0.01;
        scene.run.tolerance = 1e-12;
        let middle = x(&scene, 1.6);
        scene.force(Load::Spring {
            stiffness,
            rest: middle,
        })
    };
    for (mu_static, first) in [(mu, 0.9), (2.0 * mu, 2.3)] {
        let scene = swings(mu_static, first);
        let middle = x(&scene, 1.6);
        let (band, kinetic) = (mu_static * mass * g / stiffness, mu * mass * g / stiffness);
        let mut amplitude = x(&scene, first) - middle;
        let mut halves = 0;
        while amplitude.abs() > band {
            amplitude = 2.0 * kinetic * amplitude.signum() - amplitude;
            halves += 1;
        }
        assert!(halves > 500, "{halves}");
        let options = Options {
            events_kept: 10_000,
            ..Options::default()
        };
        let run = simulate(&scene, &options).unwrap();
        assert_eq!(run.summary.stopped, None);
        assert_eq!(kinds(&run, "turning-point"), halves - 1);
        let rest = run.summary.events.last().unwrap();
        assert_eq!(rest.kind, "rest");
        let stated = run.summary.error_estimate.unwrap();
        close(
            "time of rest",
            rest.t_s,
            f64::from(halves as u32) * PI * (mass / stiffness).sqrt(),
            1.0,
            1e-7,
        );
        close(
            "place of rest",
            x(&scene, rest.theta_rad),
            middle + amplitude,
            1.0,
            1e-9,
        );
        assert!(stated.theta_rad < 1e-7, "{stated:?}");
        assert!(
            run.summary.energy_residual.abs() < 1e-9,
            "{}",
            run.summary.energy_residual
        );
    }
}

/// Bodies of the scenes with an independent reference.
fn machine() -> Scene {
    Scene::new(0.05, 0.15)
        .crank(Crank {
            mass: 1.0,
            cg: 0.01,
            cg_lateral: 0.005,
            inertia: 0.002,
        })
        .rod(Rod {
            mass: 0.5,
            cg: 0.06,
            cg_lateral: 0.01,
            inertia: 0.001,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.6 })
        .gravity(Gravity {
            acceleration: 9.81,
            ..Gravity::standard()
        })
}

/// Strategy for scenes with all kinds of loads; speeds, sizes and friction vary.
fn any_scene() -> impl Strategy<Value = Scene> {
    (
        (magnitude(0.02, 0.3), 1.15..5.0, -0.9..0.9, any::<bool>()),
        (
            magnitude(1e-4, 1e-2),
            magnitude(0.01, 2.0),
            -0.2..1.2,
            -0.3..0.3,
            magnitude(0.05, 3.0),
        ),
        (0.0..0.5, 1.0..1.5, -30.0..30.0, 0.0..6.2),
        (-2.0..2.0, -10.0..10.0, 0.0..300.0, 0.0..0.01, 1.0..20.0),
    )
        .prop_map(|(shape, bodies, motion, loads)| {
            let (crank, ratio, offset, left) = shape;
            let (inertia, mass, along, lateral, slider) = bodies;
            let (mu, more, omega, theta) = motion;
            let (torque, force, stiffness, damping, rate): (f64, f64, f64, f64, f64) = loads;
            let rod = crank * (ratio + 1.0);
            // Small enough to exclude jamming where the rod is steepest.
            let mu = mu * 0.4;
            rubbing(Scene::new(crank, rod), mu, mu * more)
                .offset(crank * offset * 0.5)
                .branch(if left { Branch::Left } else { Branch::Right })
                .crank(Crank {
                    inertia,
                    ..Crank::default()
                })
                .rod(Rod {
                    mass,
                    cg: along * rod,
                    cg_lateral: lateral * rod,
                    inertia: 0.1 * mass * rod * rod,
                    ..Rod::default()
                })
                .slider(Slider { mass: slider })
                .gravity(Gravity::standard())
                .torque(Load::Constant(torque * crank))
                .torque(Load::Viscous(damping * 0.1))
                .force(Load::Spring {
                    stiffness,
                    rest: if left { -rod } else { rod },
                })
                .force(Load::function(Variables::T, move |now| {
                    force * (rate * now.t).sin()
                }))
                .start(theta, omega)
                .duration(1.0)
        })
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn energy_balances_and_tolerances_agree(scene in any_scene()) {
        let run = simulate(&scene, &Options::default()).unwrap();
        prop_assume!(run.summary.stopped.is_none());
        prop_assert!(run.summary.energy_residual.abs() < 1e-7, "{:e}", run.summary.energy_residual);
        let mut finer = scene.clone();
        finer.run.tolerance = 1e-12;
        let options = Options { method: Method::Dopri5, ..Options::default() };
        let fine = simulate(&finer, &options).unwrap();
        let (a, b) = (run.summary.error_estimate.unwrap(), fine.summary.error_estimate.unwrap());
        let apart = (run.summary.last.theta_rad - fine.summary.last.theta_rad).abs();
        prop_assert!(apart <= 3.0 * (a.theta_rad + b.theta_rad), "{apart:e} {a:?} {b:?}");
    }

    #[test]
    fn the_mirror_image_moves_as_the_mechanism(scene in any_scene()) {
        // Mirror image about the x axis: angles, offset, torques and gravity change their signs.
        let here = run_unless_stopped(&scene);
        prop_assume!(here.is_some());
        let mut mirrored = scene.clone();
        mirrored.geometry.offset = -scene.geometry.offset;
        mirrored.motion.angle = -scene.motion.angle;
        mirrored.motion.speed = -scene.motion.speed;
        mirrored.gravity = Some(Gravity { direction: PI / 2.0, ..Gravity::standard() });
        mirrored.rod = scene.rod.map(|rod| Rod { cg_lateral: -rod.cg_lateral, ..rod });
        mirrored.torques[0] = match &scene.torques[0] {
            Load::Constant(torque) => Load::Constant(-torque),
            other => other.clone(),
        };
        let there = run_unless_stopped(&mirrored).expect("as the mechanism");
        let (a, b) = (here.unwrap(), there);
        let allowed = a.summary.error_estimate.unwrap().theta_rad + b.summary.error_estimate.unwrap().theta_rad;
        close("theta", a.summary.last.theta_rad, -b.summary.last.theta_rad, 1.0, allowed + 1e-9);
        prop_assert_eq!(a.summary.events_total, b.summary.events_total);
    }

    #[test]
    fn turned_half_round_the_branch_is_the_other(scene in any_scene()) {
        let here = run_unless_stopped(&scene);
        prop_assume!(here.is_some());
        let mut turned = scene.clone();
        turned.geometry.branch = match scene.geometry.branch {
            Branch::Right => Branch::Left,
            Branch::Left => Branch::Right,
        };
        turned.geometry.offset = -scene.geometry.offset;
        turned.motion.angle = scene.motion.angle + PI;
        turned.gravity = Some(Gravity { direction: PI / 2.0, ..Gravity::standard() });
        for load in &mut turned.forces {
            *load = match load.clone() {
                Load::Spring { stiffness, rest } => Load::Spring { stiffness, rest: -rest },
                Load::Function { reads, function, .. } => Load::function(reads, move |now: &Instant| -function(now)),
                other => other,
            };
        }
        let (a, b) = (here.unwrap(), run_unless_stopped(&turned).expect("as the mechanism"));
        let allowed = a.summary.error_estimate.unwrap().theta_rad + b.summary.error_estimate.unwrap().theta_rad;
        close("theta", a.summary.last.theta_rad + PI, b.summary.last.theta_rad, 1.0, allowed + 1e-9);
    }

    #[test]
    fn units_do_not_matter(scene in any_scene(), length in magnitude(1e-3, 1e3), mass in magnitude(1e-3, 1e3)) {
        // Lengths and masses scaled in the same time: accelerations are proportional to the length.
        let here = run_unless_stopped(&scene);
        prop_assume!(here.is_some());
        let mut other = scene.clone();
        other.geometry.crank *= length;
        other.geometry.rod *= length;
        other.geometry.offset *= length;
        let inertia = mass * length * length;
        other.crank = scene.crank.map(|c| Crank { inertia: c.inertia * inertia, ..c });
        other.rod = scene.rod.map(|r| Rod {
            mass: r.mass * mass, cg: r.cg * length, cg_lateral: r.cg_lateral * length, inertia: r.inertia * inertia, ..r
        });
        other.slider = scene.slider.map(|s| Slider { mass: s.mass * mass });
        other.gravity = scene.gravity.map(|g| Gravity { acceleration: g.acceleration * length, ..g });
        for load in &mut other.torques {
            *load = match load.clone() {
                Load::Constant(torque) => Load::Constant(torque * inertia),
                Load::Viscous(damping) => Load::Viscous(damping * inertia),
                load => load,
            };
        }
        for load in &mut other.forces {
            *load = match load.clone() {
                Load::Spring { stiffness, rest } => Load::Spring { stiffness: stiffness * mass, rest: rest * length },
                Load::Function { reads, function, .. } => Load::function(reads, move |now: &Instant| function(now) * mass * length),
                load => load,
            };
        }
        let (a, b) = (here.unwrap(), run_unless_stopped(&other).expect("as the mechanism"));
        let allowed = a.summary.error_estimate.unwrap().theta_rad + b.summary.error_estimate.unwrap().theta_rad;
        close("theta", a.summary.last.theta_rad, b.summary.last.theta_rad, 1.0, allowed + 1e-9);
    }
}

/// The guide is left beside the dead centres in each of twelve turns. Expected: extrapolated midpoint rule in arithmetic of
/// 34 digits, with the changes of friction located to 1e-26 of the run.
#[test]
fn roundings_at_changes_of_the_guide_do_not_add_up() {
    let scene = Scene::new(0.027104097439608763, 0.07745552100589856)
        .branch(Branch::Left)
        .crank(Crank {
            inertia: 0.0006449339288692091,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.7537239018631658,
            cg: 0.05071713467074643,
            inertia: 0.0008828113441154161,
            ..Rod::default()
        })
        .slider(Slider {
            mass: 0.43000888510884133,
        })
        .torque(Load::Viscous(4.898107489524669e-7))
        .force(Load::Constant(-4.4213866839504146e-5))
        .force(Load::Viscous(0.00867811837199263))
        .start(2.0563609485469225, 4.7740250713686425)
        .duration(19.400708720063722)
        .tolerance(1e-9);
    let summary = run(&rubbing(scene, 0.3, 0.3)).summary;
    let stated = summary.error_estimate.expect("an estimate").theta_rad;
    let error = (summary.last.theta_rad - 73.945551403833).abs();
    assert!(
        error < 1e-13 && error < 2.0 * stated,
        "{error:e} {stated:e}"
    );
}

fn run_unless_stopped(scene: &Scene) -> Option<Simulation> {
    let run = simulate(scene, &Options::default()).expect("a run");
    let estimated = run.summary.error_estimate.is_some();
    (run.summary.stopped.is_none() && estimated).then_some(run)
}

/// Final states by another program: Newton-Euler equations of the three bodies with all joint forces unknown, friction
/// in the balance of the slider, both signs of the normal force tried, DOP853 of SciPy with events at 1e-13.
#[test]
fn newton_and_euler_integrated_elsewhere_arrive_at_the_same_states() {
    let coasting = rubbing(machine().offset(0.01), 0.2, 0.2)
        .start(0.3, 20.0)
        .duration(2.0);
    let left = rubbing(machine().offset(-0.02).branch(Branch::Left), 0.3, 0.3)
        .start(0.3, -20.0)
        .duration(1.0);
    let sticking = rubbing(machine().offset(0.01), 0.25, 0.35)
        .force(Load::function(Variables::T.or(Variables::X), |now| {
            12.0 * (9.0 * now.t).sin() - 60.0 * (now.x - 0.15)
        }))
        .start(0.9, 0.0)
        .duration(1.0);
    let fast = rubbing(machine().offset(0.01), 0.5, 0.5)
        .torque(Load::function(Variables::OMEGA, |now| {
            2.0 - 0.01 * now.omega
        }))
        .start(0.9, 40.0)
        .duration(0.5);
    for (what, scene, [theta, omega], tolerance) in [
        (
            "coasting",
            coasting,
            [11.361180140245594, -2.312730446496372],
            1e-9,
        ),
        ("left", left, [-9.521096109848157, 0.851702710690958], 1e-9),
        (
            "sticking",
            sticking,
            [1.1882117042847302, 6.446446970206754],
            2e-9,
        ),
        // With its 31 sign changes of the normal force, the other program has fewer digits.
        ("fast", fast, [48.4610754918868, 107.0321664381423], 2e-8),
    ] {
        let run = run(&scene);
        close(what, run.summary.last.theta_rad, theta, 1.0, tolerance);
        close(
            what,
            run.summary.last.omega_rad_per_s,
            omega,
            1.0,
            20.0 * tolerance,
        );
    }
}

/// The slider slips when the time-dependent force leaves the static band: F = 12 sin 9t − 60 (x − 0.15), with a
/// reference by the other program.
#[test]
fn a_sticking_slider_slips_when_its_static_band_is_left() {
    let scene = rubbing(machine().offset(0.01), 0.25, 0.35)
        .force(Load::function(Variables::T.or(Variables::X), |now| {
            12.0 * (9.0 * now.t).sin() - 60.0 * (now.x - 0.15)
        }))
        .start(0.9, 0.0)
        .duration(0.1);
    let events = run(&scene).summary.events;
    assert_eq!([events[0].kind, events[1].kind], ["stick", "slip"]);
    assert_eq!(events[0].t_s, 0.0);
    close("slip", events[1].t_s, 0.020585209, 1.0, 6e-10);
}

/// Beyond μ |dN/dF| = 1 the rigid-body equations have no unique solution: the run ends there with this reason. At rest
/// a guide may be self-locking.
#[test]
fn jamming_is_named() {
    // μ tan φ > 1 on part of the turn.
    let scene = |mu: f64| rubbing(leaning(0.2), mu, mu).gravity(Gravity::standard());
    let run = simulate(&scene(1.5).start(0.3, 6.0), &Options::default()).unwrap();
    let why = run.summary.stopped.expect("jams").to_string();
    assert!(why.contains("jams") && why.contains("t = "), "{why}");
    assert!(run.summary.last.t_s > 0.0 && run.summary.last.t_s < 1.0);
    assert!(run.summary.energy_residual.abs() < 1e-6);
    let locked = simulate(&scene(1.5).start(1.4, 0.0), &Options::default()).unwrap();
    assert_eq!(locked.summary.events[0].kind, "rest");
}

/// Tiny coefficients of friction have no visible effect; zero ones have none at all.
#[test]
fn friction_of_no_strength_is_left_out() {
    let scene = machine().offset(0.01).start(0.3, 20.0).duration(0.5);
    let plain = run(&scene);
    let none = run(&rubbing(scene.clone(), 0.0, 0.0));
    assert_eq!(plain.summary.last, none.summary.last);
    assert_eq!(plain.summary.engine, none.summary.engine);
    let little = run(&rubbing(scene, 1e-13, 1e-13));
    assert_eq!(little.summary.engine, "angle");
    close(
        "theta",
        little.summary.last.theta_rad,
        plain.summary.last.theta_rad,
        1.0,
        1e-9,
    );
}

/// Rows of a free and of a driven motion: the external forces change the momentum, and the guide force along x is
/// Coulomb's.
#[test]
fn rows_hold_the_friction_in_their_forces() {
    let free = rubbing(machine().offset(0.01), 0.3, 0.3)
        .start(0.3, 30.0)
        .duration(0.4);
    let mut driven = free.clone();
    driven.motion.kind = slider_crank::scene::MotionKind::ConstantSpeed;
    for scene in [free, driven] {
        let options = Options {
            reactions: true,
            driving_torque: true,
            ..Options::default()
        };
        let mut rows: Vec<Row> = Vec::new();
        simulate_rows(&scene, &options, &mut rows).unwrap();
        assert!(rows.len() > 100);
        for row in rows.iter().filter(|row| row.v.abs() > 1e-6) {
            let forces = row.reactions.unwrap();
            let along = -forces.shaking[0] - forces.crank_bearing[0];
            let size = 1.0 + forces.guide.abs() + forces.crank_bearing[0].abs();
            close(
                "friction",
                along,
                -0.3 * row.v.signum() * forces.guide.abs(),
                size,
                1e-10,
            );
            let weight = -9.81 * (1.0 + 0.5 + 0.6);
            let across = -forces.shaking[1] - forces.crank_bearing[1] - weight;
            close("guide", forces.guide, across, size, 1e-10);
            if let Some(torque) = row.driving_torque {
                // The power of the drive is the rate of energy plus the friction loss.
                let equation = Equation::new(&scene);
                let rate =
                    equation.driving_torque(row.t, row.theta, row.omega, row.alpha) * row.omega;
                close(
                    "power",
                    torque * row.omega,
                    rate - along * row.v,
                    size,
                    1e-9,
                );
            }
        }
    }
}

/// If only the crank has mass, the guide is loaded by the rod alone: N = R tan φ for the transmitted force R. The
/// holding torque of `explain` is checked by hand.
#[test]
fn torques_that_hold_the_crank_are_explained_with_friction() {
    let (push, inertia, mu, mu_static) = (-100.0, 2e-3, 0.2, 0.3);
    for branch in [Branch::Right, Branch::Left] {
        for (theta, omega) in [
            (0.7, 10.0),
            (0.7, -10.0),
            (2.9, 3.0),
            (4.0, 0.0),
            (0.3, 0.0),
        ] {
            let scene = rubbing(Scene::new(0.05, 0.15).offset(0.01), mu, mu_static)
                .branch(branch)
                .crank(Crank {
                    inertia,
                    ..Crank::default()
                })
                .force(Load::Constant(push))
                .start(theta, omega)
                .duration(1.0);
            let at = explain(&scene, Method::Auto, Some(theta))
                .unwrap()
                .at
                .unwrap();
            let found = at.friction.expect("friction");
            let lean = (0.01 + 0.05 * theta.sin()) / 0.15;
            let tan = lean.abs() / (1.0 - lean * lean).sqrt();
            let v = at.dx_m_per_rad * omega;
            let friction_of = |torque: f64| -torque / at.dx_m_per_rad - push;
            let coulomb = |force: f64, mu: f64| mu * (push + force).abs() * tan;
            close(
                "without",
                at.holding_torque_nm,
                -push * at.dx_m_per_rad,
                1.0,
                1e-14,
            );
            let (min, max) = (found.holding_min_nm.unwrap(), found.holding_max_nm.unwrap());
            let force = found.force_n.unwrap();
            let alpha = (push + force) * at.dx_m_per_rad / inertia;
            close(
                "alpha",
                at.alpha_rad_per_s2.unwrap(),
                alpha,
                alpha.abs(),
                1e-12,
            );
            if omega != 0.0 {
                assert_eq!(min, max);
                let held = friction_of(min);
                assert!(held * v < 0.0 && force * v < 0.0);
                close("held", held.abs(), coulomb(held, mu), 100.0, 1e-13);
                close("free", force.abs(), coulomb(force, mu), 100.0, 1e-13);
            } else {
                assert!(min < at.holding_torque_nm && at.holding_torque_nm < max);
                for edge in [min, max].map(friction_of) {
                    close("edge", edge.abs(), coulomb(edge, mu_static), 100.0, 1e-13);
                }
            }
        }
    }
}

/// Where rod and crank are nearly equal, a guide jams in less than a degree about 90 degrees: no step may pass over it.
/// Reference: extrapolation of order 18 in extended precision of the Newton-Euler equations, up to the pole.
#[test]
fn narrow_jams_are_found_at_loose_tolerances() {
    let scene = rubbing(
        Scene::new(0.05, 0.050001930598226677),
        0.012741256034837617,
        0.012741256034837617,
    )
    .branch(Branch::Right)
    .crank(Crank {
        mass: 0.858240050442654,
        cg: -0.01768004300901173,
        cg_lateral: 0.00014871466378840563,
        inertia: 0.09774423503132741,
    })
    .rod(Rod {
        mass: 0.4035519785636702,
        cg: 0.02000077223929067,
        inertia: 8.071662860693735e-05,
        ..Rod::default()
    })
    .slider(Slider {
        mass: 0.7518749458852683,
    })
    .gravity(Gravity {
        acceleration: 9.81,
        direction: -PI / 2.0,
    })
    .start(-0.22623442820099424, 6.630393821621469)
    .duration(0.6365196470746058);
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-8] {
        let scene = scene.clone().tolerance(tolerance);
        let run = simulate(&scene, &Options::default()).expect("a run");
        let stopped = run.summary.stopped.expect("it jams");
        let why = stopped.to_string();
        assert!(why.contains("more than one"), "{tolerance}: {why}");
        let t = run.summary.last.t_s;
        close(
            "time of jamming",
            t,
            0.273235037,
            1.0,
            1e-9 + 1e-2 * tolerance,
        );
    }
}

/// A jump of a load releases the slider in the direction of the load after it.
#[test]
fn a_jump_releases_the_slider_in_its_direction() {
    let machine = Scene::new(0.1, 0.3)
        .crank(Crank {
            inertia: 0.01,
            ..Crank::default()
        })
        .slider(Slider { mass: 1.0 });
    let scene = rubbing(machine, 0.2, 0.2)
        .gravity(Gravity {
            acceleration: 10.0,
            direction: -PI / 2.0,
        })
        .force(Load::Constant(1.0))
        .torque(Load::Expression(
            Expression::parse("2*step(t - 0.3)").expect("a formula"),
        ))
        .start(1.0, 0.0)
        .duration(0.35);
    let run = run(&scene);
    let kinds: Vec<_> = run.summary.events.iter().map(|event| event.kind).collect();
    assert_eq!(kinds, ["stick", "slip"]);
    close("release", run.summary.events[1].t_s, 0.3, 1.0, 1e-14);
}

/// A slider that jams ends its motion at a place, and the motion up to there has an error as any.
#[test]
fn the_motion_up_to_a_jam_has_an_error() {
    for (lengths, mu, speed) in [
        ([0.05, 0.06, 0.0], 1.2, 30.0),
        ([0.05, 0.06, 0.008], 0.9, -45.0),
        ([0.05, 0.0501, 0.0], 0.1, 20.0),
        ([0.08, 0.07, 0.0], 0.7, 20.0),
    ] {
        for viscous in [0.0, 0.002] {
            let scene = rubbing(
                machines::machine(lengths, false, [0.5, 0.4, 0.8], 0.0),
                mu,
                mu,
            )
            .gravity(Gravity::standard())
            .torque(Load::Viscous(viscous))
            .start(0.1, speed)
            .duration(1.0);
            let with = |tolerance| {
                let scene = scene.clone().tolerance(tolerance);
                simulate(&scene, &Options::default())
                    .expect("a run")
                    .summary
            };
            let reference = with(1e-14);
            let why = reference.stopped.expect("jams").to_string();
            assert!(why.contains("jams"), "{why}");
            for tolerance in [1e-5, 1e-8, 1e-11] {
                let cut = with(tolerance);
                let lead = reference.last.omega_rad_per_s * (cut.last.t_s - reference.last.t_s);
                let error = (cut.last.theta_rad - reference.last.theta_rad - lead).abs();
                let stated = cut.error_estimate.expect("an estimate").theta_rad;
                assert!(
                    error <= 2.0 * stated && stated <= 4.0 * error + 2e-12,
                    "{error:e} {stated:e} at {tolerance:e}"
                );
            }
        }
    }
}
