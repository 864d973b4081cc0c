//! Linear regression on the harmonics of what repeats: normal equations, the likeliest spectrum, the coefficients.

use nalgebra::{DMatrix, DVector};

use super::kalman::Evidence;
use super::maximum::ENOUGH_RISE;
use super::prior::Prior;
use crate::numeric::cholesky::{cholesky, inverse_of_lower};
use crate::numeric::maximum::largest_to;

/// Rows that are multiplied by a matrix at once.
pub(super) const ROWS_AT_ONCE: usize = 128;

/// Columns of the information that are filled at once.
const BLOCK: usize = 64;

/// Least and largest order of the periodic process: its torque is continuous, and as smooth as a prior's at most.
pub(super) const ORDERS: [f64; 2] = [1.0, 3.0];

/// Variances of the coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spectrum {
    /// ln of s, N m in units of σ
    pub log_size: f64,
    /// Order m of the periodic Wiener process; between whole numbers a fractional one.
    pub order: f64,
}

impl Spectrum {
    /// Standard deviation of the coefficients of a harmonic, from index 0, in units of σ.
    pub fn deviation(self, harmonic: usize) -> f64 {
        (self.log_size - self.order * log(harmonic)).exp()
    }

    /// Standard deviation of each coefficient in units of σ.
    pub fn deviations(self, prior: Prior) -> Vec<f64> {
        let of = |j: usize| self.deviation(j / prior.of_harmonic());
        (0..prior.coefficients()).map(of).collect()
    }

    /// Returns the spectrum after a step along ln s and m, within the bounds of both.
    fn moved(self, [size, order]: [f64; 2], [low, high]: [f64; 2]) -> Spectrum {
        Spectrum {
            log_size: (self.log_size + size).clamp(low, high),
            order: (self.order + order).clamp(ORDERS[0], ORDERS[1]),
        }
    }
}

/// ln of the number of a harmonic, from index 0.
pub(super) fn log(harmonic: usize) -> f64 {
    ((1 + harmonic) as f64).ln()
}

/// Evidence of the samples without the periodic part, to which that part adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rest {
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
    /// The likeliest variance of a sample, given the coefficients.
    pub fn variance(&self, found: &Posterior) -> f64 {
        let [least, largest] = self.variances;
        ((self.squares - found.fall) / self.free).clamp(least, largest)
    }

    /// ln of the likelihood, up to what no spectrum changes.
    pub fn likelihood(&self, found: &Posterior) -> f64 {
        let (variance, squares) = (self.variance(found), self.squares - found.fall);
        -0.5 * (self.free * variance.ln() + squares / variance + found.penalty)
    }
}

