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

/// When a step's speed may vanish inside although both ends have the same sign, and where it is extreme:
/// the step cut into pieces on which the speed is monotone (to the eighth of a step).
const PIECES: usize = 8;

/// All crossings inside a step, in the order of time, as (time, what). `watched` are angles in [0, 2π).
pub fn crossings(step: &Step, watched: &[f64], found: &mut Vec<(f64, Crossing)>) {
    found.clear();
    let mut cuts = [step.start.t, step.end.t, step.end.t, step.end.t];
    let mut count = 1;
    for (from, to) in turning_brackets(step) {
        if let Some(t) = step.time_of_rest(from, to)
            && count < 3
            && t > step.start.t
        {
            found.push((t, Crossing::Turning));
            cuts[count] = t;
            count += 1;
        }
    }
    cuts[count] = step.end.t;
    for w in cuts[..=count].windows(2) {
        passages(step, watched, w[0], w[1], found);
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
}

/// Intervals in which the speed changes sign; none for the usual step whose speed stays clear of zero.
fn turning_brackets(step: &Step) -> impl Iterator<Item = (f64, f64)> {
    let (w0, w1) = (step.start.omega, step.end.omega);
    let change = step.length() * step.start.alpha.abs().max(step.end.alpha.abs());
    let clear = w0 * w1 > 0.0 && w0.abs().min(w1.abs()) > 2.0 * change;
    let step = *step;
    let time = move |i: usize| {
        if i == PIECES {
            step.end.t
        } else {
            step.start.t + step.length() * i as f64 / PIECES as f64
        }
    };
    let pieces = if clear { 0 } else { PIECES };
    (0..pieces).filter_map(move |i| {
        let (from, to) = (time(i), time(i + 1));
        let (a, b) = (step.at(from).1, step.at(to).1);
        (a * b < 0.0 || (b == 0.0 && a != 0.0)).then_some((from, to))
    })
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
