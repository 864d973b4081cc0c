//! Noise of samples from their differences: of high enough order they leave nothing of a smooth motion.

use super::Samples;
use crate::numeric::median::median;

/// Orders of the differences.
const ORDERS: std::ops::RangeInclusive<usize> = 4..=24;

/// Most windows of samples that are looked at for each order.
const WINDOWS: usize = 2000;

/// Fewest windows that tell the noise.
const FEWEST: usize = 16;

/// The median of the size of a normal number of unit variance.
const MEDIAN: f64 = 0.674_489_750_196_082;

/// Standard deviation of the noise of targets, or more where the samples are too far apart for their motion; none for
/// too few samples.
pub(super) fn noise(samples: &Samples<'_>) -> Option<f64> {
    let weight = |i: &usize| samples.weight.map_or(1.0, |weight| weight[*i]);
    let all: Vec<[f64; 3]> = (0..samples.t.len())
        .filter(|i| weight(i) != 0.0)
        .map(|i| [samples.t[i], weight(&i), samples.target[i] / weight(&i)])
        .collect();
    let of_order = |order: usize| {
        let windows = (all.len() + 1).saturating_sub(order + 1);
        if windows < FEWEST {
            return None;
        }
        let stride = windows.div_ceil(WINDOWS);
        let windows = all.windows(order + 1).step_by(stride);
        Some(median(windows.map(difference))? / MEDIAN)
    };
    ORDERS.step_by(2).filter_map(of_order).reduce(f64::min)
}

/// The divided difference of samples (argument, weight, value) over its standard deviation for targets of unit variance.
fn difference(samples: &[[f64; 3]]) -> f64 {
    let [first, .., last] = samples else {
        return 0.0;
    };
    // Values about one of them lose no digits.
    let about = samples[samples.len() / 2][2];
    let per = samples.len() as f64 / (last[0] - first[0]);
    let (mut sum, mut squares) = (0.0, 0.0);
    for (i, [t, weight, value]) in samples.iter().enumerate() {
        let others = samples.iter().enumerate().filter(|(j, _)| *j != i);
        let product: f64 = others.map(|(_, other)| per * (t - other[0])).product();
        sum += (value - about) / product;
        squares += (weight * product).powi(-2);
    }
    (sum / squares.sqrt()).abs()
}
