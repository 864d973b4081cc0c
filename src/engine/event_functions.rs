//! Sign changes of event functions inside an accepted step, located by sampling, parabolas and Brent's root finder.

use super::step::Step;
use super::{Motion, PIECES};
use crate::numeric::angle::Angle;
use crate::numeric::exact::SUM_ROUNDING;
use crate::numeric::{dip, maximum, root};

/// Event functions of time t (s), angle and speed (rad/s), whose sign changes are located.
pub trait EventFunction<const N: usize> {
    /// Returns the N values.
    fn values(&self, t: f64, angle: Angle, speed: f64) -> [f64; N];

    /// Returns the travel (rad) after an angle at which the next sample shows a double sign change of the values.
    fn shown_travel(&self, angle: Angle) -> f64;
}

/// Sign change of one event function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Time, s.
    pub t: f64,
    /// Index of the event function.
    pub index: usize,
}

/// Returns all sign changes inside a step in time order. `signs` holds the signs at the start of the step, where
/// rounding may hide them, and on return those at its end. `follows`: the step continues another; a different sign at
/// its start is then a jump of a load. A step with a sign change is refined.
pub fn changes<const N: usize>(
    step: &mut Step,
    motion: &dyn Motion,
    watched: &dyn EventFunction<N>,
    follows: bool,
    signs: &mut [f64; N],
) -> Vec<Change> {
    let times = sample_times(step, watched);
    let rough = sampled(step, watched, &times);
    let left = |i: usize| {
        let mut inside = rough[1..].iter();
        follows && has_jumped(&rough, i, signs[i])
            || inside.any(|sample| sample.values[i] * signs[i] < 0.0)
    };
    let dips = |i: usize| rough.windows(3).any(|w| may_dip(w, i));
    if !(0..N).any(|i| left(i) || dips(i)) {
        return Vec::new();
    }
    step.refine(motion);
    let step = &*step;
    let fine = sampled(step, watched, &times);
    let mut found = Vec::new();
    for (index, sign) in signs.iter_mut().enumerate() {
        let value = |t: f64| values_at(step, watched, t).values[index];
        if follows && has_jumped(&fine, index, *sign) {
            // Just after the start of the step: the run has to advance.
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

/// True if the function has the opposite sign at the start of the step by more than rounding.
fn has_jumped<const N: usize>(samples: &[EventValues<N>], index: usize, sign: f64) -> bool {
    let values = samples.iter().map(|sample| sample.values[index].abs());
    let largest = values.fold(0.0, f64::max);
    samples[0].values[index] * sign < -SUM_ROUNDING * largest
}

/// Returns times and values of one function: the samples and the minima of its dips between them.
fn with_dips<const N: usize>(
    samples: &[EventValues<N>],
    index: usize,
    value: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let mut all: Vec<_> = samples
        .iter()
        .map(|sample| (sample.t, sample.values[index]))
        .collect();
    let largest = all.iter().fold(0.0f64, |m, (_, value)| m.max(value.abs()));
    for three in samples.windows(3).filter(|three| may_dip(three, index)) {
        let sign = three[1].values[index].signum();
        let (t, beyond) = maximum::largest(|t| -sign * value(t), three[0].t, three[2].t);
        if beyond > SUM_ROUNDING * largest {
            all.push((t, -sign * beyond));
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// True if a function of one sign at three times may have the other sign between them.
fn may_dip<const N: usize>(three: &[EventValues<N>], index: usize) -> bool {
    let values = [0, 1, 2].map(|i| three[i].values[index] * three[1].values[index].signum());
    values.iter().all(|value| *value >= 0.0) && dip::may_dip([0, 1, 2].map(|i| three[i].t), values)
}

/// Returns the time at which a value becomes negative that is negative at `to` and not positive at `from`, where
/// rounding may hide its sign. If no sample is positive, this is `from`, or just after `from` at the start of a step:
/// the run has to advance.
fn left_early(value: impl Fn(f64) -> f64, from: f64, to: f64, inside: bool) -> f64 {
    let mut after = to;
    // Half the digits of the piece: next to an extreme the value changes with the square of the time.
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

/// Values of the event functions at a time, s.
struct EventValues<const N: usize> {
    t: f64,
    values: [f64; N],
}

fn values_at<const N: usize>(
    step: &Step,
    watched: &dyn EventFunction<N>,
    t: f64,
) -> EventValues<N> {
    let (theta, omega) = step.at(t);
    EventValues {
        t,
        values: watched.values(t, step.angle(theta), omega),
    }
}

/// Returns the times, s, of the samples in a step: the parabolas between them detect double sign changes.
fn sample_times<const N: usize>(step: &Step, watched: &dyn EventFunction<N>) -> Vec<f64> {
    // Crank travel between two samples, rad.
    let longest = 0.1;
    let pieces = PIECES.max((step.travel() / longest).ceil() as usize);
    // Steps end at jumps of loads, and the samples show the values inside: not nearer to an end than this fraction.
    let nearest = 1e-9;
    let part = |i: usize| (i as f64 / pieces as f64).clamp(nearest, 1.0 - nearest);
    let mut times: Vec<f64> = Vec::with_capacity(pieces + 1);
    for until in (0..=pieces).map(|i| step.start.t + step.length() * part(i)) {
        while let Some(&last) = times.last() {
            let (theta, omega) = step.at(last);
            let next = last + watched.shown_travel(step.angle(theta)) / omega.abs();
            if next <= last || next >= until {
                break;
            }
            times.push(next);
        }
        times.push(until);
    }
    times
}

fn sampled<const N: usize>(
    step: &Step,
    watched: &dyn EventFunction<N>,
    times: &[f64],
) -> Vec<EventValues<N>> {
    times.iter().map(|t| values_at(step, watched, *t)).collect()
}