/// Normal equations of the coefficients: Σ EᵀE/S, of which the lower triangle is kept, and −Σ Eᵀe/S.
#[derive(Clone, Debug)]
pub(super) struct Regression {
    pub prior: Prior,
    /// Likelihood terms without the periodic part.
    pub evidence: Evidence,
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
        sum.unwrap_or_else(|| Regression::new(prior))
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
        let rows = DMatrix::from_column_slice(count, self.rows.len() / count.max(1), &self.rows);
        for first in (0..count).step_by(BLOCK) {
            let (size, left) = (BLOCK.min(count - first), count - first);
            let mut block = self.information.view_mut((first, first), (left, size));
            let right = rows.rows(first, size).transpose();
            block.gemm(1.0, &rows.rows(first, left), &right, 1.0);
        }
        self.rows.clear();
    }

    /// Returns the likeliest spectrum with its coefficients, from one or from the likeliest of the middle order, by
    /// Fisher's scoring: the step is the score over its variance (Patterson and Thompson, Biometrika 58 (1971) 545), halved
    /// where the likelihood falls.
    pub fn likeliest(&self, near: Option<Spectrum>, rest: &Rest) -> Option<(Spectrum, Posterior)> {
        // From e⁻² to 1e13 times the least standard error of a coefficient.
        let least = -0.5 * self.information.diagonal().max().ln();
        let sizes = [least - 2.0, least + 30.0];
        let mut now = near.unwrap_or_else(|| self.likeliest_of_middle(sizes, rest));
        let mut found = self.solved(now, rest)?;
        loop {
            let step = self.scoring(&found, rest.variance(&found), now)?;
            let mut part = 1.0;
            loop {
                if part * step.rise.max(0.0) < ENOUGH_RISE {
                    return Some((now, found));
                }
                let next = now.moved(step.change.map(|change| part * change), sizes);
                match self.solved(next, rest) {
                    Some(other) if rest.likelihood(&other) > rest.likelihood(&found) => {
                        (now, found) = (next, other);
                        break;
                    }
                    _ => part *= 0.5,
                }
            }
        }
    }

    /// Returns the likeliest spectrum of the middle order.
    fn likeliest_of_middle(&self, sizes: [f64; 2], rest: &Rest) -> Spectrum {
        let with = |log_size: f64| Spectrum {
            log_size,
            order: 0.5 * (ORDERS[0] + ORDERS[1]),
        };
        let value = |log: f64| {
            let found = self.solved_with(with(log).deviations(self.prior));
            found.map_or(f64::NEG_INFINITY, |found| rest.likelihood(&found))
        };
        with(largest_to(value, sizes, 1.0).0)
    }

    /// The scoring step of ln s and m: with the shares H = I − (I + D½ information D½)⁻¹ that the samples have in the
    /// coefficients β, the score of ln of each deviation is β²/(σ² D) − H, with the covariance 2 H² of each two.
    pub fn scoring(&self, found: &Posterior, variance: f64, at: Spectrum) -> Option<Scoring> {
        let factor = inverse_of_lower(&found.lower);
        let left = factor.transpose() * factor;
        let of = self.prior.of_harmonic();
        let smooth = (0..left.ncols()).filter(|j| !found.stands_out(j / of, of, at));
        let logs: Vec<(usize, f64)> = smooth.map(|j| (j, log(j / of))).collect();
        let (mut slope, mut information) = ([0.0; 2], [0.0; 3]);
        for &(j, log) in &logs {
            let size = found.coefficients[j] / found.deviations[j];
            let score = size * size / variance - (1.0 - left[(j, j)]);
            slope = [slope[0] + score, slope[1] - log * score];
            for &(i, other) in &logs {
                let unit = if i == j { 1.0 } else { 0.0 };
                let square = 2.0 * (unit - left[(i, j)]).powi(2);
                let parts = [square, -square * log, square * log * other];
                (0..3).for_each(|k| information[k] += parts[k]);
            }
        }
        let [a, b, c] = information;
        let both = [
            (c * slope[0] - b * slope[1]) / (a * c - b * b),
            (a * slope[1] - b * slope[0]) / (a * c - b * b),
        ];
        // At the least or largest order the size alone may change.
        let change = match (at.order + both[1]).clamp(ORDERS[0], ORDERS[1]) - at.order {
            0.0 => [slope[0] / a, 0.0],
            _ => both,
        };
        let rise = 0.5 * (slope[0] * change[0] + slope[1] * change[1]);
        Some(Scoring {
            change,
            rise,
            information,
        })
    }

    /// The coefficients given the samples, by their standard deviations before.
    pub fn solved_with(&self, deviations: Vec<f64>) -> Option<Posterior> {
        let count = self.score.len();
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
            penalty: 2.0 * lower.diagonal().iter().map(|d| d.ln()).sum::<f64>(),
            coefficients: (0..count).map(|j| deviations[j] * solved[j]).collect(),
            deviations,
            lower,
        })
    }
}

/// Change of ln s and m, and the rise of ln of the likelihood that it promises.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scoring {
    change: [f64; 2],
    rise: f64,
    /// Fisher's information of ln s, of both, and of m.
    pub information: [f64; 3],
}

/// The coefficients given the samples, in units of σ.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    /// Fall of the sum of squared prediction errors.
    pub fall: f64,
    /// ln |I + D½ information D½|, and twice what the harmonics that stand out cost.
    pub penalty: f64,
    pub coefficients: Vec<f64>,
    /// Standard deviations before the samples.
    pub deviations: Vec<f64>,
    /// Lower factor of Cholesky.
    lower: DMatrix<f64>,
}

impl Posterior {
    /// Returns the highest harmonic whose variance the samples reduce by more than half, at the mean speed, or 0; `factor` is
    /// that of the covariance.
    pub fn told(&self, factor: &DMatrix<f64>, prior: Prior) -> usize {
        let of = prior.of_harmonic();
        let is_told = |harmonic: &usize| {
            let first = (harmonic - 1) * of;
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

    /// A factor A of the covariance Aᵀ A.
    pub fn factor(&self) -> DMatrix<f64> {
        let mut factor = inverse_of_lower(&self.lower);
        let pairs = factor.column_iter_mut().zip(&self.deviations);
        pairs.for_each(|(mut column, deviation)| column *= *deviation);
        factor
    }
}
