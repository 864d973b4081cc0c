//! A crank that is caught swinging in a potential well is reported early, and one that will leave the well is not;
//! compared with an independently integrated pendulum.

use std::f64::consts::TAU;

use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Friction, Gravity, Load, Scene, Slider};
use slider_crank::simulate::{Options, Summary, simulate};

const INERTIA: f64 = 1e-3;
/// Weight times the distance of the centre of gravity from the axis, N m.
const WEIGHT: f64 = 9.80665 * 0.02;

/// Returns a scene of a crank alone: I θ'' = −W cos θ + τ(θ').
fn pendulum(angle: f64, speed: f64, torque: &str) -> Scene {
    Scene::new(0.05, 0.15)
        .crank(Crank {
            mass: 1.0,
            cg: 0.02,
            inertia: INERTIA,
            ..Crank::default()
        })
        .gravity(Gravity::standard())
        .torque(Load::Expression(
            Expression::parse(torque).expect("a formula"),
        ))
        .start(angle, speed)
        .revolutions(3.0)
}

fn run(scene: &Scene, method: Method) -> Summary {
    let options = Options {
        method,
        max_evaluations: 1_000_000,
        events_kept: 100_000,
        ..Options::default()
    };
    simulate(scene, &options).expect("a run").summary
}

/// Integrates the same pendulum by the classical Runge-Kutta method; returns its turning points as (s, rad) until it
/// has turned by three turns or the time is over, and its last state.
fn swings(
    state: (f64, f64),
    torque: impl Fn(f64) -> f64,
    until: f64,
) -> (Vec<(f64, f64)>, (f64, f64)) {
    const H: f64 = 1e-4;
    let rate = |theta: f64, omega: f64| (torque(omega) - WEIGHT * theta.cos()) / INERTIA;
    let (begin, (mut theta, mut omega), mut t) = (state.0, state, 0.0);
    let mut turning = Vec::new();
    while t < until && (theta - begin).abs() < 3.0 * TAU {
        let k1 = (omega, rate(theta, omega));
        let at = |k: (f64, f64), h: f64| (theta + h * k.0, omega + h * k.1);
        let slope = |(theta, omega): (f64, f64)| (omega, rate(theta, omega));
        let k2 = slope(at(k1, 0.5 * H));
        let k3 = slope(at(k2, 0.5 * H));
        let k4 = slope(at(k3, H));
        let mean = |a: f64, b: f64, c: f64, d: f64| H / 6.0 * (a + 2.0 * (b + c) + d);
        let next = omega + mean(k1.1, k2.1, k3.1, k4.1);
        if omega * next < 0.0 {
            let part = omega / (omega - next);
            turning.push((t + part * H, theta + 0.5 * part * H * omega));
        }
        theta += mean(k1.0, k2.0, k3.0, k4.0);
        (omega, t) = (next, t + H);
    }
    (turning, (t, theta))
}

fn assert_close(value: f64, exact: f64, within: f64) {
    assert!((value - exact).abs() < within, "{value}, not {exact}");
}

/// Returns the angles in "between theta = a rad and b rad".
fn between(why: &str) -> [f64; 2] {
    let (_, range) = why.split_once("between theta = ").expect("a range");
    let mut words = range.split(' ');
    let mut number = |skipped: usize| {
        let word = words.nth(skipped).expect("a number");
        word.parse().expect("a number")
    };
    [number(0), number(2)]
}

