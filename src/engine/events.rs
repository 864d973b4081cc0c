//! Passages of given angles, turning points and extremes inside an accepted step, by root finding on its interpolant.

use std::f64::consts::TAU;

use super::step::Step;
use super::{Motion, NODES, PIECES};
use crate::numeric::exact::SUM_ROUNDING;
use crate::numeric::root;

/// Kind of a located event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// Passage of a watched angle.
    Angle,
    /// Sign change of the speed.
    Turning,
}

/// Bound of the joint rounding error of an angle reduced to one turn and a watched angle, rad.
pub const ANGLE_ROUNDING: f64 = 4.0 * f64::EPSILON * TAU;

/// Finds all crossings inside a step, in time order, as (time, kind). `watched`: angles in [0, 2π), rad.
pub fn crossings(step: &Step, watched: &[f64], found: &mut Vec<(f64, Crossing)>) {
    found.clear();
    // Ends of the step, and the first turning points.
    let mut cuts = [step.start.t; 8];
    let mut count = 1;
    turning_brackets(step, |from, to| {
        if count + 1 < cuts.len()
            && let Some(t) = root::bracketed(|t| step.at(t).1, from, to)
            && t > step.start.t
        {
            found.push((t, Crossing::Turning));
            cuts[count] = t;
            count += 1;
        }
    });
    cuts[count] = step.end.t;
    for w in cuts[..=count].windows(2) {
        passages(step, watched, w[0], w[1], found);
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
}

/// Finds intervals in which the speed changes sign; none for the usual step whose speed stays clear of zero, and none
/// where all of the step turns the crank by less than the rounding of its angle: the sign is rounding there, too.
fn turning_brackets(step: &Step, mut bracket: impl FnMut(f64, f64)) {
    let (w0, w1) = (step.start.omega, step.end.omega);
    let change = step.length() * step.start.alpha.abs().max(step.end.alpha.abs());
    if w0 * w1 > 0.0 && w0.abs().min(w1.abs()) > 2.0 * change {
        return;
    }
    let turned = |i| step.at(part(step, i, PIECES)).0 - step.start.theta;
    if (1..=PIECES).all(|i| turned(i).abs() < ANGLE_ROUNDING) {
        return;
    }
    let mut before = SpeedAt::at(step, step.start.t);
    for i in 1..=PIECES {
        let t = part(step, i, PIECES);
        let after = SpeedAt::at(step, t);
        // The speed approaches zero and recedes again.
        let dips = before.approach < 0.0 && after.approach > 0.0 || before.speed == 0.0;
        let lowest = if dips {
            root::bracketed(|t| step.acceleration_at(t), before.t, t)
        } else {
            None
        };
        // Just after rest the speed may be mere rounding.
        let lowest = lowest
            .map(|t| SpeedAt::at(step, t))
            .filter(|turn| turn.speed.abs() > SUM_ROUNDING * w0.abs().max(w1.abs()));
        let mut from = before;
        for to in [lowest, Some(after)].into_iter().flatten() {
            if from.speed * to.speed < 0.0 || (to.speed == 0.0 && from.speed != 0.0) {
                bracket(from.t, to.t);
            }
            from = to;
        }
        before = after;
    }
}

/// Speed, rad/s, at a time, s, and half the time derivative of its square, rad²/s³.
#[derive(Clone, Copy)]
struct SpeedAt {
    t: f64,
    speed: f64,
    approach: f64,
}

impl SpeedAt {
    fn at(step: &Step, t: f64) -> SpeedAt {
        let speed = step.at(t).1;
        SpeedAt {
            t,
            speed,
            approach: speed * step.acceleration_at(t),
        }
    }
}

/// Finds the passages of watched angles on an interval with monotone angle. The angle at the start is excluded, the one
/// at the end included, both with a margin of [`ANGLE_ROUNDING`]: steps that end at a watched angle pass it once.
fn passages(step: &Step, watched: &[f64], from: f64, to: f64, found: &mut Vec<(f64, Crossing)>) {
    let (a, b) = (step.at(from).0, step.at(to).0);
    let direction = (b - a).signum();
    for angle in watched {
        let mut turn = ((a.min(b) - ANGLE_ROUNDING - angle) / TAU).floor();
        loop {
            let target = angle + turn * TAU;
            if target > a.max(b) + ANGLE_ROUNDING {
                break;
            }
            if direction * (target - a) > ANGLE_ROUNDING
                && direction * (target - b) <= ANGLE_ROUNDING
            {
                let t = step.time_of_angle(target, from, to).unwrap_or(to);
                found.push((t, Crossing::Angle));
            }
            turn += 1.0;
        }
    }
}

/// Samples the acceleration at equally spaced times and returns the samples and the number of intervals: two, or one
/// for each node of a collocation polynomial, which may oscillate as often as it has nodes.
fn accelerations(step: &Step) -> ([f64; NODES + 1], usize) {
    let mut all = [0.0; NODES + 1];
    if step.has_polynomial() {
        return (step.accelerations(), NODES);
    }
    let few: [f64; 3] = step.accelerations();
    all[..few.len()].copy_from_slice(&few);
    (all, few.len() - 1)
}

/// Widens a range of speeds, rad/s, by the extremes on a step.
pub fn speed_range(step: &Step, known: (f64, f64)) -> (f64, f64) {
    let (rates, pieces) = accelerations(step);
    let value = |t: f64| step.at(t).1;
    let rate = |t: f64| step.acceleration_at(t);
    widened(step, known, &rates[..=pieces], value, rate)
}

/// Widens a range of speeds, rad/s, by the extremes on a step, which is refined first if a new extreme may lie inside.
pub fn follow_speed(step: &mut Step, motion: &dyn Motion, known: (f64, f64)) -> (f64, f64) {
    refined_range(step, motion, known, |step, t| step.at(t).1, speed_range)
}

/// Widens the range of any quantity by its extremes on a step; `at` returns value and time derivative at a time.
pub fn follow(
    step: &mut Step,
    motion: &dyn Motion,
    known: (f64, f64),
    at: impl Fn(&Step, f64) -> (f64, f64),
) -> (f64, f64) {
    let look = |step: &Step, range| {
        let rates: [f64; NODES + 1] = std::array::from_fn(|i| at(step, part(step, i, NODES)).1);
        widened(step, range, &rates, |t| at(step, t).0, |t| at(step, t).1)
    };
    refined_range(step, motion, known, |step, t| at(step, t).0, look)
}

/// Widens a known range, as `look` does, on a step that is refined where the quantity may go beyond it between the ends.
fn refined_range(
    step: &mut Step,
    motion: &dyn Motion,
    known: (f64, f64),
    value: impl Fn(&Step, f64) -> f64,
    look: impl Fn(&Step, (f64, f64)) -> (f64, f64),
) -> (f64, f64) {
    // Error bound of the extremes estimated from the ends alone.
    let margin = 1e-3 * known.0.abs().max(known.1.abs());
    let (a, b) = (value(step, step.start.t), value(step, step.end.t));
    let near = (
        a.min(b).min(known.0 + margin),
        a.max(b).max(known.1 - margin),
    );
    if !step.is_refined() && look(step, near) != near {
        step.refine(motion);
    }
    look(step, known)
}

/// Returns the time at which the piece with this index begins, s.
pub fn part(step: &Step, index: usize, pieces: usize) -> f64 {
    if index == pieces {
        step.end.t
    } else {
        step.start.t + step.length() * index as f64 / pieces as f64
    }
}

/// Widens a range by the values at the ends and at the zeros of `rate`; `rates` samples it at equally spaced times.
fn widened(
    step: &Step,
    mut range: (f64, f64),
    rates: &[f64],
    value: impl Fn(f64) -> f64,
    rate: impl Fn(f64) -> f64,
) -> (f64, f64) {
    let mut widen = |value: f64| range = (range.0.min(value), range.1.max(value));
    widen(value(step.start.t));
    widen(value(step.end.t));
    let pieces = rates.len() - 1;
    for (i, pair) in rates.windows(2).enumerate() {
        if pair[0] * pair[1] >= 0.0 {
            // Extreme exactly at a sample.
            if pair[1] == 0.0 {
                widen(value(part(step, i + 1, pieces)));
            }
            continue;
        }
        let (from, to) = (part(step, i, pieces), part(step, i + 1, pieces));
        if let Some(t) = root::bracketed(&rate, from, to) {
            widen(value(t));
        }
    }
    range
}
