//! Samples that an instrument or a file rounds to steps.
//!
//! Errors of rounding are noise only where motion or noise spread the samples over many steps. Elsewhere they depend on each
//! other: near a standstill they are alike, on a slow even motion they cancel. Over all places of the steps, the errors of
//! two values at a distance d have the covariance Σ q²/(2π²k²) cos(2πkd/q), k = 1, 2, ..., for steps q; noise of variance
//! σ² damps each term by exp(−(2πkσ/q)²) (Widrow and Kollár, Quantization Noise, Cambridge University Press 2008, ch. 5
//! and 9).

use std::f64::consts::{PI, TAU};

/// How the samples are rounded, as far as it is not noise.
#[derive(Clone, Debug)]
pub(super) struct Rounding {
    step: f64,
    /// Variances of the terms of the covariance.
    terms: Vec<f64>,
}

/// Terms that are followed; of so many samples, fewer. What is left is noise.
const TERMS: usize = 6;
const MANY: usize = 100_000;
const FEWER: usize = 3;

/// Part of the variance of a sample below which rounding is noise.
const SLIGHT: f64 = 0.01;

/// Steps are this many times as large as what they are known to.
const PLAIN: f64 = 32.0;

impl Rounding {
    /// The rounding of so many values to steps, if it is not noise: a fit of so many parameters leaves them with this
    /// standard deviation.
    pub fn of(step: f64, values: usize, left: f64, parameters: f64) -> Option<Rounding> {
        // On an even motion exact values have a common step as well.
        if step <= 0.0 || left < 0.5 * of_step(step) {
            return None;
        }
        let noise = (left * left - of_step(step).powi(2)).max(0.0);
        // The places of the values in the steps are known as the fit is, which follows rounding as well.
        let noise = noise + of_step(step).powi(2) * parameters / values as f64;
        let most = if values > MANY { FEWER } else { TERMS };
        let term = |k: usize| {
            let k = k as f64;
            0.5 * (step / (PI * k)).powi(2) * (-noise * (TAU * k / step).powi(2)).exp()
        };
        let terms: Vec<f64> = (1..=most).map(term).collect();
        (terms[0] > SLIGHT * left * left).then_some(Rounding { step, terms })
    }

    /// Standard deviation of what is noise, for samples with this one. Residuals may have less than what rounding adds,
    /// as a fit follows errors that depend on each other.
    pub fn noise(&self, sigma: f64) -> f64 {
        let terms: f64 = self.terms.iter().sum();
        (sigma.max(of_step(self.step)).powi(2) - terms)
            .max(0.0)
            .sqrt()
    }

    /// Independent errors whose products have the covariance of the terms, for the values before rounding, each with the
    /// sign with which it counts.
    pub fn errors(&self, exact: &[(f64, f64)]) -> Vec<Vec<f64>> {
        let mut errors = Vec::with_capacity(2 * self.terms.len());
        for (k, variance) in self.terms.iter().enumerate() {
            let size = variance.sqrt();
            let rate = TAU * (k + 1) as f64 / self.step;
            let waves = exact.iter().map(|(value, sign)| {
                let (sin, cos) = (rate * value).sin_cos();
                (sign * size * cos, sign * size * sin)
            });
            let (cos, sin) = waves.unzip();
            errors.extend([cos, sin]);
        }
        errors
    }
}

/// Standard deviation of the errors of rounding to steps.
pub(super) fn of_step(step: f64) -> f64 {
    step / 12f64.sqrt()
}

/// The largest step of which all differences of neighbouring values are multiples, if it is plainly larger than what the
/// values are known to: Euclid's algorithm.
pub(super) fn common_step(values: &[f64], digits: f64) -> Option<f64> {
    let largest = values.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    let known = digits + 4.0 * f64::EPSILON * largest;
    let (mut step, mut error) = (0.0, known);
    for pair in values.windows(2) {
        let difference = (pair[1] - pair[0]).abs();
        if difference <= known {
            continue;
        }
        if step == 0.0 {
            step = difference;
            continue;
        }
        let (large, small) = if difference < step {
            ((step, error), (difference, known))
        } else {
            ((difference, known), (step, error))
        };
        let times = (large.0 / small.0).round();
        let rest = (large.0 - times * small.0).abs();
        let uncertain = large.1 + times * small.1;
        (step, error) = if rest > uncertain {
            (rest, uncertain)
        } else if uncertain < 0.5 * small.0 && large.1 < times * small.1 {
            (large.0 / times, large.1 / times)
        } else {
            small
        };
        if step < PLAIN * error {
            return None;
        }
    }
    (step > 0.0).then_some(step)
}
