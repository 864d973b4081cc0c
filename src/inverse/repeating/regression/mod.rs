//! Linear regression on the harmonics of what repeats: normal equations and coefficients.

pub(in crate::inverse) mod over_tones;

use nalgebra::{DMatrix, DVector};

use super::super::model::kalman::Evidence;
use super::super::model::prior::Prior;
use crate::numeric::cholesky::{cholesky, inverse_of_lower};

/// Rows that are multiplied by a matrix at once.
pub(in crate::inverse) const ROWS_AT_ONCE: usize = 128;

/// Rows or columns of a triangle that are multiplied at once.
pub(in crate::inverse) const BLOCK: usize = 64;

/// Evidence of the samples without the periodic part, to which that part adds.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Rest {
    /// Sum of squared prediction errors.
    pub squares: f64,
    /// Degrees of freedom.
    pub free: f64,
    /// Least and largest variance of a sample.
    pub variances: [f64; 2],
    /// Highest harmonic with two samples in a wave: others may be aliases.
    pub waves: usize,
    /// Cost of a harmonic that stands out in ln of the likelihood.
    pub cost: f64,
}

impl Rest {
    /// The likeliest variance of a sample, given the fall of the sum of squares.
    pub fn variance(&self, fall: f64) -> f64 {
        let [least, largest] = self.variances;
        ((self.squares - fall) / self.free).clamp(least, largest)
    }

    /// ln of the likelihood, up to what no spectrum changes.
    pub fn likelihood(&self, fall: f64, penalty: f64) -> f64 {
        let (variance, squares) = (self.variance(fall), self.squares - fall);
        -0.5 * (self.free * variance.ln() + squares / variance + penalty)
    }

    /// ln of the likelihood of coefficients.
    pub fn likelihood_of(&self, found: &Posterior) -> f64 {
        self.likelihood(found.fall, found.penalty)
    }
}

/// Normal equations of the coefficients: Σ EᵀE/S, of which the lower triangle is kept, and −Σ Eᵀe/S.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct Regression {
    pub prior: Prior,
    /// Likelihood terms without the periodic part.
    pub evidence: Evidence,
    information: DMatrix<f64>,
    score: Vec<f64>,
    /// Rows E/√S that wait for their multiplication, one after the other.
    rows: Vec<f64>,
}

impl Regression {
    /// The equations of the coefficients of a prior, of which there are so many with those of other regressors.
    pub fn new(prior: Prior, count: usize) -> Regression {
        Regression {
            prior,
            evidence: Evidence::default(),
            information: DMatrix::zeros(count, count),
            score: vec![0.0; count],
            rows: Vec::with_capacity(ROWS_AT_ONCE * count),
        }
    }

    /// Returns the sum of the equations of several stretches.
    pub fn of_all(prior: Prior, parts: Vec<Regression>) -> Regression {
        let add = |mut sum: Regression, part: Regression| {
            sum.evidence += part.evidence;
            sum.information += part.information;
            let scores = sum.score.iter_mut().zip(part.score);
            scores.for_each(|(sum, part)| *sum += part);
            sum
        };
        let sum = parts.into_iter().reduce(add);
        sum.unwrap_or_else(|| Regression::new(prior, prior.coefficients()))
    }

    /// Number of coefficients, with those of other regressors.
    pub fn count(&self) -> usize {
        self.score.len()
    }

    /// Adds a row E, in two parts, with its error e; `per` is 1/√S.
    pub fn take(&mut self, row: [&[f64]; 2], error: f64, per: f64) {
        for (value, score) in row.into_iter().flatten().zip(&mut self.score) {
            *score -= value * per * error * per;
            self.rows.push(value * per);
        }
        if self.rows.len() == ROWS_AT_ONCE * self.score.len() {
            self.multiply();
        }
    }

