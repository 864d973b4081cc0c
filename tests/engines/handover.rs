//! Runs handed over from the angle engine to the time engine and back: compared with closed solutions, with integration
//! in time alone, and with the reference in double-double arithmetic.

use std::f64::consts::TAU;

use crate::support::machines::machine;
use crate::support::reference::precision;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use slider_crank::error::Error;
use slider_crank::explain::explain;
use slider_crank::plan::Method;
use slider_crank::precision::PrecisionOptions;
use slider_crank::scene::{Crank, Every, Expression, Gravity, Load, Scene};
use slider_crank::simulate::{Options, Row, Simulation, Summary, simulate, simulate_rows};

fn run(scene: &Scene, method: Method) -> Simulation {
    let options = Options {
        method,
        ..Options::default()
    };
    simulate(scene, &options).unwrap()
}

const INERTIA: f64 = 0.02;

/// Returns a crank with constant inertia.
fn wheel() -> Scene {
    Scene::new(0.05, 0.2).crank(Crank {
        inertia: INERTIA,
        ..Crank::default()
    })
}

fn formula(text: String) -> Load {
    Load::Expression(Expression::parse(&text).unwrap())
}

/// A crank that turns back soon is not followed over the angle, whose panels shrink before each turning point:
/// I θ̈ = A cos(wt).
#[test]
fn a_swing_costs_no_more_than_in_time() {
    let (amplitude, w, speed, duration) = (3.0, 30.0, 1.0, 1.5);
    let scene = wheel()
        .torque(formula(format!("{amplitude}*cos({w}*t)")))
        .start(0.4, speed)
        .duration(duration);
    let [auto, in_time] = [Method::Auto, Method::Time].map(|method| run(&scene, method).summary);
    let a = amplitude / INERTIA / w;
    let angle = 0.4 + speed * duration + a / w * (1.0 - (w * duration).cos());
    let stated = auto.error_estimate.expect("an estimate").theta_rad;
    let error = (auto.last.theta_rad - angle).abs();
    assert!(
        error <= 2.0 * stated && stated < 1e-9,
        "{error:e} {stated:e}"
    );
    let [of_auto, of_time] = [&auto, &in_time].map(|of| of.evaluations as f64);
    assert!(of_auto < 1.2 * of_time, "{of_auto} {of_time}");
}

fn mechanism() -> impl Strategy<Value = Scene> {
    let lengths = (0.03..0.15f64, 0.3..2.0f64, -0.7..0.7f64, any::<bool>());
    let masses = (0.5..3.0f64, 0.1..1.0f64, 0.1..1.0f64);
    let motion = (0.0..TAU, 1.3..2.3f64, any::<bool>(), 1.1..2.5f64);
    let loads = (5.0..60.0f64, 0..4usize, 0.0..0.2f64, any::<bool>());
    (lengths, masses, motion, loads).prop_map(|(lengths, masses, motion, loads)| {
        let (r, longer, offset, left) = lengths;
        let l = r + (offset * r).abs() + longer * r;
        let (crank, rod, slider) = masses;
        let (angle, speed, clockwise, beyond) = motion;
        let speed = 10f64.powf(speed) * if clockwise { -1.0 } else { 1.0 };
        let inertia = (2.0 * crank + 0.6 * rod + 0.5 * slider) * r * r;
        let (turns, kind, loss, gravity) = loads;
        // The crank would come to rest after about this many turns; the run continues beyond that.
        let brake = 0.5 * inertia * speed * speed.abs() / (turns * TAU);
        let stops = 2.0 * turns * TAU / speed.abs();
        let scene = machine([r, l, offset * r], left, [2.0 * crank, rod, slider], 0.0)
            .start(angle, speed)
            .duration(beyond * stops);
        let scene = if gravity {
            scene.gravity(Gravity::standard())
        } else {
            scene
        };
        let damping = loss * brake.abs() / speed.abs();
        match kind {
            0 => scene
                .torque(formula(format!("{} + 0*t", -brake)))
                .torque(Load::Viscous(damping)),
            1 => scene.torque(Load::Viscous(5.0 * brake.abs() / speed.abs())),
            2 => {
                let (size, rate) = (-15.0 * brake, 3.0 * TAU / stops);
                scene
                    .torque(formula(format!("{size} * sin({rate} * t)")))
                    .torque(Load::Viscous(damping))
            }
            _ => scene
                .torque(Load::Motor {
                    stall: -brake,
                    no_load_speed: -1.5 * speed,
                })
                .force(Load::Viscous(damping / (r * r))),
        }
    })
}

