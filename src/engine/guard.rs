//! Changes of sign of watched quantities inside steps.

use super::Motion;
use super::step::Step;
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// A step is looked at in pieces of this travel, rad, but in at least so many and at most so many: two changes
/// in one piece go unseen.
const TRAVEL: f64 = 0.1;
const FEWEST: f64 = 8.0;
const MOST: f64 = 64.0;

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
    let travel = (step.end.theta - step.start.theta).abs();
    let pieces = (travel / TRAVEL).ceil().clamp(FEWEST, MOST) as usize;
    let rough = sampled(step, watched, &start, &end, pieces);
    let left = |i: usize| rough.iter().skip(1).any(|v| v[i] * signs[i] < 0.0);
    if !(0..N).any(left) {
        return Vec::new();
    }
    step.refine(motion);
    let fine = sampled(step, watched, &start, &end, pieces);
    let mut found = Vec::new();
    for index in 0..N {
        for piece in 0..pieces {
            let left = fine[piece + 1][index] * signs[index] < 0.0;
            if !left {
                continue;
            }
            let (from, to) = (time(step, piece, pieces), time(step, piece + 1, pieces));
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

fn time(step: &Step, piece: usize, pieces: usize) -> f64 {
    if piece == pieces {
        step.end.t
    } else {
        step.start.t + step.length() * piece as f64 / pieces as f64
    }
}

fn sampled<const N: usize>(
    step: &Step,
    watched: &dyn Watched<N>,
    start: &[f64; N],
    end: &[f64; N],
    pieces: usize,
) -> Vec<[f64; N]> {
    let inside = (1..pieces).map(|i| {
        let t = time(step, i, pieces);
        let (theta, omega) = step.at(t);
        watched.values(t, step.angle(theta), omega)
    });
    std::iter::once(*start)
        .chain(inside)
        .chain([*end])
        .collect()
}