/// From rest the run is in time; from a speed it is over the angle first, passes the top once and is then caught.
#[test]
fn a_damped_crank_is_caught_once_it_has_come_no_further_for_long() {
    for (angle, speed, loss, methods) in [
        (0.3, 0.0, 1e-3, [Method::Auto, Method::Dop853]),
        (0.3, 0.0, 1e-5, [Method::Auto, Method::Time]),
        (-1.2, 33.0, 1e-3, [Method::Auto, Method::Time]),
        (2.9, -23.0, 8e-4, [Method::Auto, Method::Dopri5]),
    ] {
        let scene = pendulum(angle, speed, &format!("-{loss}*omega"));
        let (turning, (_, last)) = swings((angle, speed), |omega| -loss * omega, 100.0);
        assert!((last - angle).abs() < 3.0 * TAU, "it never completes them");
        for method in methods {
            let summary = run(&scene, method);
            let why = summary.stopped.expect("a reason").to_string();
            assert!(why.contains("does not complete 3 turns"), "{why}");
            assert!(why.contains("give a duration instead"), "{why}");
            let last = summary.last;
            let known = turning.iter().position(|at| (at.0 - last.t_s).abs() < 1e-4);
            let known = known.expect("it ends where it turns");
            assert_close(last.theta_rad, turning[known].1, 1e-5);
            // The message names the outermost points so far, start or turning points, and the motion stays between
            // them.
            let so_far = || turning[..=known].iter().map(|at| at.1).chain([angle]);
            let (low, high) = (
                so_far().fold(f64::INFINITY, f64::min),
                so_far().fold(f64::NEG_INFINITY, f64::max),
            );
            let said = between(&why);
            assert_close(said[0], low, 1e-3 * (high - low));
            assert_close(said[1], high, 1e-3 * (high - low));
            let after = &turning[known + 1..];
            assert!(after.len() > 20, "it goes on");
            assert!(after.iter().all(|at| low < at.1 && at.1 < high));
            assert!(summary.evaluations < 100_000, "{}", summary.evaluations);
        }
    }
}

/// Driven along its speed, the crank swings further each time and finally passes the top.
#[test]
fn a_crank_that_swings_ever_further_is_not_caught() {
    let gain = 2e-4;
    let scene = pendulum(-0.9, 0.0, &format!("{gain}*omega"));
    let (turning, (t, _)) = swings((-0.9, 0.0), |omega| gain * omega, 100.0);
    assert!(turning.len() > 5 && t < 99.0, "it completes them");
    for method in [Method::Auto, Method::Dop853] {
        let summary = run(&scene, method);
        assert_eq!(summary.stopped, None);
        assert_close(summary.last.t_s, t, 2e-4);
    }
}

/// As in a clock, the swing grows to a limit cycle, on which the torque supplies as much energy as it takes.
#[test]
fn a_swing_that_grows_to_one_that_lasts_is_caught() {
    let torque =
        |gain: f64, fast: f64| move |omega: f64| gain * omega * (1.0 - (omega / fast).powi(2));
    for (gain, fast, methods) in [
        (3e-4, 8.0, [Method::Auto, Method::Dop853]),
        (2e-3, 5.0, [Method::Auto, Method::Time]),
        (5e-5, 3.0, [Method::Auto, Method::Dopri5]),
    ] {
        let formula = format!("{gain}*omega*(1 - (omega/{fast})^2)");
        let scene = pendulum(-1.5, 0.0, &formula);
        let (turning, (_, last)) = swings((-1.5, 0.0), torque(gain, fast), 600.0);
        assert!((last + 1.5).abs() < 3.0 * TAU, "it never completes them");
        for method in methods {
            let summary = run(&scene, method);
            let why = summary.stopped.expect("a reason").to_string();
            assert!(why.contains("does not complete 3 turns"), "{why}");
            let said = between(&why);
            let (low, high) = (said[0].min(said[1]), said[0].max(said[1]));
            let after: Vec<_> = turning
                .iter()
                .filter(|at| at.0 > summary.last.t_s)
                .collect();
            assert!(after.len() > 20, "it goes on");
            let within = 1e-3 * (high - low);
            assert!(
                after
                    .iter()
                    .all(|at| low - within < at.1 && at.1 < high + within),
                "{why}"
            );
        }
    }
    // The limit cycle of this case is beyond the top.
    let (gain, fast) = (3e-4, 25.0);
    let scene = pendulum(-1.5, 0.0, &format!("{gain}*omega*(1 - (omega/{fast})^2)"));
    let (turning, (t, _)) = swings((-1.5, 0.0), torque(gain, fast), 100.0);
    assert!(turning.len() > 20 && t < 99.0, "it completes them");
    let summary = run(&scene, Method::Auto);
    assert_eq!(summary.stopped, None);
    assert_close(summary.last.t_s, t, 2e-4);
}

