//! Harmonics that stand out of a smooth spectrum, as those of cogging and of meshing teeth do.
//!
//! Such a harmonic has a standard deviation s/kᵖ with an order p of its own, down to the negative of the spectrum's: it may be as far
//! above the first harmonic as the spectrum is below. It has two parameters, k and p, and is accepted where the likelihood gains more
//! than they cost (Schwarz, Ann. Statist. 6 (1978) 461). Harmonics are found one after the other, each by what the samples tell of
//! it without its own prior (Tipping and Faul, Proc. 9th Int. Workshop on Artificial Intelligence and Statistics (2003)).
//!
//! The noise may hide others. They are no part of the estimate, and a part of its covariance: as probably as the ones found are
//! many, and as large as these in the mean of logarithms.

use nalgebra::{DMatrix, DVector};

use super::regression::{Posterior, Regression, Rest};
use super::spectrum::{Spectrum, log};

/// A harmonic with an order of its own.
struct Line {
    /// Index of the harmonic.
    index: usize,
    /// ln of its standard deviation over that of the spectrum.
    log_factor: f64,
    /// Rise of ln of the likelihood.
    rise: f64,
}

impl Regression {
    /// The coefficients given the samples, by a spectrum and the harmonics that stand out of it.
    pub fn solved(&self, spectrum: Spectrum, rest: &Rest) -> Option<Posterior> {
        let mut found = self.solved_with(spectrum.deviations(self.prior))?;
        let of = self.prior.of_harmonic();
        while let Some(line) = self.line(&found, spectrum, rest) {
            let Posterior {
                mut deviations,
                mut lines,
                ..
            } = found;
            let own = deviations.iter_mut().skip(line.index * of).take(of);
            own.for_each(|value| *value *= line.log_factor.exp());
            lines.push(line.index);
            found = self.solved_with(deviations)?;
            found.penalty += 2.0 * rest.cost * lines.len() as f64;
            found.lines = lines;
        }
        Some(found)
    }

    /// Returns the harmonic that stands out most, if one gains more than it costs.
    fn line(&self, found: &Posterior, spectrum: Spectrum, rest: &Rest) -> Option<Line> {
        let before = rest.likelihood_of(found);
        let rise = |[fall, penalty]: [f64; 2]| {
            rest.likelihood(found.fall + fall, found.penalty + penalty) - before
        };
        let told = self.told(found, spectrum).into_iter();
        let told = told.filter(|told| {
            told.number <= rest.waves && rise([told.largest_fall(), 0.0]) > rest.cost
        });
        let likeliest = told.filter_map(|told| {
            // The likelihood as a function of ln of the factor is about one wide.
            let parts = 64;
            let range = 2.0 * spectrum.order * log(told.number);
            let logs = (1..=parts).map(|k| range * f64::from(k) / f64::from(parts));
            let lines = logs.map(|log_factor| Line {
                index: told.index,
                log_factor,
                rise: rise(told.change(log_factor)),
            });
            lines.max_by(|a, b| a.rise.total_cmp(&b.rise))
        });
        let lines = likeliest.filter(|line| line.rise > rest.cost);
        lines.max_by(|a, b| a.rise.total_cmp(&b.rise))
    }

    /// Returns what the samples tell of each harmonic of the spectrum but the first one.
    fn told(&self, found: &Posterior, spectrum: Spectrum) -> Vec<Told> {
        let of = self.prior.of_harmonic();
        let factor = found.factor();
        let numbers = self.prior.numbers().enumerate();
        let smooth = numbers.filter(|(index, number)| *number > 1 && !found.lines.contains(index));
        let told = smooth.map(|(index, number)| {
            let unit = spectrum.deviation(number);
            let columns = factor.columns(index * of, of);
            let covariance = columns.tr_mul(&columns) / (unit * unit);
            let mean = found.coefficients[index * of..][..of].iter();
            let mean = DVector::from_iterator(of, mean.map(|value| value / unit));
            Told {
                index,
                number,
                axes: OfAxis::list(covariance, mean),
            }
        });
        told.collect()
    }