    /// Adds the products of the waiting rows: the lower triangle, block by block.
    pub fn multiply(&mut self) {
        let count = self.score.len();
        let rows = DMatrix::from_column_slice(count, self.rows.len() / count.max(1), &self.rows);
        for first in (0..count).step_by(BLOCK) {
            let (size, left) = (BLOCK.min(count - first), count - first);
            let mut block = self.information.view_mut((first, first), (left, size));
            let right = rows.rows(first, size).transpose();
            block.gemm(1.0, &rows.rows(first, left), &right, 1.0);
        }
        self.rows.clear();
    }

    /// Returns I + D½ information D½ of the coefficients with standard deviations D½ before the samples.
    fn scaled(&self, deviations: &[f64]) -> DMatrix<f64> {
        let count = deviations.len();
        DMatrix::from_fn(count, count, |i, j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            unit + deviations[i] * self.information[(i, j)] * deviations[j]
        })
    }

    /// The least standard error of a coefficient beside known others, in units of σ.
    pub fn least_error(&self) -> f64 {
        self.information.diagonal().max().sqrt().recip()
    }

    /// The coefficients given the samples, by their standard deviations before.
    pub fn solved_with(&self, deviations: Vec<f64>) -> Option<Posterior> {
        let count = self.score.len();
        let cholesky = cholesky(self.scaled(&deviations))?;
        let right = DVector::from_fn(count, |j, _| deviations[j] * self.score[j]);
        let solved = cholesky.solve(&right);
        let lower = cholesky.l();
        Some(Posterior {
            fall: right.dot(&solved),
            penalty: 2.0 * lower.diagonal().iter().map(|d| d.ln()).sum::<f64>(),
            coefficients: (0..count).map(|j| deviations[j] * solved[j]).collect(),
            deviations,
            lines: Vec::new(),
            lower,
        })
    }
}

/// The coefficients given the samples, in units of σ.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct Posterior {
    /// Fall of the sum of squared prediction errors.
    pub fall: f64,
    /// ln |I + D½ information D½|, and twice what the harmonics that stand out cost.
    pub penalty: f64,
    pub coefficients: Vec<f64>,
    /// Standard deviations before the samples.
    pub deviations: Vec<f64>,
    /// Indices of the harmonics that stand out of the spectrum.
    pub lines: Vec<usize>,
    /// Lower factor of Cholesky.
    lower: DMatrix<f64>,
}

impl Posterior {
    /// Returns the highest harmonic, but for the high ones, whose variance the samples reduce by more than half, at the mean speed, or 0; `factor` is
    /// that of the covariance.
    pub fn told(&self, factor: &DMatrix<f64>, prior: Prior) -> usize {
        let of = prior.of_harmonic();
        let high = prior.high.iter().flatten().count();
        let is_told = |harmonic: &usize| {
            let first = (high + harmonic - 1) * of;
            let (mut left, mut before) = (0.0, 0.0);
            for j in first..first + 2 {
                // At the mean speed the coefficients with and without the speed add up.
                let parts = || (j..first + of).step_by(2);
                let column = |row: usize| parts().map(|k| factor[(row, k)]).sum::<f64>();
                left += (0..factor.nrows())
                    .map(|row| column(row).powi(2))
                    .sum::<f64>();
                before += parts().map(|k| self.deviations[k].powi(2)).sum::<f64>();
            }
            left < 0.5 * before
        };
        (1..=prior.harmonics).rev().find(is_told).unwrap_or(0)
    }

    /// The covariance in units of the standard deviations before the samples.
    pub fn left(&self) -> DMatrix<f64> {
        let factor = inverse_of_lower(&self.lower);
        factor.tr_mul(&factor)
    }

    /// A factor A of the covariance Aᵀ A.
    pub fn factor(&self) -> DMatrix<f64> {
        let mut factor = inverse_of_lower(&self.lower);
        let pairs = factor.column_iter_mut().zip(&self.deviations);
        pairs.for_each(|(mut column, deviation)| column *= *deviation);
        factor
    }
}