fn scenes(seed: u64, count: usize) -> Vec<Scene> {
    let mut runner = TestRunner::new(ProptestConfig {
        rng_seed: crate::support::seed::seed(seed),
        ..ProptestConfig::default()
    });
    let one = mechanism();
    (0..count)
        .map(|_| one.new_tree(&mut runner).unwrap().current())
        .collect()
}

fn is_handed(summary: &Summary) -> bool {
    let engines = summary.pieces.iter().map(|piece| piece.engine);
    summary.engine == "angle" && engines.clone().any(|engine| engine == "time")
}

/// Returns the number of handovers from angle to time.
fn times_handed(summary: &Summary) -> usize {
    let pairs = summary.pieces.windows(2);
    let handed = pairs.filter(|pair| (pair[0].engine, pair[1].engine) == ("angle", "time"));
    handed.count()
}

/// θ and ω of a closed solution at a time.
type Closed<'a> = &'a dyn Fn(f64) -> (f64, f64);

/// Checks that the motion is the closed solution, at the end to the stated error, inside to the tolerance.
#[track_caller]
fn follows(result: &Simulation, closed: Closed<'_>) {
    let summary = &result.summary;
    assert!(is_handed(summary), "{:?}", summary.pieces);
    let stated = summary.error_estimate.unwrap();
    let end = summary.last.t_s;
    let (theta, omega) = closed(end);
    let apart = (summary.last.theta_rad - theta).abs();
    assert!(apart <= 2.0 * stated.theta_rad, "{apart:e} {stated:?}");
    let apart = (summary.last.omega_rad_per_s - omega).abs();
    assert!(
        apart <= 2.0 * stated.omega_rad_per_s,
        "{apart:e} {stated:?}"
    );
    let (_, largest) = (
        summary.omega_min,
        summary.omega_max.abs().max(summary.omega_min.abs()),
    );
    for i in 0..=997 {
        let t = end * f64::from(i) / 997.0;
        let (theta, omega) = result.at(t).unwrap();
        let (angle, speed) = closed(t);
        assert!(
            (theta - angle).abs() <= 1e-10 * (1.0 + angle.abs()),
            "{t} {theta} {angle}"
        );
        assert!(
            (omega - speed).abs() <= 1e-10 * largest,
            "{t} {omega} {speed}"
        );
    }
    assert!(
        summary.energy_residual.abs() < 1e-12,
        "{}",
        summary.energy_residual
    );
}

/// Constant torque on a constant inertia: θ is a parabola. The crank stops and turns back, in both directions.
#[test]
fn a_brake_that_turns_the_crank_back_makes_a_parabola() {
    for (speed, torque, duration) in [(60.0, -1.0, 3.0), (-60.0, 1.0, 3.0), (300.0, -0.5, 40.0)] {
        let rate = torque / INERTIA;
        let closed = |t: f64| (0.3 + t * (speed + 0.5 * rate * t), speed + rate * t);
        for load in [
            formula(format!("{torque} + 0*t")),
            formula(format!("{torque} + 0*omega")),
        ] {
            let scene = wheel().torque(load).start(0.3, speed).duration(duration);
            let result = run(&scene, Method::Auto);
            follows(&result, &closed);
            let summary = &result.summary;
            let pieces = &summary.pieces;
            let engines: Vec<_> = pieces.iter().map(|piece| piece.engine).collect();
            assert_eq!(engines, ["angle", "time", "angle"]);
            assert_eq!((pieces[0].from_s, pieces[2].to_s), (0.0, duration));
            assert!(pieces.windows(2).all(|w| w[0].to_s == w[1].from_s));
            // The crank stops within the piece in time.
            let stands = -speed / rate;
            assert!(pieces[1].from_s < stands && stands < pieces[1].to_s);
            let ends = [speed, speed + rate * duration];
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            assert!((summary.omega_min / low - 1.0).abs() < 1e-13);
            assert!((summary.omega_max / high - 1.0).abs() < 1e-13);
            let turning: Vec<_> = summary
                .events
                .iter()
                .filter(|event| event.kind == "turning-point")
                .collect();
            if summary.events_total as usize == summary.events.len() {
                assert_eq!(turning.len(), 1);
                assert!((turning[0].t_s + speed / rate).abs() < 1e-12);
            }
        }
    }
}

