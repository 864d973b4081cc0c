//! The limits of a crank that cannot turn fully, where the rod stands normal to the guide and the branches meet.
//!
//! A motion that comes to a limit may turn back just before it, on its branch, or pass it and go on along the other one:
//! the crank angle turns back either way, and within its uncertainty it does not tell which.

use super::fitted::Fitted;
use super::force::{Backwards, NEAR_LIMIT};
use super::sensor::Sensor;
use crate::error::Error;
use crate::mechanism::Linkage;
use crate::numeric::chebyshev::largest;
use crate::numeric::fit::{Curve, State};
use crate::scene::Measurement;
use std::f64::consts::TAU;

/// Standard errors of the crank angle within which a motion is at the limit.
const WITHIN: f64 = 5.0;

/// Times the largest residual nearby within which it is: a fit that misses a sharp turn has a band that is too narrow there.
const RESIDUALS: f64 = 2.0;

/// Samples on either side that are nearby.
const NEARBY: usize = 4;

/// Halvings of the time between two samples in the search for a turning point.
const HALVINGS: usize = 50;

/// What a user can do with a motion that reaches a limit.
pub(super) fn apart(linkage: &Linkage) -> String {
    format!(
        "invert the samples before the limit and those after it apart, and those beyond it with branch = \"{}\"",
        if linkage.s > 0.0 { "left" } else { "right" }
    )
}

/// Why samples cannot be fitted; next to a limit those of a slider or a rod tell nothing of the crank angle's motion.
/// What was noted of their crank angles may be the reason.
pub(super) fn unfit(linkage: &Linkage, what: String, noted: &[String]) -> Error {
    let help = "give more samples, or another --fit or --degree";
    let notes: String = noted.iter().map(|note| format!("\nnote: {note}")).collect();
    if linkage.limit_angles().is_empty() {
        return Error::refused(format!("{what}{notes}"), help);
    }
    let apart = apart(linkage);
    Error::refused(
        format!("{what}, or the motion comes to a limit of the crank{notes}"),
        format!("{help}; past a limit {apart}"),
    )
}

/// Refuses a motion that comes to a limit within its uncertainty, at the samples or where it turns between them.
pub(super) fn keeps_clear(
    backwards: &Backwards<'_>,
    sensor: &Sensor<'_>,
    fitted: &Fitted,
    measurement: &Measurement,
) -> Result<(), Error> {
    let (linkage, curve) = (sensor.linkage, &fitted.curve);
    let limits = linkage.limit_angles();
    if limits.is_empty() {
        return Ok(());
    }
    let times = measurement.elapsed();
    let mut before: Option<State> = None;
    for (sample, t) in times.iter().enumerate() {
        let state = curve.state(*t);
        let turn = before.and_then(|last| {
            let between = [times[sample - 1], *t];
            (last.value[1] * state.value[1] < 0.0).then(|| turning_point(curve, between))
        });
        let passed = before.is_some_and(|last| passes(&limits, &last, &state));
        for state in turn.into_iter().chain([state]) {
            let error = backwards.angle_error(&state);
            let theta = state.value[0];
            let way = distance(&limits, theta);
            let pose = linkage.pose(theta);
            let fits = || way > RESIDUALS * misfit(sensor, fitted, sample, theta);
            // A slider position tells no angle at the dead centres, which are elsewhere.
            let clear =
                pose.exists() && way > WITHIN * error && (pose.cos_phi > NEAR_LIMIT || fits());
            if passed || !clear {
                return Err(Error::refused(
                    format!(
                        "the crank comes to a limit at {} (t = {} s, theta = {theta} rad, standard error {error:.1e}), where the rod stands normal to the guide: whether the motion turns back there or goes on along the other branch is not certain",
                        measurement.place(sample),
                        measurement.times()[sample]
                    ),
                    apart(linkage),
                ));
            }
        }
        before = Some(state);
    }
    Ok(())
}

/// The largest residual near a sample, as a crank angle, rad; of a fit that has almost as many parameters as samples, what it
/// would be without.
fn misfit(sensor: &Sensor<'_>, fitted: &Fitted, sample: usize, theta: f64) -> f64 {
    let last = fitted.residuals.len().min(sample + NEARBY + 1);
    let nearby = &fitted.residuals[sample.saturating_sub(NEARBY)..last];
    let (_, slope) = sensor.residual(0.0, theta);
    let samples = fitted.residuals.len() as f64;
    let free = (samples - fitted.curve.quality().parameters).max(1.0);
    largest(nearby) * (samples / free).sqrt() / slope.abs()
}

/// The way from a crank angle to the nearest limit, rad.
fn distance(limits: &[f64], theta: f64) -> f64 {
    let from = |limit: &f64| {
        let off = theta - limit;
        (off - (off / TAU).round() * TAU).abs()
    };
    limits.iter().map(from).fold(f64::INFINITY, f64::min)
}

/// Whether a limit lies between two states, as a change point may.
fn passes(limits: &[f64], a: &State, b: &State) -> bool {
    let turn = |state: &State, limit: f64| ((state.value[0] - limit) / TAU).floor();
    limits
        .iter()
        .any(|limit| turn(a, *limit) != turn(b, *limit))
}

/// The motion between two times where it turns back.
fn turning_point(curve: &Curve, [mut from, mut to]: [f64; 2]) -> State {
    let forwards = curve.state(from).value[1] > 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if (curve.state(middle).value[1] > 0.0) == forwards {
            from = middle;
        } else {
            to = middle;
        }
    }
    curve.state(0.5 * (from + to))
}
