//! Changes of sign of watched quantities inside steps.

use super::step::Step;
use super::{Motion, PIECES};
use crate::numeric::angle::Angle;
use crate::numeric::exact::SUM_ROUNDING;
use crate::numeric::{dip, maximum, root};

/// A step is looked at in pieces of this travel, rad, but at least in [`PIECES`]. Between them parabolas tell where a
/// quantity may leave its sign and come back.
const PIECE_TRAVEL: f64 = 0.1;

/// The quantities whose signs are watched, at time t (s), angle and speed.
pub trait EventFunction<const N: usize> {
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
/// which rounding may hide there, and after the call those at its end. A step that `follows` another begins with the
/// values at the end of that one, unless a load jumps there. A step in which something changes is refined.
pub fn changes<const N: usize>(
    step: &mut Step,
    motion: &dyn Motion,
    watched: &dyn EventFunction<N>,
    follows: bool,
    signs: &mut [f64; N],
) -> Vec<Change> {
    let travel = (step.end.theta - step.start.theta).abs();
    let pieces = PIECES.max((travel / PIECE_TRAVEL).ceil() as usize);
    let rough = sampled(step, watched, pieces);
    let left = |i: usize| {
        let mut inside = rough[1..].iter();
        follows && has_jumped(&rough, i, signs[i])
            || inside.any(|look| look.values[i] * signs[i] < 0.0)
    };
    let dips = |i: usize| rough.windows(3).any(|w| may_dip(w, i));
    if !(0..N).any(|i| left(i) || dips(i)) {
        return Vec::new();
    }
    step.refine(motion);
    let step = &*step;
    let fine = sampled(step, watched, pieces);
    let mut found = Vec::new();
    for (index, sign) in signs.iter_mut().enumerate() {
        let value = |t: f64| look(step, watched, t).values[index];
        if follows && has_jumped(&fine, index, *sign) {
            // Not at the start itself, so that the motion goes on.
            let t = step.start.t * (1.0 + 4.0 * f64::EPSILON);
            found.push(Change { t, index });
            *sign = -*sign;
        }
        for pair in with_dips(&fine, index, value).windows(2) {
            let [(from, before), (to, after)] = [pair[0], pair[1]];
            if after * *sign >= 0.0 {
                continue;
            }
            let leaving = |t: f64| *sign * value(t);
            let t = if before * *sign > 0.0 {
                root::bracketed(leaving, from, to).unwrap_or(to)
            } else {
                left_early(leaving, from, to, from > step.start.t)
            };
            found.push(Change { t, index });
            *sign = -*sign;
        }
    }
    found.sort_by(|a, b| a.t.total_cmp(&b.t));
    found
}

/// Whether a quantity has jumped where the step starts.
fn has_jumped<const N: usize>(looks: &[EventValues<N>], index: usize, sign: f64) -> bool {
    let values = looks.iter().map(|look| look.values[index].abs());
    let largest = values.fold(0.0, f64::max);
    looks[0].values[index] * sign < -SUM_ROUNDING * largest
}

/// Times and values of one quantity, and those of the lowest points of its dips between them.
fn with_dips<const N: usize>(
    looks: &[EventValues<N>],
    index: usize,
    value: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let mut all: Vec<_> = looks
        .iter()
        .map(|look| (look.t, look.values[index]))
        .collect();
    let largest = all.iter().fold(0.0f64, |m, (_, value)| m.max(value.abs()));
    for three in looks.windows(3).filter(|three| may_dip(three, index)) {
        let sign = three[1].values[index].signum();
        let (t, beyond) = maximum::largest(|t| -sign * value(t), three[0].t, three[2].t);
        if beyond > SUM_ROUNDING * largest {
            all.push((t, -sign * beyond));
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// Whether a quantity of one sign may have the other for a while between three times.
fn may_dip<const N: usize>(three: &[EventValues<N>], index: usize) -> bool {
    let values = [0, 1, 2].map(|i| three[i].values[index] * three[1].values[index].signum());
    values.iter().all(|value| *value >= 0.0) && dip::may_dip([0, 1, 2].map(|i| three[i].t), values)
}

/// When a value becomes negative that is not positive at `from`, where rounding may hide what it is, and negative at
/// `to`. If it does not show that it was positive, it left at `from`; next to it where that is the start of a step,
/// so that the motion goes on.
fn left_early(value: impl Fn(f64) -> f64, from: f64, to: f64, inside: bool) -> f64 {
    let mut after = to;
    // Half of the digits of the piece: a quantity is as exact as the square of the time beside an extreme.
    while after - from > f64::EPSILON.sqrt() * (to - from) {
        let t = from + 0.5 * (after - from);
        if t <= from || t >= after {
            break;
        }
        if value(t) > 0.0 {
            return root::bracketed(value, t, after).unwrap_or(after);
        }
        after = t;
    }
    if inside { from } else { after }
}

/// The quantities at a time.
struct EventValues<const N: usize> {
    t: f64,
    values: [f64; N],
}

fn look<const N: usize>(step: &Step, watched: &dyn EventFunction<N>, t: f64) -> EventValues<N> {
    let (theta, omega) = step.at(t);
    EventValues {
        t,
        values: watched.values(t, step.angle(theta), omega),
    }
}

/// Steps end at jumps of loads. The first and the last look are this part of the step beside its ends, so that they show the
/// values inside.
const BESIDE_END: f64 = 1e-9;

fn time(step: &Step, piece: usize, pieces: usize) -> f64 {
    let part = (piece as f64 / pieces as f64).clamp(BESIDE_END, 1.0 - BESIDE_END);
    step.start.t + step.length() * part
}

fn sampled<const N: usize>(
    step: &Step,
    watched: &dyn EventFunction<N>,
    pieces: usize,
) -> Vec<EventValues<N>> {
    (0..=pieces)
        .map(|i| look(step, watched, time(step, i, pieces)))
        .collect()
}
