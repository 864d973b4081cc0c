//! Likelihood over all values of tones, whose numbers are the last coefficients of the normal equations.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::Regression;
use crate::numeric::cholesky::cholesky;

/// Numbers of tones, less those of the linear model, by least squares.
pub(in crate::inverse) struct Tones {
    pub values: DVector<f64>,
    /// Their information, in units of 1/σ².
    pub information: Cholesky<f64, Dyn>,
    /// Fall of the sum of squared prediction errors.
    pub fall: f64,
}

impl Regression {
    /// Returns the equations of the coefficients of the prior, over all values of the tones: these are the last coefficients, and their
    /// density before the samples is the same everywhere (that is REML). Tones that the samples do not tell stay as they are.
    pub fn over_tones(mut self, log_unit: f64) -> Regression {
        let own = self.prior.coefficients();
        let tones = self.score.len() - own;
        if tones == 0 {
            return self;
        }
        let found = self.tones(&[]);
        let across = self.information.view((own, 0), (tones, own)).into_owned();
        self.score.truncate(own);
        self.information = self.information.resize(own, own, 0.0);
        if let Some(Tones {
            values,
            information,
            fall,
        }) = found
        {
            let evidence = &mut self.evidence;
            evidence.squares -= fall;
            evidence.log_variances += information.ln_determinant() + log_unit;
            evidence.samples = evidence.samples.saturating_sub(tones);
            let told = across.tr_mul(&values);
            let pairs = self.score.iter_mut().zip(told.iter());
            pairs.for_each(|(score, told)| *score -= told);
            self.information -= across.tr_mul(&information.solve(&across));
        }
        self
    }

    /// The numbers of the tones by least squares, beside coefficients of what repeats with these standard deviations before, or without
    /// any; none where the samples do not tell them.
    pub fn tones(&self, deviations: &[f64]) -> Option<Tones> {
        let (own, beside) = (self.prior.coefficients(), deviations.len());
        let tones = self.score.len() - own;
        let mut score = DVector::from_column_slice(&self.score[own..]);
        let information = self.information.view((own, own), (tones, tones));
        let mut information = information.into_owned();
        if beside > 0 {
            let scaled = cholesky(self.scaled(deviations))?;
            let across = self.information.view((own, 0), (tones, beside));
            let across = DMatrix::from_fn(beside, tones, |j, k| deviations[j] * across[(k, j)]);
            let known = DVector::from_fn(beside, |j, _| deviations[j] * self.score[j]);
            score -= across.tr_mul(&scaled.solve(&known));
            information -= across.tr_mul(&scaled.solve(&across));
        }
        let information = cholesky(information)?;
        let values = information.solve(&score);
        Some(Tones {
            fall: score.dot(&values),
            values,
            information,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::model::kalman::Evidence;
    use crate::inverse::model::prior::{Prior, TORQUE};

    /// Equations of two harmonics and of the three numbers of a tone.
    fn samples() -> Regression {
        let prior = Prior {
            cycle: 1,
            harmonics: 2,
            ..TORQUE
        };
        let mut regression = Regression::new(prior, 7);
        for i in 0..50 {
            let row: [f64; 7] = std::array::from_fn(|j| (0.3 * (i * (j + 1)) as f64).cos());
            let error = ((i * i * 37 + 11) as f64).sin() + 0.8 * row[1] - 0.4 * row[5];
            regression.take([&row[..4], &row[4..]], error, 1.0);
        }
        regression.multiply();
        regression
    }

    /// Tones of any size are coefficients of a width whose logarithm, ten here, is the unit of their density.
    #[test]
    fn a_likelihood_over_all_tones_is_that_of_a_wide_density() {
        let (wide, deviations) = (10f64.exp(), vec![0.7, 0.7, 0.3, 0.3]);
        let with_wide = [deviations.clone(), vec![wide; 3]].concat();
        let together = samples().solved_with(with_wide).expect("coefficients");
        let rest = samples().over_tones(2.0 * 3.0 * wide.ln());
        let tones = samples().tones(&deviations).expect("tones");
        let apart = rest.solved_with(deviations).expect("coefficients");
        let Evidence {
            squares,
            log_variances,
            ..
        } = rest.evidence;
        let pairs = [
            (apart.fall - squares, together.fall),
            (apart.penalty + log_variances, together.penalty),
            (apart.coefficients[3], together.coefficients[3]),
            (tones.values[2], together.coefficients[6]),
        ];
        for (apart, together) in pairs {
            assert!((apart - together).abs() < 1e-7, "{apart} {together}");
        }
    }
}
