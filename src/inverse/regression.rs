//! Linear regression on the harmonics of what repeats: normal equations, the likeliest spectrum, the coefficients.

use nalgebra::{DMatrix, DVector};

use super::prior::Prior;
use crate::numeric::cholesky::cholesky;
use crate::numeric::maximum::largest_to;

/// Rows that are multiplied by a matrix at once.
pub(super) const ROWS_AT_ONCE: usize = 128;

/// Columns of the information that are filled at once.
const BLOCK: usize = 64;

/// Largest order of the periodic process.
const ORDERS: i32 = 3;

/// Tolerance of the search for ln s of a spectrum.
const SPECTRUM_WIDTH: f64 = 0.2;

/// Variances of the coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spectrum {
    /// s, N m in units of σ
    size: f64,
    /// Order m of the periodic Wiener process.
    order: i32,
}

impl Spectrum {
    /// Standard deviation of each coefficient in units of σ.
    fn deviations(self, prior: Prior) -> Vec<f64> {
        let of = |j: usize| self.size / (1.0 + (j / prior.of_harmonic()) as f64).powi(self.order);
        (0..prior.coefficients()).map(of).collect()
    }

    /// Returns s of the spectrum of another order with the same variance at the middle of `harmonics`, on a logarithmic
    /// scale.
    fn of_order(self, order: i32, harmonics: usize) -> f64 {
        self.size * (harmonics as f64).sqrt().powi(order - self.order)
    }
}

/// Normal equations of the coefficients: Σ EᵀE/S, of which the lower triangle is kept, and −Σ Eᵀe/S.
#[derive(Clone, Debug)]
pub(super) struct Regression {
    prior: Prior,
    information: DMatrix<f64>,
    score: Vec<f64>,
    /// Rows E/√S that wait for their multiplication, one after the other.
    rows: Vec<f64>,
}

impl Regression {
    /// The equations of the coefficients of a prior.
    pub fn new(prior: Prior) -> Regression {
        let count = prior.coefficients();
        Regression {
            prior,
            information: DMatrix::zeros(count, count),
            score: vec![0.0; count],
            rows: Vec::with_capacity(ROWS_AT_ONCE * count),
        }
    }

    /// Adds a row E with its error e; `per` is 1/√S.
    pub fn take(&mut self, row: &[f64], error: f64, per: f64) {
        for (value, score) in row.iter().zip(&mut self.score) {
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
        let rows = DMatrix::from_column_slice(count, self.rows.len() / count, &self.rows);
        for first in (0..count).step_by(BLOCK) {
            let (size, left) = (BLOCK.min(count - first), count - first);
            let mut block = self.information.view_mut((first, first), (left, size));
            let right = rows.rows(first, size).transpose();
            block.gemm(1.0, &rows.rows(first, left), &right, 1.0);
        }
        self.rows.clear();
    }

    /// Returns the likeliest spectrum, near one or of all; `likelihood` uses `fall` and `log_determinant`.
    pub fn likeliest(
        &self,
        near: Option<Spectrum>,
        likelihood: impl Fn(&Posterior) -> f64,
    ) -> Option<Spectrum> {
        let told = 1.0 / self.information.diagonal().max().sqrt();
        let of_order = |order: i32| {
            let [low, high] = match near {
                // From e⁻² to 1e13 times the least standard error of a coefficient.
                None => [told * (-2f64).exp(), told * 30f64.exp()],
                Some(near) => {
                    [0.25, 4.0].map(|part| part * near.of_order(order, self.prior.harmonics))
                }
            };
            let with = |log: f64| Spectrum {
                size: log.exp(),
                order,
            };
            let value = |log: f64| {
                self.solved(with(log))
                    .map_or(f64::NEG_INFINITY, |found| likelihood(&found))
            };
            let (log, value) = largest_to(value, [low.ln(), high.ln()], SPECTRUM_WIDTH);
            (value, with(log))
        };
        let orders = (1..=ORDERS).map(of_order);
        let best = orders.max_by(|a, b| a.0.total_cmp(&b.0))?;
        best.0.is_finite().then_some(best.1)
    }

    /// The coefficients given the samples.
    pub fn solved(&self, spectrum: Spectrum) -> Option<Posterior> {
        let count = self.score.len();
        let deviations = spectrum.deviations(self.prior);
        let scaled = DMatrix::from_fn(count, count, |i, j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            unit + deviations[i] * self.information[(i, j)] * deviations[j]
        });
        let cholesky = cholesky(scaled)?;
        let right = DVector::from_fn(count, |j, _| deviations[j] * self.score[j]);
        let solved = cholesky.solve(&right);
        let lower = cholesky.l();
        Some(Posterior {
            fall: right.dot(&solved),
            log_determinant: 2.0 * lower.diagonal().iter().map(|d| d.ln()).sum::<f64>(),
            coefficients: (0..count).map(|j| deviations[j] * solved[j]).collect(),
            deviations,
            lower,
        })
    }
}

/// The coefficients given the samples, in units of σ.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    /// Fall of the sum of squared prediction errors.
    pub fall: f64,
    /// ln |I + D½ information D½|
    pub log_determinant: f64,
    pub coefficients: Vec<f64>,
    deviations: Vec<f64>,
    /// Lower factor of Cholesky.
    lower: DMatrix<f64>,
}

impl Posterior {
    /// A factor A of the covariance Aᵀ A.
    pub fn factor(&self) -> DMatrix<f64> {
        let count = self.coefficients.len();
        let deviations = DMatrix::from_diagonal(&DVector::from_column_slice(&self.deviations));
        let solved = self.lower.solve_lower_triangular(&deviations);
        solved.unwrap_or_else(|| DMatrix::identity(count, count))
    }
}
