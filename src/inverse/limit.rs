//! Check of a motion against the limits of a rocker, where the rod stands normal to the guide and the branches meet.
//!
//! A motion that comes to a limit may turn back just before it, on its branch, or pass it and go on along the other
//! one: the crank angle turns back either way, and within its uncertainty does not show which happened.

use super::fitted::Fitted;
use super::measurement_model::Sensor;
use super::motion_estimate::MotionEstimate;
use super::result::inverse_dynamics::NEAR_LIMIT;
use crate::error::Error;
use crate::mechanism::Linkage;
use crate::numeric::angle::circular_distance;
use crate::scene::Measurement;
use std::f64::consts::TAU;

/// Distance from a limit, in standard errors of the crank angle, within which a motion counts as at the limit.
const WITHIN: f64 = 5.0;

/// Refuses a motion that comes to a limit within its uncertainty or that of a sample, at the samples or where it turns
/// between them: smoothing across a limit gives another motion.
pub(super) fn keeps_clear(
    sensor: &Sensor<'_>,
    fitted: &Fitted,
    measurement: &Measurement,
) -> Result<(), Error> {
    let (linkage, motion) = (sensor.linkage, &fitted.motion);
    let values = measurement.values();
    let limits = linkage.limit_angles();
    if limits.is_empty() {
        return Ok(());
    }
    for (sample, state) in motion.iter().enumerate() {
        let before = sample.checked_sub(1).map(|before| &motion[before]);
        let passed = before.is_some_and(|before| passes(&limits, before, state));
        let error = state.angle_error();
        let beside = &values[sample.saturating_sub(1)..values.len().min(sample + 2)];
        // Between this sample and those beside it the value may go on by half their distance.
        let steps = beside.windows(2).map(|w| 0.5 * (w[1] - w[0]).abs());
        let reach = steps.fold(0.0, f64::max) + WITHIN * fitted.summary.sigma;
        let shows = |limit: &f64| {
            let limit = nearest(*limit, state.value[0]);
            // Just inside: rounding may put the limit itself out of reach.
            let inside = limit + 8.0 * f64::EPSILON * (state.value[0] - limit).signum();
            sensor
                .residual(values[sample], [inside, state.value[1]])
                .0
                .abs()
                < reach
        };
        let shown = limits.iter().any(shows);
        let turn = before.and_then(|before| turning_angle(before, state));
        for (theta, more) in turn.into_iter().chain([(state.value[0], 0.0)]) {
            let pose = linkage.pose(theta);
            let within = WITHIN * error + more;
            let is_apart = |limit: &f64| circular_distance(theta, *limit) > within;
            let far = pose.cos_phi > NEAR_LIMIT || !shown && limits.iter().all(is_apart);
            if passed || !pose.is_regular() || !far {
                return Err(refusal(linkage, measurement, sample, theta, error));
            }
        }
    }
    Ok(())
}

pub(super) fn refusal(
    linkage: &Linkage,
    measurement: &Measurement,
    sample: usize,
    theta: f64,
    error: f64,
) -> Error {
    Error::refused(
        format!(
            "the crank comes to a limit at {} (t = {} s, theta = {theta} rad, standard error {error:.1e}), where the rod stands normal to the guide: whether the motion turns back there or goes on along the other branch is not certain",
            measurement.place(sample),
            measurement.times()[sample]
        ),
        format!(
            "invert the samples before the limit and those after it apart, and those beyond it with branch = \"{}\"",
            if linkage.s > 0.0 { "left" } else { "right" }
        ),
    )
}

/// Returns the limit angle in the turn nearest to a crank angle, rad.
fn nearest(limit: f64, theta: f64) -> f64 {
    limit + ((theta - limit) / TAU).round() * TAU
}

/// True if a limit lies between the crank angles of two states.
fn passes(limits: &[f64], a: &MotionEstimate, b: &MotionEstimate) -> bool {
    let turn = |state: &MotionEstimate, limit: f64| ((state.value[0] - limit) / TAU).floor();
    limits
        .iter()
        .any(|limit| turn(a, *limit) != turn(b, *limit))
}

/// Returns the crank angle at which the motion turns back between two samples, and its uncertainty, rad: the vertex of
/// the parabola of the slower sample, and the distance of the other's vertex.
fn turning_angle(a: &MotionEstimate, b: &MotionEstimate) -> Option<(f64, f64)> {
    let [of_a, of_b] = [a, b].map(|state| {
        let [theta, omega, alpha] = state.value;
        theta - 0.5 * omega * omega / alpha
    });
    let nearer = if a.value[1].abs() < b.value[1].abs() {
        of_a
    } else {
        of_b
    };
    let turn = (nearer, (of_a - of_b).abs());
    (a.value[1] * b.value[1] < 0.0 && turn.1.is_finite()).then_some(turn)
}
