//! Ends of runs: at the goal, or with the reason, and never with more work or rows than allowed.

use crate::support::random::cases;
use crate::support::random::magnitude;
use crate::support::reference::precision;
use proptest::prelude::*;
use slider_crank::plan::Method;
use slider_crank::precision::PrecisionOptions;
use slider_crank::scene::{
    Branch, Crank, Every, Expression, Friction, Gravity, Interpolation, Load, Rod, Scene, Slider,
    Table, Variable,
};
use slider_crank::simulate::{Options, Row, Summary, simulate, simulate_rows};

const INERTIA: f64 = 0.02;

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

/// Returns a crank, rod and slider, in m and kg.
fn machine(r: f64, l: f64, slider: f64) -> Scene {
    Scene::new(r, l)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .slider(Slider { mass: slider })
}

fn limited(method: Method, max_evaluations: u64) -> Options {
    Options {
        method,
        max_evaluations,
        ..Options::default()
    }
}

fn run(scene: &Scene, options: &Options) -> Summary {
    simulate(scene, options).expect("a run").summary
}

/// Motor on a crank that cannot turn fully because its rod is 0.12 nm too short.
fn nearly_turning(speed: f64) -> Scene {
    machine(0.1, 0.119_999_999_88, 0.5)
        .offset(0.02)
        .torque(Load::Motor {
            stall: 2.0 * speed.signum(),
            no_load_speed: 30.0 * speed.signum(),
        })
        .start(0.1, speed)
}

/// Reference: extrapolation of order 16 with 34 digits, for an independent equation along the configuration curve.
#[test]
fn a_crank_that_nearly_turns_fully_is_followed_past_its_limits() {
    for (t, theta, omega) in [
        (0.3, 0.556_232_590_844_719_5, 2.950_345_198_563_416),
        (2.0, 1.543_605_951_513_556_6, 2.984_674_809_930_666),
    ] {
        let summary = run(&nearly_turning(10.0).duration(t), &Options::default());
        assert_eq!(summary.stopped, None);
        assert_eq!(summary.last.t_s, t);
        let error = summary.error_estimate.expect("an estimate");
        let off = [
            (summary.last.theta_rad - theta).abs(),
            (summary.last.omega_rad_per_s - omega).abs(),
        ];
        assert!(
            off[0] <= 3.0 * error.theta_rad && error.theta_rad < 1e-8,
            "{off:?} {error:?}"
        );
        assert!(off[1] <= 3.0 * error.omega_rad_per_s, "{off:?} {error:?}");
    }
}

proptest! {
    #![proptest_config(cases(48))]

    #[test]
    fn a_run_ends_at_its_time_or_says_why(
        (speed, clockwise, left) in (3.0..60.0f64, any::<bool>(), any::<bool>()),
        (short, above) in (magnitude(1e-12, 1e-6), any::<bool>()),
        duration in 0.2..1.0f64,
    ) {
        let speed = if clockwise { -speed } else { speed };
        let scene = nearly_turning(speed).duration(duration);
        let mut scene = scene.branch(if left { Branch::Left } else { Branch::Right });
        scene.geometry.rod = 0.12 * (1.0 - short);
        scene.geometry.offset = if above { -0.02 } else { 0.02 };
        let options = Options { estimate: false, ..limited(Method::Auto, 1_000_000) };
        let summary = run(&scene, &options);
        prop_assert!(summary.stopped.is_some() || summary.last.t_s == duration, "{:?}", summary.last);
    }
}

#[test]
fn a_load_without_a_value_at_the_start_is_said() {
    for (text, angle) in [("sin(50*t)/(50*t)", 0.6), ("1/theta", 0.0), ("ln(t)", 1.0)] {
        let scene = machine(0.05, 0.15, 2.0)
            .torque(formula(text))
            .start(angle, 0.1)
            .duration(1.0);
        for method in [Method::Auto, Method::Time, Method::Dop853, Method::Dopri5] {
            let error = simulate(&scene, &limited(method, 1_000_000)).expect_err("no start");
            assert!(error.to_string().contains("finite value"), "{error}");
        }
    }
}