/// Speed-proportional loss: the crank turns a hundred thousand times before it comes to rest.
#[test]
fn coasting_to_rest_after_many_turns_is_an_exponential() {
    for (turns, direction) in [(10.0, 1.0), (1e5, -1.0)] {
        let speed = direction * 200.0;
        let rate = 200.0 / (turns * TAU);
        let closed = |t: f64| {
            let left = (-rate * t).exp();
            (0.3 + speed / rate * (1.0 - left), speed * left)
        };
        let scene = wheel()
            .torque(Load::Viscous(rate * INERTIA))
            .start(0.3, speed)
            .duration(20.0 / rate);
        let result = run(&scene, Method::Auto);
        follows(&result, &closed);
        assert!(
            result.summary.evaluations < 150_000,
            "{}",
            result.summary.evaluations
        );
    }
}

/// Equal energy gain in each of millions of turns: the rounding errors must not accumulate.
#[test]
fn a_gain_that_is_the_same_in_millions_of_turns_loses_nothing() {
    let (speed, rate, duration) = (-300.0, 25.0, 1000.0);
    let scene = wheel()
        .torque(formula(format!("{} + 0*omega", rate * INERTIA)))
        .start(0.3, speed)
        .duration(duration);
    let last = run(&scene, Method::Auto).summary;
    let theta = 0.3 + duration * (speed + 0.5 * rate * duration);
    let stated = last.error_estimate.unwrap().theta_rad;
    let apart = (last.last.theta_rad - theta).abs();
    assert!(apart <= 2.0 * stated, "{apart:e} {stated:e}");
    assert!(stated <= 1e-14 * theta, "{stated:e}");
}

/// Checks that events have equal kinds, order and times.
#[track_caller]
fn same_events(a: &Summary, b: &Summary, within: f64) {
    assert_eq!(a.events_total, b.events_total);
    for (a, b) in a.events.iter().zip(&b.events) {
        assert_eq!(a.kind, b.kind, "{a:?} {b:?}");
        let near = |a: f64, b: f64| (a - b).abs() <= within * (1.0 + a.abs());
        assert!(
            near(a.t_s, b.t_s) && near(a.theta_rad, b.theta_rad),
            "{a:?} {b:?}"
        );
    }
    assert!(a.events.windows(2).all(|w| w[0].t_s <= w[1].t_s));
}

#[test]
fn what_is_stated_is_near_the_distance_from_a_tight_run_in_time() {
    let (mut judged, mut several) = (0, 0);
    for scene in scenes(3, 50) {
        let truth = run(&scene.clone().tolerance(1e-13), Method::Time).summary;
        let unsure = truth.error_estimate.unwrap();
        for tolerance in [1e-5, 1e-7, 1e-9] {
            let summary = run(&scene.clone().tolerance(tolerance), Method::Auto).summary;
            if !is_handed(&summary) {
                continue;
            }
            // A larger error may put the reversal on the other side of a dead centre.
            if tolerance < 1e-8 {
                same_events(&summary, &truth, 1e3 * tolerance);
            }
            several += usize::from(times_handed(&summary) != 1);
            assert!(
                summary.energy_residual.abs() < tolerance,
                "{}",
                summary.energy_residual
            );
            // Cost of a second run that reaches the end at once.
            let cost = summary.estimate_cost.unwrap().evaluations;
            assert!(cost <= 20 * summary.evaluations, "{cost}");
            let stated = summary.error_estimate.unwrap();
            let pairs = [
                (
                    summary.last.theta_rad - truth.last.theta_rad,
                    stated.theta_rad,
                    unsure.theta_rad,
                ),
                (
                    summary.last.omega_rad_per_s - truth.last.omega_rad_per_s,
                    stated.omega_rad_per_s,
                    unsure.omega_rad_per_s,
                ),
            ];
            for (apart, stated, unsure) in pairs {
                let apart = apart.abs();
                assert!(
                    apart <= 2.0 * stated + unsure,
                    "{tolerance:e}: {apart:e} {stated:e} {unsure:e}"
                );
                assert!(
                    stated <= 10.0 * (apart + unsure),
                    "{tolerance:e}: {apart:e} {stated:e} {unsure:e}"
                );
                judged += usize::from(100.0 * unsure < apart);
            }
        }
    }
    assert!(judged > 100, "{judged}");
    assert!(several > 5, "{several}");
}

