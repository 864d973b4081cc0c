//! Work forecast: runs that cannot reach their end are given up, and no others.

use slider_crank::engine::WorkLimit;
use slider_crank::engine::time::{Ends, UNLIMITED_TIME};
use slider_crank::engine::work_forecast::WorkForecast;

const LIMIT: u64 = 100_000_000;

/// Feeds the forecast with a run that takes 100 evaluations a turn and has turned by `way(t)` (rad); returns whether it
/// is given up before its end or the limit.
fn given_up(ends: Ends<'_>, in_time: bool, way: impl Fn(f64) -> f64) -> bool {
    let mut pace = WorkForecast::new(0.0, 0, ends, in_time);
    let (mut t, mut before, mut evaluations) = (0.0, 0.0, 0);
    while t < ends.t && before < ends.way && evaluations < LIMIT {
        t += 1e-3;
        let turned: f64 = way(t) - before;
        evaluations += (turned.abs() * 20.0) as u64;
        before = way(t);
        if pace.reason_to_stop(evaluations, t, turned).is_some() {
            return true;
        }
    }
    false
}

fn ends(t: f64, way: f64) -> Ends<'static> {
    Ends {
        t,
        way,
        limit: WorkLimit {
            evaluations: LIMIT,
            stop: None,
        },
    }
}

#[test]
fn a_speed_that_lasts_is_given_up_if_it_takes_too_long() {
    let steady = |t: f64| 1e6 * t;
    assert!(given_up(ends(1e3, f64::INFINITY), false, steady));
    assert!(given_up(ends(UNLIMITED_TIME, 1e9), false, steady));
    assert!(given_up(ends(1e3, f64::INFINITY), false, |t| 1e6 * t * t));
    assert!(!given_up(ends(4.0, f64::INFINITY), false, steady));
    assert!(!given_up(ends(UNLIMITED_TIME, 4e6), false, steady));
}

/// Runs that must not be given up: friction may stop the crank, a load in time may do anything, and a swinging crank
/// makes few turns.
#[test]
fn a_speed_that_may_not_last_is_not() {
    let slowing = |t: f64| 4e6 * (1.0 - (-t).exp());
    assert!(!given_up(ends(1e3, f64::INFINITY), false, slowing));
    let stopping = |t: f64| {
        if t < 4.0 {
            1e6 * (t - t * t / 8.0)
        } else {
            2e6
        }
    };
    assert!(!given_up(ends(1e3, f64::INFINITY), false, stopping));
    assert!(!given_up(ends(5e1, f64::INFINITY), true, |t| 1e6 * t));
    assert!(!given_up(ends(UNLIMITED_TIME, 1e9), false, |t| 1e2 * (1e2 * t).sin()));
}
