//! Samples that an instrument or a file rounds to steps.
//!
//! Errors of rounding are noise only where motion or noise spread the samples over many steps. Elsewhere they depend on each
//! other: near a standstill they are alike, on a slow even motion they cancel. Over all places of the steps, the errors of
//! two values at a distance d have the covariance Σ q²/(2π²k²) cos(2πkd/q), k = 1, 2, ..., for steps q; noise of variance
//! σ² damps each term by exp(−(2πkσ/q)²) (Widrow and Kollár, Quantization Noise, Cambridge University Press 2008, ch. 5
//! and 9).

use std::f64::consts::{PI, TAU};

use crate::numeric::chebyshev::largest;
use crate::numeric::parallel;

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

/// Part of a step to which a difference is to be known to tell something about it.
const TELLING: f64 = 0.25;

/// Fewest differences that are to agree.
const ENOUGH: usize = 12;

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

    /// How many places of the steps stand for all of them: as many as tell the terms from each other.
    pub fn places(&self) -> usize {
        2 * self.terms.len() + 1
    }

    /// What rounding adds to values, each with the sign with which it counts, at one of the places of the steps.
    pub fn error(&self, place: usize, exact: &[(f64, f64)]) -> Vec<f64> {
        let sizes: Vec<f64> = self.terms.iter().map(|v| (2.0 * v).sqrt()).collect();
        let moved = place as f64 / self.places() as f64;
        parallel::list(exact.len(), |i| {
            let (value, sign) = exact[i];
            let (sin, cos) = (TAU * (value / self.step + moved)).sin_cos();
            // Clenshaw's sum of sines.
            let (mut sum, mut after) = (0.0, 0.0);
            for size in sizes.iter().rev() {
                (sum, after) = (size + 2.0 * cos * sum - after, sum);
            }
            sign * sin * sum
        })
    }
}

/// Standard deviation of the errors of rounding to steps.
pub(super) fn of_step(step: f64) -> f64 {
    step / 12f64.sqrt()
}

/// The largest step of which all differences of neighbouring values are multiples, if it is plainly larger than what the
/// values are known to: that of the values as they stand, or else of values that were rounded once more to these digits.
pub(super) fn common_step(values: &[f64], digits: f64) -> Option<f64> {
    let rounding = 4.0 * f64::EPSILON * largest(values);
    [rounding, digits + rounding]
        .into_iter()
        .filter_map(|known| step_of(values, known))
        // Steps of the digits themselves say nothing new.
        .find(|step| *step > 1.5 * digits)
}

/// The same for values that are known to so much: Euclid's algorithm.
fn step_of(values: &[f64], known: f64) -> Option<f64> {
    let (mut step, mut error) = (0.0, known);
    // Differences so long that any is a multiple say nothing.
    let (mut telling, mut silent) = (0, 0);
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
        if uncertain < TELLING * small.0 {
            telling += 1;
        } else {
            silent += 1;
        }
        (step, error) = if rest > uncertain {
            (telling, silent) = (0, 0);
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
    (telling >= silent.max(ENOUGH)).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(rounded: impl Fn(f64) -> f64) -> Vec<f64> {
        let one = |i: u32| {
            let t = 1e-3 * f64::from(i);
            rounded(3.0 * t + 0.1 * (2.0 * t).sin())
        };
        (0..2000).map(one).collect()
    }

    #[test]
    fn steps_are_found_whatever_the_digits() {
        let to = |step: f64| move |value: f64| (value / step).round() * step;
        // Steps of a few units of the last digit, and steps that were printed to digits once more.
        for (step, digits) in [(3e-4, 1e-4), (5e-3, 1e-3), (1e-3, 1e-8)] {
            let values = motion(|value| to(digits)(to(step)(value)));
            let found = common_step(&values, digits).expect("a step");
            assert!((found / step - 1.0).abs() < 1e-6, "{step}: {found}");
        }
        let step = std::f64::consts::TAU / 4096.0;
        let values = motion(|value| to(1e-6)(to(step)(value)));
        let found = common_step(&values, 1e-6).expect("a step");
        assert!((found / step - 1.0).abs() < 1e-2, "{found}");
        // The digits themselves are known.
        assert_eq!(common_step(&motion(to(1e-4)), 1e-4), None);
    }

    #[test]
    fn a_motion_without_rounding_has_no_step() {
        let turned = |i: f64| 0.3 + 1e-6 * i + 0.05 * (1.0 + 6e-6 * i).sin();
        let fine = |i: u32| turned(f64::from(i));
        let values: Vec<f64> = (0..100_000).map(fine).collect();
        for digits in [0.0, 1e-17, 1e-22] {
            assert_eq!(common_step(&values, digits), None);
        }
    }
}