    /// Returns the standard deviations of the coefficients with the harmonics that stand out and are hidden.
    pub fn with_hidden(&self, found: &Posterior, spectrum: Spectrum, rest: &Rest) -> Vec<f64> {
        let (all, of) = (self.prior.numbers().count(), self.prior.of_harmonic());
        let mut deviations = found.deviations.clone();
        let out = found.lines.len();
        if out == 0 {
            return deviations;
        }
        let logs = found.lines.iter().map(|one| deviations[one * of].ln());
        let size = logs.sum::<f64>() / out as f64;
        let rate = out as f64 / (all - out) as f64;
        let variance = rest.variance(found.fall);
        for told in self.told(found, spectrum) {
            let log_factor = size - deviations[told.index * of].ln();
            let [fall, penalty] = told.change(log_factor);
            let odds = rate * (0.5 * (fall / variance - penalty)).exp();
            let part = 1.0 / (1.0 + 1.0 / odds);
            let mean = 1.0 - part + part * told.mean_square(log_factor, variance);
            let own = deviations.iter_mut().skip(told.index * of).take(of);
            own.for_each(|value| *value *= mean.sqrt().max(1.0));
        }
        deviations
    }
}

/// What the samples tell of the coefficients of a harmonic without its prior.
struct Told {
    /// Index and number of the harmonic.
    index: usize,
    number: usize,
    /// The axes that the samples tell apart.
    axes: Vec<OfAxis>,
}

/// An estimate, whose unit is the standard deviation by the spectrum.
struct OfAxis {
    /// Inverse of its variance.
    precision: f64,
    /// Its square over its variance, times the precision.
    square: f64,
}

impl OfAxis {
    /// Of a covariance and a mean that the spectrum is a part of, in units of its standard deviation.
    fn list(covariance: DMatrix<f64>, mean: DVector<f64>) -> Vec<OfAxis> {
        let axes = covariance.symmetric_eigen();
        let along = axes.eigenvectors.tr_mul(&mean);
        // Rounding leaves no less of a variance.
        let variances = axes.eigenvalues.iter().map(|one| one.max(f64::EPSILON));
        let pairs = variances.zip(&along);
        let of_axis = pairs.map(|(variance, mean)| OfAxis {
            precision: (1.0 / variance - 1.0).max(f64::EPSILON),
            square: (mean / variance).powi(2),
        });
        of_axis.collect()
    }
}

impl Told {
    /// The largest fall of the sum of squares that another standard deviation leaves.
    fn largest_fall(&self) -> f64 {
        let of = |axis: &OfAxis| axis.square / (axis.precision * (1.0 + axis.precision));
        self.axes.iter().map(of).sum()
    }

    /// Further fall of the sum of squares and further penalty by ln of the factor of the standard deviation.
    fn change(&self, log_factor: f64) -> [f64; 2] {
        let factor = (2.0 * log_factor).exp();
        let of = |[fall, penalty]: [f64; 2], axis: &OfAxis| {
            let [with, without] = [factor, 1.0].map(|one| 1.0 + one * axis.precision);
            let more = axis.square * (factor - 1.0) / (with * without);
            [fall + more, penalty + (with / without).ln()]
        };
        self.axes.iter().fold([0.0; 2], of)
    }

