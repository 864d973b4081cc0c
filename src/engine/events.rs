//! Passages of given angles and turning points, located inside the steps.

use std::f64::consts::TAU;

use super::step::Step;

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// The angle passed the watched angle of this index.
    Angle(usize),
    /// The speed changed its sign.
    Turning,
}

/// A step whose speed may vanish inside is cut into pieces, on each of which the speed has at most one
/// extreme.
const PIECES: usize = 8;

/// Most turning points that are found in a step.
const TURNINGS: usize = 6;

/// All crossings inside a step, in the order of time, as (time, what). `watched` are angles in [0, 2π).
pub fn crossings(step: &Step, watched: &[f64], found: &mut Vec<(f64, Crossing)>) {
    found.clear();
    let mut cuts = [step.start.t; TURNINGS + 2];
    let mut count = 1;
    turning_brackets(step, |from, to| {
        if count <= TURNINGS
            && let Some(t) = step.time_of_rest(from, to)
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
    let mut before = Turn::at(step, step.start.t);
    for i in 1..=PIECES {
        let t = match i {
            PIECES => step.end.t,
            _ => step.start.t + step.length() * i as f64 / PIECES as f64,
        };
        let after = Turn::at(step, t);
        // A speed that comes nearer to zero at first, and then leaves again.
        let dips = before.approach < 0.0 && after.approach > 0.0 || before.speed == 0.0;
        let lowest = if dips {
            step.time_of_extreme_speed(before.t, t)
        } else {
            None
        };
        let mut from = before;
        for to in [lowest.map(|t| Turn::at(step, t)), Some(after)]
            .into_iter()
            .flatten()
        {
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
struct Turn {
    t: f64,
    speed: f64,
    approach: f64,
}

impl Turn {
    fn at(step: &Step, t: f64) -> Turn {
        let speed = step.at(t).1;
        Turn {
            t,
            speed,
            approach: speed * step.acceleration_at(t),
        }
    }
}

/// Passages of watched angles on a piece where the angle is monotone; the start does not count.
fn passages(step: &Step, watched: &[f64], from: f64, to: f64, found: &mut Vec<(f64, Crossing)>) {
    let (a, b) = (step.at(from).0, step.at(to).0);
    let (low, high) = (a.min(b), a.max(b));
    for (index, angle) in watched.iter().enumerate() {
        let mut turn = ((low - angle) / TAU).floor();
        loop {
            let target = angle + turn * TAU;
            if target > high {
                break;
            }
            let passed = if b > a { target > a } else { target < a };
            if target >= low
                && passed
                && let Some(t) = step.time_of_angle(target, from, to)
                && t > step.start.t
            {
                found.push((t, Crossing::Angle(index)));
            }
            turn += 1.0;
        }
    }
}

/// Largest speed in `direction` (+1 or −1) inside a step: at an end, or where the acceleration vanishes.
pub fn speed_extreme(step: &Step, direction: f64) -> f64 {
    let ends = (direction * step.start.omega).max(direction * step.end.omega);
    if direction * step.start.alpha <= 0.0 || direction * step.end.alpha >= 0.0 {
        return direction * ends;
    }
    let speed = |s: f64| direction * step.at(step.start.t + s * step.length()).1;
    let (mut a, mut b) = (0.0, 1.0);
    for _ in 0..30 {
        let (c, d) = (
            b - 0.618_033_988_75 * (b - a),
            a + 0.618_033_988_75 * (b - a),
        );
        if speed(c) > speed(d) { b = d } else { a = c }
    }
    direction * ends.max(speed(0.5 * (a + b)))
}
