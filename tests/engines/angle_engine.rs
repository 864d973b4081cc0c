//! Angle engine compared with closed solutions and with integration in time.

use std::f64::consts::{PI, TAU};

use crate::support::machines::machine;
use proptest::prelude::*;
use slider_crank::plan::Method;
use slider_crank::scene::{Branch, Crank, Every, Expression, Gravity, Load, Scene, Variables};
use slider_crank::simulate::{Options, Row, Simulation, simulate, simulate_rows};

fn run(scene: &Scene, method: Method) -> Simulation {
    let options = Options {
        method,
        ..Options::default()
    };
    simulate(scene, &options).unwrap()
}

/// Crank alone, braked by viscous torque: θ̇ = ω0 e^(−kt), θ = ω0/k (1 − e^(−kt)).
#[test]
fn a_braked_crank_follows_its_closed_solution() {
    let (inertia, damping, speed) = (0.02, 0.03, 80.0);
    let k = damping / inertia;
    for direction in [1.0, -1.0] {
        let scene = Scene::new(0.05, 0.2)
            .crank(Crank {
                inertia,
                ..Crank::default()
            })
            .torque(Load::Viscous(damping))
            .start(0.4, direction * speed)
            .duration(1.5);
        let result = run(&scene, Method::Auto);
        assert_eq!(result.summary.engine, "angle");
        let stated = result.summary.error_estimate.unwrap();
        for i in 0..=30 {
            let t = 1.5 * f64::from(i) / 30.0;
            let (theta, omega) = result.at(t).unwrap();
            let angle = 0.4 + direction * speed / k * (1.0 - (-k * t).exp());
            assert!(
                (theta - angle).abs() < 2.0 * stated.theta_rad.max(1e-13),
                "{t}"
            );
            let error = (omega - direction * speed * (-k * t).exp()).abs();
            // Inside the run the speed series are resolved to a hundredth of the tolerance.
            let resolved = 0.01 * scene.run.tolerance * omega.abs();
            assert!(
                error < 2.0 * stated.omega_rad_per_s.max(resolved),
                "{t} {error:e}"
            );
        }
        assert!(result.summary.energy_residual.abs() < 1e-13);
    }
}

/// A run of whole turns ends at the end of a panel, where the accuracy is best: rows inside panels have their own
/// error.
#[test]
fn the_worst_row_is_as_exact_as_stated() {
    let (inertia, damping, speed) = (0.02, 0.03, 80.0);
    let k = damping / inertia;
    for tolerance in [1e-3, 1e-6, 1e-10] {
        let mut worst = [[0.0f64; 2]; 2];
        for turns in [1.0, 3.0, 6.0] {
            let scene = Scene::new(0.05, 0.2)
                .crank(Crank {
                    inertia,
                    ..Crank::default()
                })
                .torque(Load::Viscous(damping))
                .start(0.4, speed)
                .revolutions(turns)
                .tolerance(tolerance);
            let options = Options {
                method: Method::Angle,
                ..Options::default()
            };
            let mut rows: Vec<Row> = Vec::new();
            let summary = simulate_rows(&scene, &options, &mut rows).unwrap().summary;
            let stated = summary.rows_error.unwrap();
            let stated = [stated.theta_rad, stated.omega_rad_per_s];
            let mut errors = [0.0f64; 2];
            for row in &rows {
                let left = (-k * row.t).exp();
                let angle = 0.4 - speed / k * (-k * row.t).exp_m1();
                errors[0] = errors[0].max((row.theta - angle).abs());
                errors[1] = errors[1].max((row.omega - speed * left).abs());
            }
            for k in 0..2 {
                let (error, stated) = (errors[k], stated[k]);
                assert!(
                    error <= 2.0 * stated,
                    "{tolerance} {turns}: {error:e} {stated:e}"
                );
                worst[k] = [worst[k][0].max(error), worst[k][1].max(stated)];
            }
        }
        for [error, stated] in worst {
            assert!(stated <= 10.0 * error, "{tolerance}: {error:e} {stated:e}");
        }
    }
}