    /// The mean square of a coefficient by ln of the factor of its standard deviation, with this variance of a sample.
    fn mean_square(&self, log_factor: f64, of_sample: f64) -> f64 {
        let factor = (2.0 * log_factor).exp();
        let of = |axis: &OfAxis| {
            let variance = factor / (1.0 + factor * axis.precision);
            variance + variance * variance * axis.square / of_sample
        };
        self.axes.iter().map(of).sum::<f64>() / self.axes.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::model::prior::{Prior, TORQUE};

    /// Forty samples with a fourth harmonic that stands out, and of a variance of one half.
    fn samples() -> (Regression, Rest) {
        let prior = Prior {
            cycle: 1,
            harmonics: 5,
            ..TORQUE
        };
        let mut regression = Regression::new(prior, prior.coefficients());
        let mut squares = 0.0;
        for i in 0..40 {
            let wave = |j: usize| (0.37 * (i * (j / 2 + 1)) as f64 + 1.6 * (j % 2) as f64).cos();
            let row: Vec<f64> = (0..prior.coefficients()).map(wave).collect();
            let error = ((i * i * 37 + 11) as f64).sin() + 0.8 * row[7] - 0.4 * row[0];
            regression.take([&row, &[]], error, 1.0);
            squares += error * error;
        }
        regression.multiply();
        let rest = Rest {
            squares,
            free: 40.0,
            variances: [0.5, 0.5],
            waves: 5,
            cost: 1.0,
        };
        (regression, rest)
    }

    const SPECTRUM: Spectrum = Spectrum {
        log_size: -0.7,
        order: 2.0,
    };

    /// A harmonic that stands out, by the likelihoods of all coefficients with each order of its own, and the variance of a sample
    /// that is the likeliest with each.
    #[test]
    fn a_harmonic_stands_out_where_its_order_gains_what_it_costs() {
        let (regression, known) = samples();
        let rest = Rest {
            variances: [1e-6, f64::INFINITY],
            ..known
        };
        let likelihood = |order: f64| {
            let mut deviations = SPECTRUM.deviations(regression.prior);
            deviations[6..8].fill((SPECTRUM.log_size - order * log(4)).exp());
            let found = regression.solved_with(deviations);
            found.map_or(f64::NAN, |found| rest.likelihood_of(&found))
        };
        let orders = (0..4000).map(|k| 2.0 - 1e-3 * f64::from(k));
        let most = orders.map(likelihood).fold(f64::NEG_INFINITY, f64::max);
        let rise = most - likelihood(2.0);
        for (cost, expected) in [(rise - 0.1, vec![3]), (rise + 0.1, vec![])] {
            let rest = Rest { cost, ..rest };
            let found = regression.solved(SPECTRUM, &rest).expect("coefficients");
            assert_eq!(found.lines, expected);
            let of_all = rest.likelihood_of(&found) + cost * expected.len() as f64;
            let smooth = most - if expected.is_empty() { rise } else { 0.0 };
            assert!((of_all - smooth).abs() < 1e-2, "{of_all} {smooth}");
        }
        let aliased = Rest { waves: 3, ..rest };
        let found = regression.solved(SPECTRUM, &aliased).expect("coefficients");
        assert!(found.lines.is_empty());
    }

    /// Mean square of the coefficients of a harmonic that is not known to stand out, from the posteriors with and without.
    #[test]
    fn a_hidden_harmonic_has_the_mean_square_of_both_posteriors() {
        let (regression, rest) = samples();
        let found = regression.solved(SPECTRUM, &rest).expect("coefficients");
        let all = regression.with_hidden(&found, SPECTRUM, &rest);
        for harmonic in [1, 2, 4] {
            let own = 2 * harmonic..2 * harmonic + 2;
            let mut deviations = found.deviations.clone();
            deviations[own.clone()].fill(found.deviations[6]);
            let with = regression.solved_with(deviations).expect("coefficients");
            let without = regression.solved_with(found.deviations.clone());
            let without = rest.likelihood_of(&without.expect("coefficients"));
            let odds = 0.25 * (rest.likelihood_of(&with) - without).exp();
            let left = with.factor().columns(own.start, 2).norm_squared();
            let sizes = with.coefficients[own.clone()].iter();
            let sizes = sizes.map(|value| value * value / 0.5).sum::<f64>();
            let smooth = SPECTRUM.deviation(harmonic + 1).powi(2);
            let mean = (smooth + odds * 0.5 * (left + sizes)) / (1.0 + odds);
            let expected = mean.max(smooth).sqrt();
            let off = (all[own.start] / expected - 1.0).abs();
            assert!(off < 1e-9, "{harmonic}: {} {expected}", all[own.start]);
        }
        assert_eq!(all[6], found.deviations[6]);
    }
}