/// The reference is independent of the engines.
#[test]
fn what_is_stated_is_near_the_distance_from_the_reference() {
    let mut judged = 0;
    for scene in scenes(11, 6) {
        if !is_handed(&run(&scene, Method::Angle).summary) {
            continue;
        }
        let options = PrecisionOptions {
            tolerances: vec![1e-8, 1e-11],
            repeats: 1,
            most_s: 0.0,
            ..PrecisionOptions::default()
        };
        let rows = precision(&scene, &options).unwrap().rows;
        for row in rows.iter().filter(|row| row.method == "angle") {
            assert_eq!(row.failure, None);
            let pairs = [
                (row.error_theta_rad, row.estimate_theta_rad),
                (row.error_omega_rad_per_s, row.estimate_omega_rad_per_s),
            ];
            for (error, stated) in pairs {
                let (error, stated) = (error.unwrap(), stated.unwrap());
                assert!(error <= 2.0 * stated, "{error:e} {stated:e}");
                // Smaller errors are dominated by rounding.
                if error > 1e-11 {
                    assert!(stated <= 10.0 * error, "{error:e} {stated:e}");
                    judged += 1;
                }
            }
        }
    }
    assert!(judged >= 8, "{judged}");
}

/// Returns a scene of a thousand turns and a slow end.
fn coasting() -> Scene {
    Scene::duarte()
        .gravity(Gravity::standard())
        .torque(Load::Viscous(0.001))
        .start(0.3, 200.0)
        .duration(200.0)
}

#[test]
fn a_thousand_turns_and_a_slow_end_take_a_part_of_what_time_alone_takes() {
    let handed = run(&coasting(), Method::Auto).summary;
    assert!(is_handed(&handed), "{:?}", handed.pieces);
    assert!(handed.revolutions > 900.0 && handed.last.omega_rad_per_s.abs() < 1.0);
    let alone = run(&coasting().tolerance(1e-13), Method::Time).summary;
    same_events(&handed, &alone, 1e-7);
    let stated = handed.error_estimate.unwrap().theta_rad;
    let apart = (handed.last.theta_rad - alone.last.theta_rad).abs();
    assert!(apart <= 2.0 * stated + alone.error_estimate.unwrap().theta_rad);
    assert!(
        5 * handed.evaluations < alone.evaluations,
        "{} {}",
        handed.evaluations,
        alone.evaluations
    );
}

#[test]
fn rows_go_on_from_piece_to_piece() {
    let rows = |scene: &Scene, method: Method| {
        let options = Options {
            method,
            ..Options::default()
        };
        let mut rows: Vec<Row> = Vec::new();
        let result = simulate_rows(scene, &options, &mut rows).unwrap();
        assert_eq!(is_handed(&result.summary), method == Method::Auto);
        rows
    };
    let scene = Scene::duarte()
        .torque(formula("-20*cos(3*t)".into()))
        .torque(Load::Viscous(0.001))
        .start(0.3, 60.0)
        .duration(5.0);
    for every in [Every::Time(0.001), Every::Angle(TAU / 7.0)] {
        let scene = scene.clone().output_every(every);
        let handed = rows(&scene, Method::Auto);
        let alone = rows(&scene.clone().tolerance(1e-13), Method::Time);
        assert_eq!(handed.len(), alone.len(), "{every:?}");
        for (a, b) in handed.iter().zip(&alone) {
            assert!((a.t - b.t).abs() < 1e-7, "{} {}", a.t, b.t);
            assert!((a.theta - b.theta).abs() < 1e-7, "{} {}", a.theta, b.theta);
            assert!((a.omega - b.omega).abs() < 1e-5, "{} {}", a.omega, b.omega);
        }
    }
}

