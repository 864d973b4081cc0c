//! Noise of the measured values, from the values alone.

use super::super::rounding::of_step;
use super::track::Track;
use super::visit::Motion;
use crate::mechanism::Linkage;
use crate::numeric::chebyshev::largest;
use crate::numeric::median::median;
use crate::numeric::parallel;

/// Numbers of neighbours that are tried: a smooth motion adds the less the more there are, if samples are dense.
const NEIGHBOURS: [usize; 5] = [4, 6, 8, 12, 16];

/// Samples that are enough to know the noise by.
const ENOUGH: usize = 20_000;

/// One in so many samples is to tell the noise.
const FEWEST: usize = 20;

/// Part of the samples that are equal to the one before, from which on values are taken as rounded.
const EQUAL: f64 = 0.1;

/// Samples from one turning point to the next, on average, from which on the values tell the noise.
const DENSE: usize = 16;

/// Turning points from which on it is worth while to look closer, and part of what the values tell that is far less.
const VERY_MANY: usize = 1000;
const FAR_LESS: f64 = 0.25;

/// Lever arm x' of a slider position over the crank length below which its crank angle is not told by a line.
const SHORT: f64 = 0.1;

/// Standard deviation of the noise, from the differences between samples and the polynomials through their
/// neighbours, to which a smooth motion hardly adds.
pub(super) fn noise(times: &[f64], values: &[f64]) -> f64 {
    least(times, values, |_| 1.0).unwrap_or(0.0)
}

/// The same of crank-pin angles γ, rad, that bend at every fold: the distance from the crank pivot to the wrist pin,
/// d² = r² + l² − 2 r l cos γ, is smooth there, and d d' = r l sin γ.
pub(super) fn noise_of_gamma(linkage: &Linkage, times: &[f64], sizes: &[f64]) -> f64 {
    let Linkage { r, l, .. } = *linkage;
    let distances = parallel::list(sizes.len(), |i| {
        let across = 2.0 * (0.5 * sizes[i]).sin();
        ((l - r).powi(2) + r * l * across * across).sqrt()
    });
    let slope = |i: usize| r * l * sizes[i].sin() / distances[i].max(f64::MIN_POSITIVE);
    let noise = noise(times, sizes);
    least(times, &distances, slope).map_or(noise, |least| least.min(noise))
}

/// The noise of slider positions of an uneven motion with few samples a turn, if that is far less: its crank angle is smoother, where
/// it passes the folds. What a motion does that goes back there counts as noise.
pub(super) fn noise_of_x(motion: &Motion<'_>) -> f64 {
    let Motion {
        record,
        strokes,
        turnings,
    } = motion;
    if turnings.len() < VERY_MANY || record.values.len() >= DENSE * turnings.len() {
        return record.noise;
    }
    let passed = vec![true; turnings.len()];
    let theta = Track::new(motion, &passed, strokes.all()[0]).theta;
    let slopes = parallel::list(theta.len(), |i| {
        let (_, arm) = strokes.sensor.shown(theta[i]);
        match arm.abs() {
            arm if arm > SHORT * strokes.sensor.size() => 1.0 / arm,
            _ => f64::INFINITY,
        }
    });
    let least = least(record.times, &theta, |i| slopes[i]);
    let far_less = least.filter(|least| *least < FAR_LESS * record.noise);
    far_less.unwrap_or(record.noise)
}

/// The least noise that any number of neighbours tells, of what has its values with these slopes.
fn least(times: &[f64], values: &[f64], slope: impl Fn(usize) -> f64 + Sync) -> Option<f64> {
    let of = |count: usize| by(count, times, values, &slope);
    let list = NEIGHBOURS.into_iter().filter_map(of);
    list.reduce(f64::min)
}

fn by(
    count: usize,
    times: &[f64],
    values: &[f64],
    slope: &(impl Fn(usize) -> f64 + Sync),
) -> Option<f64> {
    let around = count / 2;
    let inner = values.len().checked_sub(count).filter(|inner| *inner > 0)?;
    let every = (inner / ENOUGH).max(1);
    let rest = parallel::list(inner.div_ceil(every), |i| {
        let at = around + i * every;
        let others = || (at - around..=at + around).filter(move |j| *j != at);
        let (mut sum, mut spread) = (values[at], slope(at).powi(2));
        for j in others() {
            let weights = others().filter(|k| *k != j);
            let weight: f64 = weights
                .map(|k| (times[at] - times[k]) / (times[j] - times[k]))
                .product();
            sum -= weight * values[j];
            spread += (weight * slope(j)).powi(2);
        }
        // Nothing is told by what is all at a fold of a distance, or some of it at one of an angle.
        (spread < f64::INFINITY).then_some(sum.abs() / spread.sqrt().max(f64::MIN_POSITIVE))
    });
    let rest: Vec<f64> = rest.into_iter().flatten().collect();
    let is_told = FEWEST * rest.len() > inner.div_ceil(every);
    median(rest)
        .filter(|_| is_told)
        .map(|median| 1.4826 * median)
}

/// Standard deviation of what rounding does to values, if so many are equal that they were rounded. It is not noise:
/// while the value hardly changes, many are wrong alike.
pub(super) fn rounding(values: &[f64]) -> f64 {
    let steps = || values.windows(2).map(|w| (w[1] - w[0]).abs());
    let equal = steps().filter(|step| *step == 0.0).count();
    if (equal as f64) < EQUAL * values.len() as f64 {
        return 0.0;
    }
    let size = largest(values);
    let seen = steps().filter(|step| *step > 8.0 * f64::EPSILON * size);
    seen.reduce(f64::min).map_or(0.0, of_step)
}