/// A load that sets in later may free the crank, so that the crank is not reported as caught.
#[test]
fn a_load_in_time_may_free_the_crank() {
    let scene = pendulum(0.3, 0.0, "-0.001*omega + 0.4*step(t - 5)");
    assert_eq!(run(&scene, Method::Auto).stopped, None);
}

/// Without loss all swings are equal, for every method.
#[test]
fn a_swing_without_loss_is_told_by_integration_in_time() {
    let scene = pendulum(0.3, 0.0, "0*theta");
    for method in [Method::Time, Method::Dop853] {
        let summary = run(&scene, method);
        let why = summary.stopped.expect("a reason").to_string();
        assert!(why.contains("does not complete 3 turns"), "{why}");
        let [low, high] = between(&why);
        assert_close(high, 0.3, 1e-9);
        assert_close(low, -TAU / 2.0 - 0.3, 1e-6);
    }
}

/// Very small friction takes too long to stop the crank, which is reported as caught; larger friction stops it soon,
/// which is reported as rest.
#[test]
fn a_crank_with_friction_is_caught_or_comes_to_rest() {
    let rubbing = |coefficient| {
        let mut scene = pendulum(0.3, 0.0, "0*theta");
        scene.slider = Some(Slider { mass: 0.1 });
        scene.friction = Some(Friction {
            coefficient,
            static_coefficient: coefficient,
        });
        scene
    };
    let why = run(&rubbing(0.05), Method::Auto)
        .stopped
        .expect("a reason")
        .to_string();
    assert!(why.contains("comes to rest"), "{why}");
    let caught = run(&rubbing(1e-5), Method::Auto);
    let said = between(&caught.stopped.expect("a reason").to_string());
    let long = run(&rubbing(1e-5).duration(2.0 * caught.last.t_s), Method::Auto);
    let turning = long
        .events
        .iter()
        .filter(|event| event.t_s > caught.last.t_s);
    let mut turning = turning
        .filter(|event| event.kind == "turning-point")
        .peekable();
    assert!(turning.peek().is_some());
    let (low, high) = (said[0].min(said[1]), said[0].max(said[1]));
    assert!(turning.all(|event| low < event.theta_rad && event.theta_rad < high));
}

/// Under a time-dependent load nothing is certain: the run ends when there has been no progress for long, and continues
/// while there is.
#[test]
fn a_crank_under_a_load_in_time_is_waited_for_as_long_as_it_gets_further() {
    let timed = |angle: f64, torque: &str| {
        let options = Options {
            max_evaluations: 20_000_000,
            ..Options::default()
        };
        simulate(&pendulum(angle, 0.0, torque), &options)
            .expect("a run")
            .summary
    };
    // The torque decays, and the swing then stays as it is; or the torque persists but is too weak to pass the top.
    for torque in ["0.01*exp(-t)", "0.02*sin(3*t) - 1e-4*omega"] {
        let summary = timed(-1.0, torque);
        let why = summary.stopped.expect("a reason").to_string();
        assert!(why.contains("does not complete 3 turns"), "{why}");
        assert!(why.contains("came no further"), "{why}");
        assert!(summary.evaluations < 5_000_000, "{}", summary.evaluations);
    }
    // After 500 s, some 2000 turning points, a torque larger than that of the weight sets in.
    let summary = timed(-1.0, "0.2*(1 + tanh(t - 500))");
    assert_eq!(summary.stopped, None);
    assert!(
        (495.0..510.0).contains(&summary.last.t_s),
        "{}",
        summary.last.t_s
    );
}