/// For a crank alone under viscous torque, the square root of the kinetic energy falls linearly with the angle,
/// whatever its value: the first sweep over a panel is exact, and a second one changes nothing.
#[test]
fn viscous_loss_alone_takes_two_sweeps() {
    let (inertia, k, speed, turned) = (0.02, 1.0, 80.0, 7.9 * TAU);
    let scene = Scene::new(0.05, 0.2)
        .crank(Crank {
            inertia,
            ..Crank::default()
        })
        .torque(Load::Viscous(k * inertia))
        .start(0.4, speed)
        .duration(-(-k * turned / speed).ln_1p() / k);
    let options = Options {
        method: Method::Angle,
        estimate: false,
        ..Options::default()
    };
    let evaluations = simulate(&scene, &options).unwrap().summary.evaluations;
    // A panel is half a turn with 13 points at least.
    assert!(evaluations <= 2 * 13 * 16, "{evaluations}");
}

/// A panel whose degree is too low or that is too long is solved again from the motion found on it, with the degree at
/// which its series will have decayed: the attempts cost little beside the solution. The torque A sin(ωt) on a crank
/// alone has the closed solution θ̇ = θ̇₀ + A (1 − cos ωt)/Jω.
#[test]
fn attempts_at_a_panel_are_not_lost() {
    let (inertia, torque, rate, speed, t_end) = (0.02, 40.0, 90.0, 60.0f64, 0.4);
    let formula = format!("{torque}*sin({rate}*t)");
    let scene = Scene::new(0.05, 0.2)
        .crank(Crank {
            inertia,
            ..Crank::default()
        })
        .torque(Load::Expression(Expression::parse(&formula).unwrap()))
        .start(0.4, speed)
        .duration(t_end);
    let options = Options {
        method: Method::Angle,
        estimate: false,
        ..Options::default()
    };
    let run = simulate(&scene, &options).unwrap();
    let push = torque / (inertia * rate);
    let angle = 0.4 + (speed + push) * t_end - push / rate * (rate * t_end).sin();
    assert!((run.summary.last.theta_rad - angle).abs() < 1e-11);
    let evaluations = run.summary.evaluations;
    assert!(evaluations < 4_200, "{evaluations}");
}

/// A crank alone, braked by viscous torque, passes each dead centre after turning by the angle to it, both in the first
/// turns and in mapped ones, although panels do not end there.
#[test]
fn dead_centres_are_passed_at_the_times_of_the_closed_solution() {
    let (crank, rod, offset): (f64, f64, f64) = (0.05, 0.2, 0.03);
    let (k, speed, duration) = (0.1, 100.0, 10.0);
    let turned = speed / k * (1.0 - f64::exp(-k * duration));
    // Crank and rod are in line, in the same or in opposite directions.
    let outer = -(offset / (rod + crank)).asin();
    let inner = PI - (offset / (rod - crank)).asin();
    for (start, direction) in [
        (0.4, 1.0),
        (0.4, -1.0),
        (5.9, 1.0),
        (inner, 1.0),
        (outer, -1.0),
    ] {
        let scene = Scene::new(crank, rod)
            .offset(offset)
            .crank(Crank {
                inertia: 0.02,
                ..Crank::default()
            })
            .torque(Load::Viscous(0.02 * k))
            .start(start, direction * speed)
            .duration(duration);
        let options = Options {
            method: Method::Angle,
            ..Options::default()
        };
        let summary = simulate(&scene, &options).unwrap().summary;
        let stated = summary.error_estimate.unwrap().theta_rad;
        // Two panels for each turn before the map takes over.
        assert_eq!(summary.steps, 96);
        let first = [outer, inner].map(|dead_centre| {
            let ahead = (direction * (dead_centre - start)).rem_euclid(TAU);
            // The start itself does not count as passed.
            if ahead < 1e-12 { ahead + TAU } else { ahead }
        });
        let mut ways: Vec<f64> = (0..200)
            .flat_map(|turn| first.map(|ahead| ahead + TAU * f64::from(turn)))
            .filter(|way| *way < turned)
            .collect();
        ways.sort_by(f64::total_cmp);
        assert!(ways.len() > 190);
        assert_eq!(summary.events_total, ways.len() as u64);
        assert_eq!(summary.events.len(), ways.len());
        for (event, way) in summary.events.iter().zip(&ways) {
            assert_eq!(event.kind, "dead-centre");
            let omega = speed - k * way;
            let t = (speed / omega).ln() / k;
            let off = [
                (event.theta_rad - start - direction * way).abs(),
                (event.t_s - t).abs() * omega,
                (event.omega_rad_per_s - direction * omega).abs(),
            ];
            let resolved = 0.01 * scene.run.tolerance * omega;
            assert!(
                off.iter().all(|off| *off < 2.0 * stated.max(resolved)),
                "{start} {direction} {way}: {off:?} {stated:e}"
            );
        }
    }
}

