//! Samples that are far off: noise as a mixture of two normal distributions, of which the wider one has few samples (variance
//! inflation; Box and Tiao, Biometrika 55 (1968) 119). Each sample counts by the probability that it belongs to the narrow one.

use super::problem::Problem;
use super::smoother::Smoothed;
use crate::numeric::median::median;

/// Standard deviations beyond which a sample is looked at: one in 10⁸ of noise.
const FAR: f64 = 5.7;

/// Standard deviation of normal noise over the median of its sizes.
const NORMAL: f64 = 1.4826;

/// Weight below which a sample does not count.
const LEAST: f64 = 1e-6;

/// Weights of the samples by a smoothed motion; none where there are no outliers and never were.
pub(super) fn weights(problem: &Problem<'_>, smoothed: &Smoothed) -> Option<Vec<f64>> {
    let record = &problem.record;
    let sigma = smoothed.noise.sigma;
    let standardised: Vec<f64> = (0..record.times.len())
        .map(|i| {
            let estimate = &smoothed.estimates[problem.node_of(i)];
            let (residual, shown) = record.sensor.residual(record.values[i], estimate.state[0]);
            // Of a sample that counts, part of its error is in the path.
            let leverage = record.weights[i] * shown.slope * shown.slope * estimate.covariance[0]
                / (sigma * sigma);
            residual / (sigma * (1.0 - leverage).max(0.1).sqrt())
        })
        .collect();
    let scale = NORMAL * median(standardised.iter().map(|r| r.abs()))?;
    let scale = scale.max(record.floor / sigma);
    let far = || standardised.iter().filter(|r| r.abs() > FAR * scale);
    let count = far().count() as f64;
    if count == 0.0 {
        let weighted = record.weights.iter().any(|w| *w < 1.0);
        return weighted.then(|| record.weights.clone());
    }
    let part = count / standardised.len() as f64;
    let wide = far().map(|r| r * r).sum::<f64>() / count / (scale * scale);
    let weight = |r: &f64| {
        let square = (r / scale).powi(2);
        let odds = part / (1.0 - part) / wide.sqrt() * (0.5 * square * (1.0 - 1.0 / wide)).exp();
        let weight = 1.0 / (1.0 + odds);
        if weight < LEAST { 0.0 } else { weight }
    };
    Some(standardised.iter().map(weight).collect())
}

/// Whether two lists of weights leave the same samples out.
pub(super) fn alike(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.1)
}
