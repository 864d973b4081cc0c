//! Harmonics that stand out of a smooth spectrum, as those of cogging and of meshing teeth do.
//!
//! Such a harmonic has the standard deviation s/kᵖ with an order p of its own, uniform between that of the spectrum and its
//! negative: it may be as far above the first harmonic as the spectrum is below. One of all harmonics is expected to stand out. One
//! does where the samples make that more probable than not (median probability model; Barbieri and Berger, Ann. Statist. 32 (2004)
//! 870). They are found one after the other, each by what the samples tell of it without its own prior (Tipping and Faul, Proc. 9th
//! Int. Workshop on Artificial Intelligence and Statistics (2003)).

use nalgebra::{DMatrix, DVector};

use super::regression::{Posterior, Regression, Rest, Spectrum, log};

/// A harmonic with an order of its own.
struct Line {
    /// Index of the harmonic, from 0.
    harmonic: usize,
    /// Root of the mean square of its standard deviations, in that of the spectrum.
    factor: f64,
    /// ln of the odds to a harmonic of the spectrum.
    log_odds: f64,
    /// What the likelihood with that factor has above these odds, in ln.
    price: f64,
}

impl Regression {
    /// The coefficients given the samples, by a spectrum and the harmonics that stand out of it.
    pub fn solved(&self, spectrum: Spectrum, rest: &Rest) -> Option<Posterior> {
        let mut found = self.solved_with(spectrum.deviations(self.prior))?;
        let of = self.prior.of_harmonic();
        while let Some(line) = self.line(&found, spectrum, rest) {
            let mut deviations = found.deviations.clone();
            let own = &mut deviations[line.harmonic * of..][..of];
            own.iter_mut().for_each(|value| *value *= line.factor);
            let price = found.price + line.price;
            found = self.solved_with(deviations)?;
            found.price = price;
        }
        Some(found)
    }

    /// Returns the harmonic that stands out most, if one more probably does than not.
    fn line(&self, found: &Posterior, spectrum: Spectrum, rest: &Rest) -> Option<Line> {
        let of = self.prior.of_harmonic();
        let (factor, sigma) = (found.factor(), rest.variance(found).sqrt());
        let log_all = (self.prior.harmonics as f64).ln();
        let lines = (1..self.prior.harmonics).filter_map(|harmonic| {
            let own = harmonic * of..(harmonic + 1) * of;
            let deviation = spectrum.deviation(harmonic);
            // Those that stand out already have another one.
            let is_smooth = found.deviations[own.start] == deviation;
            let columns = factor.columns(own.start, of);
            let left = columns.tr_mul(&columns) / (deviation * deviation);
            let sizes = &found.coefficients[own];
            let sizes = sizes.iter().map(|value| value / (deviation * sigma));
            let told = Told::new(left, DVector::from_iterator(of, sizes));
            let may_be = is_smooth && told.most() > log_all;
            may_be.then(|| self.line_of(harmonic, &told, spectrum))
        });
        let lines = lines.filter(|line| line.log_odds > 0.0);
        lines.max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))
    }

    /// The line of a harmonic, by what the samples tell of it.
    fn line_of(&self, harmonic: usize, told: &Told, spectrum: Spectrum) -> Line {
        let range = 2.0 * spectrum.order * log(harmonic);
        // The likelihood as a function of ln of the factor is about one wide.
        let parts = 64;
        let logs = (0..parts).map(|k| range * (f64::from(k) + 0.5) / f64::from(parts));
        let list: Vec<[f64; 2]> = logs.map(|log| [log, told.likelihood(log)]).collect();
        let most = list.iter().fold(0.0, |most: f64, [_, log]| most.max(*log));
        let [total, squares] = list
            .iter()
            .fold([0.0; 2], |[total, squares], [log, value]| {
                let weight = (value - most).exp();
                [total + weight, squares + weight * (2.0 * log).exp()]
            });
        let factor = (squares / total).sqrt();
        let mean = most + (total / f64::from(parts)).ln();
        let log_odds = mean - (self.prior.harmonics as f64).ln();
        Line {
            harmonic,
            factor,
            log_odds,
            price: told.likelihood(factor.ln()) - log_odds,
        }
    }
}

