//! Whether a swing that grows stays inside a larger one that shrinks.
//!
//! Where the state says what follows, a path in the plane of angle and speed that starts at rest further out and comes
//! back to rest less far out on the same side encloses all motion inside it for ever: paths do not cross.

use super::error_estimate::Forward;
use crate::engine::events::{self, Crossing};
use crate::engine::time::{self, Method, Settings, Start};
use crate::engine::{Counted, Motion};
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;

/// How much less far out it has to come back, in parts of the swing: far more than the run is off at its tolerance.
const LESS: f64 = 1e-6;
const TOLERANCE: f64 = 1e-12;
/// Least distance of the larger swing, in parts of the one that grows.
const LEAST: f64 = 1e-3;
/// The larger swing starts beyond where the growth seems to lead to by as much again.
const BEYOND: f64 = 2.0;
/// Most evaluations for a swing to and fro.
const MOST_EVALUATIONS: u64 = 1_000_000;

/// Where to start a larger swing, from five turning points of one that grows: the distances of those on one side, if
/// they shrink, lead to a last one. None if they do not.
pub(super) fn further_out(points: &[Angle; 5]) -> Option<Angle> {
    let [first, _, second, other, third] = *points;
    let (before, after) = (second.minus(first), third.minus(second));
    let width = third.minus(other);
    let share = after / before;
    if after * width < 0.0 || !(0.0..1.0).contains(&share) {
        return None;
    }
    let left = after.abs() * share / (1.0 - share);
    let further = (BEYOND * left).max(LEAST * width.abs());
    Some(third.plus(further.copysign(width)))
}

/// The angles between which all motion stays that is inside a swing from rest at the angle `from`, if it encloses it and
/// the turning point `inner`.
pub(super) fn enclosed(equation: &Equation, from: Angle, inner: Angle) -> Option<[Angle; 2]> {
    let forward = Forward(equation);
    let motion = Counted::new(&forward);
    let start = Start {
        t: 0.0,
        angle: from,
        speed: 0.0,
    };
    let settings = Settings {
        method: Method::Picard,
        tolerance: TOLERANCE,
        t_end: time::FAR,
        way: f64::INFINITY,
        max_evaluations: MOST_EVALUATIONS,
        work_unit: 1.0,
    };
    let inwards = motion.acceleration(0.0, from, 0.0);
    let mut turnings = Vec::new();
    let mut found = Vec::new();
    time::run(&motion, start, &settings, &mut |step| {
        let mut step = *step;
        events::crossings(&step, &[], &mut found);
        if !found.is_empty() {
            step.refine(&motion);
            events::crossings(&step, &[], &mut found);
        }
        let rests = found.iter().filter(|(_, what)| *what == Crossing::Turning);
        turnings.extend(rests.map(|(t, _)| step.angle(step.at(*t).0)));
        turnings.len() >= 2
    });
    let [other, back, ..] = turnings[..] else {
        return None;
    };
    let width = other.minus(from);
    let less = back.minus(from) / width;
    let depth = inner.minus(from) / width;
    let closes = inwards * width > 0.0 && less > LESS && (less..1.0).contains(&depth);
    closes.then_some([other, from])
}