/// Under a drag of c ω² the speed of a crank with inertia I falls with the angle, ω = ω₀ exp(−c θ/I), and the time for
/// an angle is (exp(c θ/I) − 1) I/(c ω₀): ten turns take 1e12 s.
#[test]
fn too_many_rows_are_refused_before_the_first_is_written() {
    let mut scene = machine(0.05, 0.15, 0.5)
        .torque(formula("-0.01*omega*abs(omega)"))
        .start(0.0, 30.0)
        .revolutions(10.0);
    assert_eq!(run(&scene, &Options::default()).stopped, None);
    scene.run.output_every = Some(Every::Time(1e-3));
    for method in [Method::Auto, Method::Time] {
        let mut rows: Vec<Row> = Vec::new();
        let refused = simulate_rows(&scene, &limited(method, 1_000_000), &mut rows);
        let error = refused.expect_err("too many rows").to_string();
        assert!(
            error.contains("run.output_every") && error.contains("rows"),
            "{error}"
        );
        assert!(rows.is_empty());
    }
}

/// From rest under a constant torque M the angle is M t²/2I: at the dead centre the slider does not move.
#[test]
fn a_tiny_part_of_a_turn_is_no_more_work_than_a_turn() {
    for turns in [1e-7, 1e-5] {
        let scene = machine(0.05, 0.15, 0.5)
            .torque(formula("10 + t"))
            .revolutions(turns);
        let mut rows: Vec<Row> = Vec::new();
        let summary = simulate_rows(&scene, &Options::default(), &mut rows).expect("a run");
        let theta = std::f64::consts::TAU * turns;
        let t = (2.0 * theta * INERTIA / 10.0).sqrt();
        assert!((summary.summary.last.t_s / t - 1.0).abs() < 0.1 * t.max(1e-4));
        assert_eq!(rows.len(), 500);
        let even =
            |pair: &[Row]| ((pair[1].theta - pair[0].theta) * 499.0 / theta - 1.0).abs() < 1e-6;
        assert!(rows.windows(2).all(even));
    }
}

/// Returns a table over time, each row of which ends a step.
fn fine_table() -> Load {
    let times: Vec<f64> = (0..30_000).map(|i| f64::from(i) * 1e-5).collect();
    let torques: Vec<f64> = times.iter().map(|t| (40.0 * t).sin()).collect();
    let table = Table::new(Variable::T, &times, &torques, Interpolation::Linear, None);
    Load::Table(table.expect("a table"))
}

const IN_TIME: [Method; 3] = [Method::Dopri5, Method::Dop853, Method::Time];

#[test]
fn the_work_limit_holds_where_a_table_cuts_the_steps_short() {
    let scene = machine(0.05, 0.15, 0.5)
        .torque(fine_table())
        .start(0.3, 10.0)
        .duration(0.29);
    for method in IN_TIME {
        let summary = run(&scene, &limited(method, 20_000));
        let why = summary.stopped.expect("a reason").to_string();
        assert!(why.contains("work limit"), "{why}");
        assert!(
            summary.evaluations < 20_100,
            "{method} {}",
            summary.evaluations
        );
    }
}

/// The second run of an estimate obeys the limit, and so does a third one if the second does not reach the end.
#[test]
fn an_estimate_takes_no_more_than_the_limit() {
    let scene = machine(0.05, 0.15, 0.5)
        .torque(fine_table())
        .start(0.3, 10.0)
        .duration(0.02);
    for method in IN_TIME {
        let whole = run(&scene, &limited(method, 10_000_000));
        let limit = whole.evaluations + 200;
        let summary = run(&scene, &limited(method, limit));
        assert_eq!(summary.stopped, None);
        if let Some(cost) = summary.estimate_cost {
            let taken = cost.evaluations;
            assert!(taken <= 2 * limit + 200, "{method} {taken} {limit}");
        }
    }
}