/// Between dead centres the slider keeps its direction: v |v| is as smooth there as v³, up to the ends.
#[test]
fn a_drag_by_the_square_of_the_speed_costs_about_as_much_as_one_by_the_cube() {
    for (direction, left) in [(1.0, false), (-1.0, false), (1.0, true)] {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let evaluations = |drag: &str| {
                let scene = machine([0.05, 0.15, 0.01], left, [8.0, 0.2, 0.5], 0.0)
                    .force(Load::Expression(Expression::parse(drag).unwrap()))
                    .start(0.3, 40.0 * direction)
                    .revolutions(5.0)
                    .tolerance(tolerance);
                run(&scene, Method::Angle).summary.evaluations
            };
            let [square, cube] = ["-0.5*v*abs(v)", "-0.5*v^3"].map(evaluations);
            assert!(
                5 * square <= 6 * cube,
                "{direction} {left} {tolerance:e}: {square} {cube}"
            );
        }
    }
}

/// A dry force written as a formula: over a turn the slider goes to and fro, and the energy falls by twice the stroke
/// times the force. M is the same at the end of each turn.
#[test]
fn a_force_against_the_direction_of_the_slider_takes_its_work() {
    let ([crank, rod, offset], inertia, force) = ([0.05, 0.15f64, 0.01f64], 0.02, 3.0);
    let reach = |length: f64| (length * length - offset * offset).sqrt();
    let stroke = reach(rod + crank) - reach(rod - crank);
    let turns = 5.0;
    for (direction, branch) in [
        (1.0, Branch::Right),
        (-1.0, Branch::Right),
        (1.0, Branch::Left),
    ] {
        let formulas = ["sign(v)", "(2*step(v) - 1)", "v/sqrt(v^2)"].map(|of_direction| {
            let formula = format!("-{force}*{of_direction}");
            Load::Expression(Expression::parse(&formula).unwrap())
        });
        for friction in formulas.into_iter().chain([Load::dry(force)]) {
            let scene = Scene::new(crank, rod)
                .offset(offset)
                .branch(branch)
                .crank(Crank {
                    inertia,
                    ..Crank::default()
                })
                .force(friction.clone())
                .start(0.7, 40.0 * direction)
                .revolutions(turns);
            let summary = run(&scene, Method::Auto).summary;
            assert_eq!(summary.engine, "angle");
            let lost = 2.0 * turns * stroke * force;
            let omega = direction * (1600.0 - 2.0 * lost / inertia).sqrt();
            let off = (summary.last.omega_rad_per_s - omega).abs();
            let stated = summary.error_estimate.expect("an estimate").omega_rad_per_s;
            assert!(
                off <= 2.0 * stated && stated < 1e-11,
                "{friction}: {off:e} {stated:e}"
            );
        }
    }
}

/// v |v| is not analytic where the slider reverses: panels end there, and no more are needed than two in half a turn.
#[test]
fn panels_end_where_a_load_has_a_kink_at_the_dead_centres() {
    let drag = Expression::parse("-1.5*v*abs(v)").unwrap();
    let scene = machine([0.05, 0.15, 0.01], false, [8.0, 0.2, 0.5], 0.0)
        .force(Load::Expression(drag))
        .start(0.5, 60.0)
        .revolutions(10.0)
        .tolerance(1e-10);
    let summary = run(&scene, Method::Angle).summary;
    assert!(summary.steps <= 4 * 10, "{}", summary.steps);
}

/// Crank alone under a time-dependent torque: I θ̈ = A sin(wt).
#[test]
fn loads_in_time_are_followed() {
    let (inertia, amplitude, w, speed) = (0.02, 3.0, 17.0, 60.0);
    let scene = Scene::new(0.05, 0.2)
        .crank(Crank {
            inertia,
            ..Crank::default()
        })
        .torque(Load::function(Variables::T, move |now| {
            amplitude * (w * now.t).sin()
        }))
        .start(0.0, speed)
        .duration(2.0);
    let result = run(&scene, Method::Angle);
    let a = amplitude / inertia;
    let omega = speed + a / w * (1.0 - (w * 2.0f64).cos());
    let theta = (speed + a / w) * 2.0 - a / (w * w) * (w * 2.0f64).sin();
    let last = result.summary.last;
    let stated = result.summary.error_estimate.unwrap();
    assert!(
        (last.theta_rad - theta).abs() < 2.0 * stated.theta_rad,
        "{last:?} {theta}"
    );
    assert!((last.omega_rad_per_s - omega).abs() < 2.0 * stated.omega_rad_per_s);
    assert!(stated.theta_rad < 1e-11);
}

