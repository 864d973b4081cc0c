//! Passages of given angles and turning points, located inside the steps.

use std::f64::consts::TAU;

use super::step::Step;
use super::{Motion, NODES, PIECES};
use crate::numeric::exact::SUM_ROUNDING;
use crate::numeric::root;

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// The angle passed the watched angle of this index.
    Angle(usize),
    /// The speed changed its sign.
    Turning,
}

/// Most turning points that are found in a step.
const TURNINGS: usize = 6;

/// An angle in its turn, and one that is watched, are rounded by less than this together, rad.
pub const ROUNDED: f64 = 4.0 * f64::EPSILON * TAU;

/// All crossings inside a step, in the order of time, as (time, what). `watched` are angles in [0, 2π).
pub fn crossings(step: &Step, watched: &[f64], found: &mut Vec<(f64, Crossing)>) {
    found.clear();
    let mut cuts = [step.start.t; TURNINGS + 2];
    let mut count = 1;
    turning_brackets(step, |from, to| {
        if count <= TURNINGS
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

/// Intervals in which the speed changes sign; none for the usual step whose speed stays clear of zero.
fn turning_brackets(step: &Step, mut bracket: impl FnMut(f64, f64)) {
    let (w0, w1) = (step.start.omega, step.end.omega);
    let change = step.length() * step.start.alpha.abs().max(step.end.alpha.abs());
    if w0 * w1 > 0.0 && w0.abs().min(w1.abs()) > 2.0 * change {
        return;
    }
    let mut before = SpeedAt::at(step, step.start.t);
    for i in 1..=PIECES {
        let t = match i {
            PIECES => step.end.t,
            _ => step.start.t + step.length() * i as f64 / PIECES as f64,
        };
        let after = SpeedAt::at(step, t);
        // A speed that comes nearer to zero at first, and then leaves again.
        let dips = before.approach < 0.0 && after.approach > 0.0 || before.speed == 0.0;
        let lowest = if dips {
            root::bracketed(|t| step.acceleration_at(t), before.t, t)
        } else {
            None
        };
        // From rest a speed may be rounding first.
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

/// Speed at a time, and how fast its size grows.
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

/// Passages of watched angles on a piece where the angle is monotone. The angle of the start does not count, that of the end
/// does, and what rounding does not tell from either is the same: steps that end at a watched angle pass it once.
fn passages(step: &Step, watched: &[f64], from: f64, to: f64, found: &mut Vec<(f64, Crossing)>) {
    let (a, b) = (step.at(from).0, step.at(to).0);
    let direction = (b - a).signum();
    for (index, angle) in watched.iter().enumerate() {
        let mut turn = ((a.min(b) - ROUNDED - angle) / TAU).floor();
        loop {
            let target = angle + turn * TAU;
            if target > a.max(b) + ROUNDED {
                break;
            }
            if direction * (target - a) > ROUNDED && direction * (target - b) <= ROUNDED {
                let t = step.time_of_angle(target, from, to).unwrap_or(to);
                found.push((t, Crossing::Angle(index)));
            }
            turn += 1.0;
        }
    }
}

/// Pieces of a step without a polynomial of its own, in which an extreme is looked for.
const PIECES_BETWEEN_ENDS: usize = 2;

/// How the acceleration of a step goes at equally spaced times; a polynomial of its own may go up and down as often as it has
/// nodes.
fn accelerations(step: &Step) -> ([f64; NODES + 1], usize) {
    let mut all = [0.0; NODES + 1];
    if step.has_polynomial() {
        return (step.accelerations(), NODES);
    }
    let few: [f64; PIECES_BETWEEN_ENDS + 1] = step.accelerations();
    all[..few.len()].copy_from_slice(&few);
    (all, PIECES_BETWEEN_ENDS)
}

/// Widens a range of speeds by those of a step.
pub fn speed_range(step: &Step, known: (f64, f64)) -> (f64, f64) {
    let (rates, pieces) = accelerations(step);
    let value = |t: f64| step.at(t).1;
    let rate = |t: f64| step.acceleration_at(t);
    widened(step, known, &rates[..=pieces], value, rate)
}

/// Least and largest speed over a step; where a new extreme may lie inside, the step is refined first.
pub fn follow_speed(step: &mut Step, motion: &dyn Motion, known: (f64, f64)) -> (f64, f64) {
    refine_for(step, motion, known, |step, t| step.at(t).1, speed_range);
    speed_range(step, known)
}

/// Least and largest of any value, given with its rate of change at a time in the step.
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
    refine_for(step, motion, known, |step, t| at(step, t).0, look);
    look(step, known)
}

/// Refines a step that may hold more inside than at its ends.
fn refine_for(
    step: &mut Step,
    motion: &dyn Motion,
    known: (f64, f64),
    value: impl Fn(&Step, f64) -> f64,
    look: impl Fn(&Step, (f64, f64)) -> (f64, f64),
) {
    if step.is_refined() {
        return;
    }
    // What the ends alone tell of the inside may be off by this much.
    let margin = 1e-3 * known.0.abs().max(known.1.abs());
    let (a, b) = (value(step, step.start.t), value(step, step.end.t));
    let near = (
        a.min(b).min(known.0 + margin),
        a.max(b).max(known.1 - margin),
    );
    if look(step, near) != near {
        step.refine(motion);
    }
}

/// The time at which the piece of this index begins.
fn part(step: &Step, index: usize, pieces: usize) -> f64 {
    if index == pieces {
        step.end.t
    } else {
        step.start.t + step.length() * index as f64 / pieces as f64
    }
}

/// Widens a range by the values at the ends and where `rate`, given at equally spaced times, changes its sign.
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
            // An extreme at one of the times itself.
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