/// From rest the steps of a crank of constant inertia have no error, whatever their number of turns.
#[test]
fn a_step_makes_no_more_than_two_turns() {
    for load in [Load::Constant(1e6), formula("1e6*t")] {
        let scene = Scene::new(0.05, 0.15)
            .crank(Crank {
                inertia: INERTIA,
                ..Crank::default()
            })
            .torque(load)
            .tolerance(0.1)
            .duration(1e6);
        for method in [Method::Dop853, Method::Dopri5] {
            let summary = run(&scene, &limited(method, 50_000));
            let why = summary.stopped.expect("a reason").to_string();
            assert!(why.contains("work limit"), "{why}");
            let turns = summary.revolutions;
            assert!(
                turns > 100.0 && turns < 2.0 * summary.steps as f64,
                "{method} {turns}"
            );
            assert!(summary.events_total <= 5 * summary.steps);
        }
    }
}

#[test]
fn precision_obeys_the_work_limit() {
    let scene = machine(0.05, 0.15, 0.5)
        .torque(formula("-0.02*omega + 0.3*sin(2*theta)"))
        .start(0.3, 100.0)
        .duration(20.0);
    let options = PrecisionOptions {
        tolerances: vec![1e-6],
        repeats: 1,
        max_evaluations: 100,
        ..PrecisionOptions::default()
    };
    let result = precision(&scene, &options).expect("a comparison");
    assert_eq!(result.reference_error_theta_rad, None);
    assert!(result.rows.iter().all(|row| row.failure.is_some()));
}

/// Away from the change point, a rod longer by 1e-9 has the same forces up to 1e-8 of them.
#[test]
fn forces_far_from_a_change_point_are_given() {
    for (offset, angle) in [(0.02, 0.0), (-0.02, 0.0), (0.02, 3.0)] {
        let peaks = |rod: f64| {
            let scene = machine(0.05, rod, 0.5)
                .offset(offset)
                .start(angle, 10.0)
                .duration(0.01);
            let options = Options {
                reactions: true,
                ..Options::default()
            };
            run(&scene, &options).peaks.expect("the largest forces")
        };
        let (exact, longer) = (peaks(0.07), peaks(0.07 * (1.0 + 1e-9)));
        for ((name, a), (_, b)) in exact.named().into_iter().zip(longer.named()) {
            assert!(
                (a.value_n - b.value_n).abs() <= 1e-7 * b.value_n,
                "{name} {a:?} {b:?}"
            );
            assert!(a.value_n.is_finite());
        }
    }
}

/// The angle engine hands over to the time engine at the second dead centre, which is not a float.
#[test]
fn a_dead_centre_at_a_handover_is_listed_once() {
    let scene = |mirror: f64| {
        let crank = Crank {
            inertia: 0.01,
            ..Crank::default()
        };
        let rod = Rod {
            mass: 1.316_168_174_648_470_4,
            cg: 0.278_372_514_428_059_1,
            inertia: 0.270_764_578_268_492_8,
            ..Rod::default()
        };
        let slider = Slider {
            mass: 0.071_643_272_932_767_98,
        };
        let mut scene = Scene::new(0.3, 1.434_300_770_795_350_3)
            .offset(0.134_060_456_016_178_3 * mirror)
            .branch(Branch::Left)
            .crank(crank)
            .rod(rod)
            .slider(slider)
            .gravity(Gravity {
                direction: -mirror * std::f64::consts::FRAC_PI_2,
                ..Gravity::standard()
            })
            .torque(Load::Constant(0.559_860_953_228_709_5 * mirror))
            .force(Load::Spring {
                stiffness: 167.567_014_898_558_94,
                rest: -1.434_300_770_795_350_3,
            })
            .force(formula("5.275492379532281*sin(5.846311489049012*t)"))
            .start(
                2.529_975_046_562_175 * mirror,
                -8.931_114_120_268_74 * mirror,
            )
            .duration(1.0);
        scene.friction = Some(Friction {
            coefficient: 0.031_763_188_577_165_84,
            static_coefficient: 0.031_763_188_577_165_84,
        });
        scene
    };
    for mirror in [1.0, -1.0] {
        let summary = run(&scene(mirror), &Options::default());
        let kinds: Vec<&str> = summary.events.iter().map(|event| event.kind).collect();
        let expected = ["dead-centre", "dead-centre", "turning-point", "dead-centre"];
        assert_eq!(kinds, expected);
    }
}

