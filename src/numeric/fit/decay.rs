//! How the terms of a series fall off, and what those that are left out may amount to.
//!
//! Coefficients over orthonormal terms of an analytic function fall about geometrically. As measured, each is a normal
//! number of variance τ² + noise, with ln τ² = level − fall·k for term k; levels and falls are weighed by their
//! likelihood, as is that there are no terms after the last supported one. They tell how many terms leave out little, and
//! how much.

use std::ops::Range;

use crate::numeric::real::Real;

/// Variances of the coefficients of a series, as a mixture of geometric series.
#[derive(Clone, Debug)]
pub(super) struct Decay {
    noise: f64,
    /// Weight, level and fall of each.
    mixture: Vec<[f64; 3]>,
}

/// Terms left out may add this part to the variance of the second derivative.
const SLIGHT: f64 = 0.01;

/// Terms after which a tail is not followed.
const FAR: usize = 40;

/// Terms before the last supported one from which the decay is read.
const BACK: usize = 4;

/// How much likelier, as a logarithm, it must be that a series ends than that it falls off on: measured motions hardly
/// are polynomials.
const ENDS: f64 = 20.0;

/// Power of the likelihood by which levels and falls are weighed: sizes of terms beside each other are not independent, and
/// tell less than as many that are.
const WEIGHT: f64 = 0.6;

/// Logarithm of the part of the largest weight below which a series is left out.
const NEGLIGIBLE: f64 = 12.0;

/// Falls that are weighed, from a quarter of the mean one to e^8 for each term.
const FALLS: i32 = 12;

impl Decay {
    /// The decay of terms from their squares: those of term k are the sum of `each` squared coefficients. Terms far before
    /// the last that the samples support (`supported`) say little about those that come after it.
    pub fn of(squares: &[f64], each: f64, noise: f64, supported: usize) -> Decay {
        let noise = noise.max(f64::MIN_POSITIVE);
        let from = supported.saturating_sub(BACK).max(1).min(squares.len() - 1);
        let window: Vec<(f64, f64)> = (from..squares.len())
            .map(|k| (k as f64, squares[k] / noise / each))
            .collect();
        let largest = |list: &[f64]| list.iter().fold(1.0f64, |m, s| m.max(*s));
        let all = largest(squares) / noise;
        let top = largest(&window.iter().map(|w| w.1).collect::<Vec<f64>>());
        let slowest = (0.25 * all.ln() / supported.max(1) as f64).clamp(0.1, 4.0);
        let ratio = (8.0 / slowest).powf(1.0 / f64::from(FALLS - 1));
        let mut mixture = Vec::new();
        for i in 0..FALLS {
            let fall = slowest * ratio.powi(i);
            let steps = (top.ln() + 10.0).ceil() as usize;
            for j in 0..steps {
                let level = j as f64 - 4.0;
                let one = |(k, square): &(f64, f64)| {
                    let variance = 1.0 + (level - fall * (k - from as f64)).exp();
                    variance.ln() + square / variance
                };
                let cost = 0.5 * each * window.iter().map(one).sum::<f64>();
                mixture.push([cost, level + fall * from as f64, fall]);
            }
        }
        let ends = |(k, square): &(f64, f64)| {
            if *k <= supported as f64 {
                square.max(1.0).ln() + 1.0
            } else {
                *square
            }
        };
        let cost = 0.5 * each * window.iter().map(ends).sum::<f64>() + ENDS;
        mixture.push([cost, f64::NEG_INFINITY, 0.0]);
        let least = mixture.iter().fold(f64::INFINITY, |m, part| m.min(part[0]));
        mixture.retain(|part| WEIGHT * (part[0] - least) < NEGLIGIBLE);
        let weight = |cost: f64| (WEIGHT * (least - cost)).exp();
        let sum: f64 = mixture.iter().map(|part| weight(part[0])).sum();
        for part in &mut mixture {
            part[0] = weight(part[0]) / sum;
        }
        Decay { noise, mixture }
    }

    /// The same of an expansion, from the sums of squared residuals with one term, two terms, ...; `least` is what is left
    /// of noise at least.
    pub fn of_sums<T: Real>(rows: usize, sums: &[T], supported: usize, least: f64) -> Decay {
        let last = sums[sums.len() - 1].value();
        let free = rows.saturating_sub(sums.len()).max(1) as f64;
        let noise = (last / free).max(least / rows as f64);
        // The constant term tells nothing.
        let mut terms = vec![0.0];
        let steps = sums.windows(2).map(|pair| (pair[0] - pair[1]).value());
        terms.extend(steps.map(|step| step.max(0.0)));
        Decay::of(&terms, 1.0, noise, supported.max(1))
    }

    /// Variance that noise gives a coefficient.
    pub fn noise(&self) -> f64 {
        self.noise
    }

    /// Variance of a coefficient of term k.
    pub fn variance(&self, k: usize) -> f64 {
        let one = |[weight, level, fall]: &[f64; 3]| weight * (level - fall * k as f64).exp();
        self.noise * self.mixture.iter().map(one).sum::<f64>()
    }

    /// Variances of the coefficients of a few terms that stand for all from the first of them on: together they add as much
    /// to the second derivative, to which term k adds in proportion to k^`power`.
    pub fn beyond(&self, terms: Range<usize>, power: i32) -> Vec<f64> {
        let added = |k: usize| self.variance(k) * (k as f64).powi(power);
        let all: f64 = (terms.start..terms.start + FAR).map(added).sum();
        let few: f64 = terms.clone().map(added).sum();
        let more = if few > 0.0 { all / few } else { 1.0 };
        terms.map(|k| more * self.variance(k)).collect()
    }

    /// The first number of terms, from `supported` to `most`, that leaves out little of the second derivative, to which
    /// term k adds in proportion to k^`power`; none if all of them leave out more.
    pub fn enough(&self, supported: usize, most: usize, power: i32) -> Option<usize> {
        let size = |k: usize| (k as f64).powi(power);
        let mut known: f64 = (1..=supported).map(|k| self.noise * size(k)).sum();
        let variances: Vec<f64> = (supported..most.max(supported) + FAR + 1)
            .map(|k| self.variance(k))
            .collect();
        for last in supported..=most {
            let left: f64 = variances[last - supported + 1..][..FAR]
                .iter()
                .zip(last + 1..)
                .map(|(variance, k)| variance * size(k))
                .sum();
            if left <= SLIGHT * known {
                return Some(last);
            }
            known += self.noise * size(last + 1);
        }
        None
    }
}