/// What the samples tell of the coefficients of a harmonic without its prior, on each of the axes that they tell apart.
struct Told(Vec<OfAxis>);

/// An estimate, whose unit is the standard deviation by the spectrum.
struct OfAxis {
    /// Inverse of its variance.
    precision: f64,
    /// Its square over its variance, times the precision.
    square: f64,
}

impl Told {
    /// Of a covariance and a mean that the spectrum is a part of, in units of its standard deviation.
    fn new(covariance: DMatrix<f64>, mean: DVector<f64>) -> Told {
        let axes = covariance.symmetric_eigen();
        let along = axes.eigenvectors.tr_mul(&mean);
        // Rounding leaves no less of a variance.
        let variances = axes.eigenvalues.iter().map(|one| one.max(f64::EPSILON));
        let pairs = variances.zip(&along);
        let of_axis = pairs.map(|(variance, mean)| OfAxis {
            precision: (1.0 / variance - 1.0).max(f64::EPSILON),
            square: (mean / variance).powi(2),
        });
        Told(of_axis.collect())
    }

    /// The most that ln of the likelihood may rise with the standard deviation.
    fn most(&self) -> f64 {
        let of = |axis: &OfAxis| axis.square / (axis.precision * (1.0 + axis.precision));
        0.5 * self.0.iter().map(of).sum::<f64>()
    }

    /// ln of the likelihood of a standard deviation by ln of its factor to the spectrum's, less that of the spectrum.
    fn likelihood(&self, log_factor: f64) -> f64 {
        let of = |factor: f64| {
            let axes = self.0.iter().map(|axis| {
                let sum = 1.0 + factor * axis.precision;
                factor * axis.square / sum - sum.ln()
            });
            0.5 * axes.sum::<f64>()
        };
        of((2.0 * log_factor).exp()) - of(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::prior::{Prior, TORQUE};
    use super::*;

    /// Odds of a harmonic that stands out, by the likelihoods of all coefficients with each order of its own.
    #[test]
    fn a_harmonic_stands_out_by_the_odds_of_its_orders() {
        let prior = Prior {
            cycle: 1,
            harmonics: 5,
            ..TORQUE
        };
        let mut regression = Regression::new(prior);
        let mut squares = 0.0;
        for i in 0..40 {
            let wave = |j: usize| (0.37 * (i * (j / 2 + 1)) as f64 + 1.6 * (j % 2) as f64).cos();
            let row: Vec<f64> = (0..prior.coefficients()).map(wave).collect();
            let error = ((i * i * 37 + 11) as f64).sin() + 0.8 * row[7] - 0.4 * row[0];
            regression.take(&row, error, 1.0);
            squares += error * error;
        }
        regression.multiply();
        let rest = Rest {
            squares,
            free: 40.0,
            variances: [0.5, 0.5],
        };
        let spectrum = Spectrum {
            log_size: -0.7,
            order: 2.0,
        };
        let likelihood = |order: f64| {
            let mut deviations = spectrum.deviations(prior);
            deviations[6..8].fill((spectrum.log_size - order * log(3)).exp());
            let found = regression.solved_with(deviations);
            found.map_or(f64::NAN, |found| rest.likelihood(&found))
        };
        let smooth = likelihood(2.0);
        let parts = 4000;
        let orders = (0..parts).map(|k| 4.0 * (f64::from(k) + 0.5) / f64::from(parts) - 2.0);
        let odds = orders.map(|order| (likelihood(order) - smooth).exp());
        let mean = odds.sum::<f64>() / f64::from(parts);
        let by_sum = smooth + (mean / 5.0).ln();
        let found = regression.solved(spectrum, &rest).expect("coefficients");
        let own: Vec<usize> = (0..prior.harmonics)
            .filter(|k| found.deviations[2 * k] != spectrum.deviation(*k))
            .collect();
        assert_eq!(own, [3]);
        assert!(by_sum > smooth + 1.0, "{by_sum} {smooth}");
        let likelihood = rest.likelihood(&found);
        assert!((likelihood - by_sum).abs() < 1e-2, "{likelihood} {by_sum}");
    }
}
