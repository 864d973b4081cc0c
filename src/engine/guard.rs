//! Changes of sign of watched quantities inside steps.

use super::Motion;
use super::step::Step;
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// A step is looked at in this many pieces: two changes in one piece go unseen.
const PIECES: usize = 8;

/// The quantities whose signs are watched, at time t (s), angle and speed.
pub trait Watched<const N: usize> {
    /// Their values.
    fn values(&self, t: f64, angle: Angle, speed: f64) -> [f64; N];
}

/// A quantity that left the sign it had.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// s
    pub t: f64,
    /// Which of the quantities.
    pub index: usize,
}

/// All changes inside a step in the order of time. `signs` are the signs that the quantities have at its start,
/// which rounding may hide there, and after the call those at its end. A step in which something changes is
/// refined.
pub fn changes<const N: usize>(
    step: &mut Step,
    motion: &dyn Motion,
    watched: &dyn Watched<N>,
    signs: &mut [f64; N],
) -> Vec<Change> {
    let end = watched.values(step.end.t, step.angle(step.end.theta), step.end.omega);
    let start = watched.values(step.start.t, step.angle(step.start.theta), step.start.omega);
    let rough = sampled(step, watched, &start, &end);
    let left = |i: usize| rough.iter().skip(1).any(|v| v[i] * signs[i] < 0.0);
    if !(0..N).any(left) {
        return Vec::new();
    }
    step.refine(motion);
    let fine = sampled(step, watched, &start, &end);
    let mut found = Vec::new();
    for index in 0..N {
        for piece in 0..PIECES {
            let left = fine[piece + 1][index] * signs[index] < 0.0;
            if !left {
                continue;
            }
            let (from, to) = (time(step, piece), time(step, piece + 1));
            let value = |t: f64| {
                let (theta, omega) = step.at(t);
                watched.values(t, step.angle(theta), omega)[index]
            };
            // Without its sign at the start of the piece it has not shown it since the last change.
            let seen = fine[piece][index] * signs[index] > 0.0;
            let t = seen.then(|| root::bracketed(value, from, to)).flatten();
            found.push(Change {
                t: t.unwrap_or(to),
                index,
            });
            signs[index] = -signs[index];
        }
    }
    found.sort_by(|a, b| a.t.total_cmp(&b.t));
    found
}

fn time(step: &Step, piece: usize) -> f64 {
    if piece == PIECES {
        step.end.t
    } else {
        step.start.t + step.length() * piece as f64 / PIECES as f64
    }
}

fn sampled<const N: usize>(
    step: &Step,
    watched: &dyn Watched<N>,
    start: &[f64; N],
    end: &[f64; N],
) -> [[f64; N]; PIECES + 1] {
    std::array::from_fn(|i| match i {
        0 => *start,
        PIECES => *end,
        _ => {
            let t = time(step, i);
            let (theta, omega) = step.at(t);
            watched.values(t, step.angle(theta), omega)
        }
    })
}