/// A run that ends where a table over time has no more rows states the error of the motion up to there.
#[test]
fn the_end_of_a_table_leaves_the_motion_an_error() {
    let torque = |kind| {
        let (times, torques) = ([0.0, 0.1, 0.2, 0.3], [0.5, 1.0, -0.5, 0.8]);
        Load::Table(Table::new(Variable::T, &times, &torques, kind, None).expect("a table"))
    };
    for kind in [Interpolation::Linear, Interpolation::Pchip] {
        for tolerance in [1e-6, 1e-10] {
            let scene = machine(0.05, 0.15, 0.6)
                .torque(torque(kind))
                .start(0.3, 40.0);
            let until = |duration, tolerance| {
                let scene = scene.clone().duration(duration).tolerance(tolerance);
                run(&scene, &Options::default())
            };
            let (cut, whole) = (until(1.0, tolerance), until(0.3, 1e-14));
            assert!(cut.stopped.is_some() && whole.stopped.is_none());
            assert!((cut.last.t_s - 0.3).abs() < 1e-12, "{}", cut.last.t_s);
            let error = (cut.last.theta_rad - whole.last.theta_rad).abs();
            let stated = cut.error_estimate.expect("an estimate").theta_rad;
            assert!(
                error <= 2.0 * stated && stated <= 100.0 * tolerance,
                "{error:e} {stated:e}"
            );
        }
    }
}

/// Runs that end with a table over the position end at one angle: the error is that of the time.
#[test]
fn the_end_of_a_table_over_the_position_leaves_the_motion_an_error() {
    let theta = ([-20.0, 0.0, 20.0, 50.0, 93.3], [1.0, 0.5, -0.3, 0.4, 0.2]);
    let x = (
        [0.09, 0.1, 0.15, 0.17, 0.199],
        [10.0, 0.0, -4.0, -9.0, 20.0],
    );
    for kind in [Interpolation::Linear, Interpolation::Pchip] {
        let table = |of, (at, load): ([f64; 5], [f64; 5])| {
            Load::Table(Table::new(of, &at, &load, kind, None).expect("a table"))
        };
        let machine = machine(0.05, 0.15, 0.6).start(1.1, 40.0).duration(5.0);
        let scenes = [
            machine.clone().torque(table(Variable::Theta, theta)),
            machine.clone().force(table(Variable::X, x)),
        ];
        for (scene, viscous) in scenes
            .iter()
            .flat_map(|scene| [(scene, 0.0), (scene, 1e-3)])
        {
            let scene = scene.clone().torque(Load::Viscous(viscous));
            let with = |tolerance| run(&scene.clone().tolerance(tolerance), &Options::default());
            let reference = with(1e-14);
            assert!(reference.stopped.is_some());
            for tolerance in [1e-6, 1e-9, 1e-12] {
                let cut = with(tolerance);
                let lead = cut.last.t_s - reference.last.t_s;
                let error = (cut.last.omega_rad_per_s * lead).abs();
                let stated = cut.error_estimate.expect("an estimate").theta_rad;
                assert!(
                    error <= 2.0 * stated && stated <= 4.0 * error + 1e-13,
                    "{error:e} {stated:e} at {tolerance:e}"
                );
            }
        }
    }
}
