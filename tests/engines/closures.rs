//! Pulses of closures that state their finest scale, compared with closed forms: all inertia is on the crank.

use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use slider_crank::plan::{Cycle, Method};
use slider_crank::scene::{Crank, Instant, Load, Period, Scene, Variable, Variables};
use slider_crank::simulate::{Options, simulate};

const INERTIA: f64 = 0.02;
const SPEED: f64 = 10.0;

fn crank(load: Load) -> Scene {
    Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .torque(load)
        .start(0.3, SPEED)
        .duration(5.0)
}

/// Returns exp(−s²) about a place, with value 1/e at distance `width`.
fn pulse(height: f64, at: f64, width: f64) -> impl Fn(f64) -> f64 + Send + Sync + 'static {
    move |x| height * (-((x - at) / width).powi(2)).exp()
}

fn end(scene: &Scene, method: Method) -> (f64, f64) {
    let options = Options {
        method,
        ..Options::default()
    };
    let summary = simulate(scene, &options).expect("a run").summary;
    assert_eq!(summary.stopped, None, "{method}");
    let error = summary.error_estimate.expect("estimated");
    (summary.last.omega_rad_per_s, error.omega_rad_per_s)
}

#[track_caller]
fn meets(scene: &Scene, method: Method, wanted: f64) {
    let (omega, stated) = end(scene, method);
    let off = (omega - wanted).abs();
    // The tolerance of dop853 applies per step.
    let tolerance = 10.0 * scene.run.tolerance * wanted;
    assert!(
        off <= stated.max(tolerance),
        "{method}: {omega} for {wanted}, stated {stated}"
    );
}

/// I Δω is the area of the pulse.
#[test]
fn a_pulse_in_time_of_a_closure_is_seen() {
    for (at, width) in [(1.234, 1e-4), (3.7, 1e-3), (4.9, 1e-5)] {
        let area = 0.5;
        let height = area / (width * PI.sqrt());
        let torque = pulse(height, at, width);
        let load = Load::function(Variables::T, move |now| torque(now.t));
        let scene = crank(load.with_finest_scale(Variable::T, width));
        for method in [Method::Auto, Method::Time, Method::Dop853] {
            meets(&scene, method, SPEED + area / INERTIA);
        }
    }
}

/// ½ I (ω² − ω₀²) is the area of the pulse, which acts once.
#[test]
fn a_pulse_over_the_angle_of_a_closure_is_seen() {
    for (at, width) in [(20.4, 0.035), (33.3, 1e-3)] {
        let area = 2.0;
        let torque = pulse(area / (width * PI.sqrt()), at, width);
        let load = Load::function(Variables::THETA, move |now| torque(now.theta));
        let scene = crank(load.with_finest_scale(Variable::Theta, width));
        let wanted = (SPEED * SPEED + 2.0 * area / INERTIA).sqrt();
        for method in [Method::Auto, Method::Time, Method::Dop853] {
            meets(&scene, method, wanted);
        }
    }
}

#[test]
fn a_closure_that_states_no_scale_is_said_to_be_sampled() {
    let load = || Load::function(Variables::T, |now| now.t.sin());
    let said = |load: Load| Cycle::of(&crank(load)).loads[0].between_nodes;
    assert!(said(load()).expect("said").contains("no guarantee"));
    assert_eq!(said(load().with_finest_scale(Variable::T, 0.5)), None);
    assert!(said(load().with_finest_scale(Variable::Theta, 0.5)).is_some());
    assert!(said(load().with_finest_scale(Variable::T, 0.0)).is_some());
    assert_eq!(said(Load::Constant(1.0)), None);
}

/// A gas at ambient pressure pushes by what rounding leaves of the difference, which no bisection of a quadrature removes.
#[test]
fn a_load_that_is_rounding_over_most_of_a_turn_costs_no_more() {
    let calls = Arc::new(AtomicU64::new(0));
    let counted = calls.clone();
    let gauge_pressure = move |now: &Instant| {
        counted.fetch_add(1, Ordering::Relaxed);
        let pressure = 1e5 + 2e6 * (-20.0 * (1.0 - (now.theta - 1.0).cos())).exp();
        1e-6 * (pressure - 1e5)
    };
    let load = Load::function(Variables::THETA, gauge_pressure).with_period(Period::TURN);
    let scene = crank(load.with_finest_scale(Variable::Theta, 0.2)).start(3.0, 1.0);
    let summary = simulate(&scene.duration(7.5), &Options::default()).unwrap();
    assert_eq!(summary.summary.engine, "energy");
    let calls = calls.load(Ordering::Relaxed);
    assert!(calls < 20_000, "{calls}");
}
