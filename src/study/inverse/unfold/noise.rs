//! Noise of the measured values, from the values alone.

use super::super::rounding::of_step;
use crate::mechanism::Linkage;
use crate::numeric::chebyshev::largest;
use crate::numeric::parallel;

/// Numbers of neighbours that are tried: a smooth motion adds the less the more there are, if samples are dense.
const NEIGHBOURS: [usize; 5] = [4, 6, 8, 12, 16];

/// Samples that are enough to know the noise by.
const ENOUGH: usize = 20_000;

/// Part of the samples that are equal to the one before, from which on values are taken as rounded.
const EQUAL: f64 = 0.1;

/// Standard deviation of the noise, from the differences between samples and the polynomials through their
/// neighbours, to which a smooth motion hardly adds.
pub(super) fn noise(times: &[f64], values: &[f64]) -> f64 {
    least(times, values, |_| 1.0)
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
    least(times, &distances, slope).min(noise(times, sizes))
}

/// The least noise that any number of neighbours tells, of what has its values with these slopes.
fn least(times: &[f64], values: &[f64], slope: impl Fn(usize) -> f64 + Sync) -> f64 {
    let of = |count: usize| by(count, times, values, &slope);
    let list = NEIGHBOURS.into_iter().filter_map(of);
    list.reduce(f64::min).unwrap_or(0.0)
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
    let mut rest = parallel::list(inner.div_ceil(every), |i| {
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
        // All at a fold, where a distance tells nothing.
        sum.abs() / spread.sqrt().max(f64::MIN_POSITIVE)
    });
    let middle = rest.len() / 2;
    Some(1.4826 * *rest.select_nth_unstable_by(middle, f64::total_cmp).1)
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