#[test]
fn turns_end_a_run_in_either_direction() {
    for (torque, turns) in [(-1.0, 40.0), (-1.0, 3.0), (1.0, 40.0)] {
        let scene = wheel()
            .torque(formula(format!("{torque} + 0*omega")))
            .start(0.3, 60.0)
            .revolutions(turns);
        let summary = run(&scene, Method::Auto).summary;
        assert!(
            (summary.revolutions.abs() - turns).abs() < 1e-13,
            "{}",
            summary.revolutions
        );
        let rate = torque / INERTIA;
        let way = summary.revolutions * TAU;
        // After the reversal take the later root.
        let root = (3600.0 + 2.0 * rate * way).sqrt();
        let t = if way < 0.0 {
            (-60.0 - root) / rate
        } else {
            (-60.0 + root) / rate
        };
        assert!(
            (summary.last.t_s / t - 1.0).abs() < 1e-12,
            "{} {t}",
            summary.last.t_s
        );
    }
}

#[test]
fn a_start_too_slow_for_the_angle_is_handed_over_later() {
    let scene = Scene::duarte()
        .gravity(Gravity::standard())
        .torque(Load::Motor {
            stall: 5.0,
            no_load_speed: 100.0,
        })
        .start(0.3, 1e-7)
        .duration(4.0);
    let result = run(&scene, Method::Auto);
    assert!(is_handed(&result.summary), "{:?}", result.summary.pieces);
    let tight = run(&scene.tolerance(1e-13), Method::Time);
    same_events(&result.summary, &tight.summary, 1e-7);
    let (stated, unsure) = (
        result.summary.error_estimate.unwrap(),
        tight.summary.error_estimate.unwrap(),
    );
    let apart = (result.summary.last.theta_rad - tight.summary.last.theta_rad).abs();
    assert!(
        apart <= 2.0 * stated.theta_rad + unsure.theta_rad,
        "{apart:e} {stated:?}"
    );
}

/// A crank that is slow in one place of each turn, without stopping, stays with the angle engine.
#[test]
fn a_crank_that_is_slow_in_each_turn_is_not_handed_over() {
    for sense in [1.0, -1.0] {
        let scene = wheel()
            .torque(formula(format!("{sense} * 3 + 8*sin(theta)")))
            .torque(Load::Viscous(0.1))
            .start(0.0, sense * 30.0)
            .duration(20.0);
        let summary = run(&scene, Method::Auto).summary;
        assert_eq!(summary.engine, "angle");
        assert!(!is_handed(&summary), "{:?}", summary.pieces);
        let (low, high) = (summary.omega_min.abs(), summary.omega_max.abs());
        assert!(low.min(high) < 0.5 * low.max(high), "{low} {high}");
    }
}

#[test]
fn the_work_limit_holds_over_all_pieces() {
    let whole = run(&coasting(), Method::Auto);
    for part in [0.1, 0.5, 0.9] {
        let most = (part * whole.summary.evaluations as f64) as u64;
        let options = Options {
            max_evaluations: most,
            ..Options::default()
        };
        let stopped = simulate(&coasting(), &options).unwrap();
        let summary = &stopped.summary;
        assert!(
            summary
                .stopped
                .as_ref()
                .unwrap()
                .to_string()
                .contains("work limit")
        );
        assert!(
            summary.evaluations < most + 10_000,
            "{} {most}",
            summary.evaluations
        );
        assert!(summary.error_estimate.is_none());
        let (theta, _) = whole.at(summary.last.t_s).unwrap();
        assert!((summary.last.theta_rad - theta).abs() < 1e-7 * (1.0 + theta.abs()));
    }
}

#[test]
fn the_plan_says_that_it_may_happen_and_a_start_at_rest_is_refused() {
    let plan = explain(&coasting(), Method::Auto, None).unwrap().plan;
    assert!(
        plan.reason.contains("integration in time takes over"),
        "{}",
        plan.reason
    );
    let at_rest = coasting().start(0.3, 0.0);
    let options = Options {
        method: Method::Angle,
        ..Options::default()
    };
    assert!(matches!(
        simulate(&at_rest, &options),
        Err(Error::Refused { .. })
    ));
}