fn driven_mechanism() -> impl Strategy<Value = Scene> {
    let lengths = (0.03..0.15f64, 0.3..2.0f64, -0.7..0.7f64, prop::bool::ANY);
    let masses = (0.5..3.0f64, 0.1..1.0f64, 0.1..1.0f64);
    let motion = (0.0..TAU, 80.0..200.0f64, prop::bool::ANY);
    let loads = (
        -0.5..0.5f64,
        0.0..0.01f64,
        0.0..2.0f64,
        -20.0..20.0f64,
        0.0..1e-4f64,
    );
    (lengths, masses, motion, loads).prop_map(|(lengths, masses, motion, loads)| {
        let (r, longer, offset, left) = lengths;
        let l = r + (offset * r).abs() + longer * r;
        let (crank, rod, slider) = masses;
        let (angle, speed, clockwise) = motion;
        let (torque, damping, damper, push, drag) = loads;
        machine([r, l, offset * r], left, [2.0 * crank, rod, slider], 0.0)
            .gravity(Gravity::standard())
            .torque(Load::Constant(torque))
            .torque(Load::Viscous(damping * r))
            .force(Load::Viscous(damper))
            .force(Load::function(Variables::T, move |now| {
                push * (9.0 * now.t).cos()
            }))
            .torque(Load::function(Variables::OMEGA, move |now| {
                -drag * r * now.omega * now.omega.abs()
            }))
            .start(angle, if clockwise { -speed } else { speed })
            .duration(0.3)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 250, max_shrink_iters: 30, failure_persistence: None, rng_seed: crate::support::seed::seed(1), ..ProptestConfig::default() })]

    #[test]
    fn angle_and_time_agree_to_their_stated_errors(scene in driven_mechanism()) {
        let time = run(&scene.clone().tolerance(1e-13), Method::Time);
        for tolerance in [1e-7, 1e-10] {
            let angle = run(&scene.clone().tolerance(tolerance), Method::Auto);
            if angle.summary.engine != "angle" {
                continue;
            }
            let (a, b) = (angle.summary.last, time.summary.last);
            let (ea, eb) = (angle.summary.error_estimate.unwrap(), time.summary.error_estimate.unwrap());
            let apart = (a.theta_rad - b.theta_rad).abs();
            prop_assert!(apart <= 2.0 * (ea.theta_rad + eb.theta_rad), "{tolerance:e}: {apart:e} {ea:?} {eb:?}");
            prop_assert!(ea.theta_rad <= 100.0 * tolerance * b.theta_rad.abs().max(1.0), "{ea:?}");
            let apart = (a.omega_rad_per_s - b.omega_rad_per_s).abs();
            prop_assert!(apart <= 2.0 * (ea.omega_rad_per_s + eb.omega_rad_per_s), "{tolerance:e}: {apart:e} {ea:?} {eb:?}");
            prop_assert!(angle.summary.energy_residual.abs() < 1e-2 * tolerance + 1e-13);
            prop_assert_eq!(angle.summary.events.len(), time.summary.events.len());
        }
    }
}

#[test]
fn rows_at_angles_and_ends_after_turns_are_exact() {
    let scene = Scene::duarte()
        .torque(Load::Viscous(0.05))
        .output_every(Every::Angle(TAU / 8.0))
        .revolutions(3.0);
    let mut rows: Vec<Row> = Vec::new();
    let result = simulate_rows(&scene, &Options::default(), &mut rows).unwrap();
    assert_eq!(result.summary.engine, "angle");
    assert_eq!(rows.len(), 25);
    for (i, row) in rows.iter().enumerate() {
        assert!(
            (row.theta - TAU * i as f64 / 8.0).abs() < 1e-12,
            "{i}: {}",
            row.theta
        );
    }
    assert!((result.summary.revolutions - 3.0).abs() < 1e-14);
    let time = simulate(
        &scene.tolerance(1e-13),
        &Options {
            method: Method::Time,
            ..Options::default()
        },
    )
    .unwrap();
    assert!((time.summary.last.t_s / result.summary.last.t_s - 1.0).abs() < 1e-12);
}
