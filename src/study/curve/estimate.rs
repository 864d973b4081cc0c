//! Global error of a run on the curve.

use std::time::Instant;

use super::arrived::Follow;
use super::arrived::{Arrived, End, Observer};
use super::crank_state;
use super::phase::Phase;
use crate::engine::step::Step;
use crate::engine::time::Settings;
use crate::numeric::angle::Angle;
use crate::study::summary::{Cost, ErrorEstimate};

/// The second run of the estimate is this much tighter.
const TIGHTER: f64 = 50.0;
/// What is stated is larger than the distance of the two runs by this.
const MARGIN: f64 = 1.5;
/// Tighter than this only by so much: rounding inside the steps takes over, and they would collapse.
const TIGHTEST: f64 = 1e-13;
const A_LITTLE: f64 = 5.0;

/// The tolerance of a second run.
pub(in crate::study) fn tighter(tolerance: f64) -> f64 {
    (tolerance / TIGHTER).max(TIGHTEST.min(tolerance / A_LITTLE))
}

/// Adds up what rounding does to a run.
struct Shaken {
    unevenness: f64,
    largest_speed: f64,
}

impl Observer for Shaken {
    fn step(&mut self, step: &Step, _: Phase) -> bool {
        let travel = step.end.theta - step.start.theta;
        self.largest_speed = self.largest_speed.max(step.end.omega.abs());
        if travel != 0.0 && step.end.alpha.is_finite() {
            let slope = (step.end.alpha - step.start.alpha) / travel;
            let angle = 4.0 * step.end.theta.abs() * slope;
            let evaluation = 64.0 * step.end.alpha;
            self.unevenness += (angle * angle + evaluation * evaluation) * step.length().powi(2);
        }
        false
    }

    fn event(&mut self, _: &'static str, _: f64, _: Angle, _: f64) {}
}

/// Global error of the last state: its distance from a much tighter run, and what rounding may have added.
pub(super) fn estimate(follow: &Follow<'_>, arrived: &Arrived) -> Option<(ErrorEstimate, Cost)> {
    let begun = Instant::now();
    let end = arrived.last.end;
    let second = Follow {
        equation: follow.equation,
        settings: Settings {
            tolerance: tighter(follow.settings.tolerance),
            t_end: end.t,
            max_evaluations: follow.settings.max_evaluations.saturating_mul(4),
            ..follow.settings
        },
        start: follow.start,
        turn_limit: None,
        turned_from: follow.turned_from,
    };
    let mut shaken = Shaken {
        unevenness: 0.0,
        largest_speed: 0.0,
    };
    let best = second.run(&mut shaken);
    if best.end != End::Done {
        return None;
    }
    let curve = follow.equation.curve();
    let (a, b) = (
        crank_state(curve, &arrived.last),
        crank_state(curve, &best.last),
    );
    let roundings = ((arrived.steps + best.steps) as f64).sqrt();
    let noise = f64::EPSILON * (0.5 * shaken.largest_speed * roundings + shaken.unevenness.sqrt());
    let duration = end.t - follow.start.t;
    let angle_noise = 0.5 * f64::EPSILON * (1.0 + end.theta.abs()) * roundings
        + noise * duration
        + f64::EPSILON * a.0.radians().abs();
    // The same time in the motion, at another angle.
    let bend = if end.omega == 0.0 {
        0.0
    } else {
        (end.alpha / end.omega * angle_noise).abs()
    };
    let place = curve.place(end.theta);
    let dtheta = place.dtheta.abs().max(f64::EPSILON);
    let still = arrived.last.end.omega == 0.0 && best.last.end.omega == 0.0;
    let rounded = if still { 0.0 } else { 1.0 };
    let estimate = ErrorEstimate {
        theta_rad: MARGIN * a.0.minus(b.0).abs() + dtheta * angle_noise,
        omega_rad_per_s: MARGIN * (a.1 - b.1).abs()
            + rounded
                * (dtheta * (noise + bend) + place.d2theta.abs() * end.omega.abs() * angle_noise),
    };
    let cost = Cost {
        evaluations: best.evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    Some((estimate, cost))
}
