//! Noise of the measured values, from the values alone.

use super::super::rounding::of_step;
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
    let of = |count: usize| by(count, times, values);
    let list = NEIGHBOURS.into_iter().filter_map(of);
    list.reduce(f64::min).unwrap_or(0.0)
}

fn by(count: usize, times: &[f64], values: &[f64]) -> Option<f64> {
    let around = count / 2;
    let inner = values.len().checked_sub(count).filter(|inner| *inner > 0)?;
    let every = (inner / ENOUGH).max(1);
    let mut rest = parallel::list(inner.div_ceil(every), |i| {
        let at = around + i * every;
        let others = || (at - around..=at + around).filter(move |j| *j != at);
        let (mut sum, mut spread) = (values[at], 1.0);
        for j in others() {
            let weights = others().filter(|k| *k != j);
            let weight: f64 = weights
                .map(|k| (times[at] - times[k]) / (times[j] - times[k]))
                .product();
            sum -= weight * values[j];
            spread += weight * weight;
        }
        sum.abs() / spread.sqrt()
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
