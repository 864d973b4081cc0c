//! Penalized least squares with B-splines.

use super::condensed::Rows;
use super::pieces::{DEGREE, Grid, basis};
use super::roughness::{ORDER, penalty, pull, roughness};
use super::sweep::sums;
use crate::numeric::banded::{Banded, DIAGONALS};
use crate::numeric::chebyshev::largest;

/// Logarithm of the weakest penalty, relative to the mean pivot.
pub(super) const WEAKEST: f64 = -15.0;

/// Part of the largest coefficient that is nothing beside its rounding.
const NOTHING: f64 = 0.1 * f64::EPSILON;

/// Sums over the samples for one grid.
#[derive(Clone)]
pub(super) struct Normal<'a> {
    pub grid: Grid,
    samples: &'a Rows<'a>,
    pub matrix: Banded,
    penalty: Banded,
    /// Logarithm of the product of the penalty's nonzero eigenvalues.
    pub log_penalty: f64,
}

impl<'a> Normal<'a> {
    pub fn new(samples: &'a Rows<'a>, pieces: usize) -> Normal<'a> {
        let grid = Grid::new(samples, pieces);
        let parts = samples.parts(|range| {
            let touched = grid.touched(samples, &range);
            let (first, mut matrix) = (touched.start, Banded::new(touched.len()));
            for (t, weight, _) in samples.some(range) {
                let (piece, u) = grid.place(t);
                let b = basis(DEGREE, u);
                let weight = weight * weight;
                let from = piece - first;
                for row in 0..DIAGONALS {
                    for column in 0..=row {
                        matrix.add(from + row, from + column, weight * b[row] * b[column]);
                    }
                }
            }
            Some((first, matrix))
        });
        let mut matrix = Banded::new(grid.size());
        for (first, part) in parts.into_iter().flatten() {
            matrix.add_from(first, &part);
        }
        let (penalty, log_penalty) = penalty(grid.size());
        Normal {
            grid,
            samples,
            matrix,
            penalty,
            log_penalty,
        }
    }

    /// Residuals of the samples, their sum of squares, and Bᵀ times them.
    pub fn residuals(&self, coefficients: &[f64]) -> (f64, Vec<f64>) {
        let parts = self.samples.parts(|range| {
            let touched = self.grid.touched(self.samples, &range);
            let mut right = vec![0.0; touched.len()];
            let mut squares = 0.0;
            for (t, weight, target) in self.samples.some(range) {
                let (piece, u) = self.grid.place(t);
                let b = basis(DEGREE, u);
                let part = &coefficients[piece..piece + DIAGONALS];
                let value: f64 = b.iter().zip(part).map(|(b, c)| b * c).sum();
                let residual = target - weight * value;
                squares += residual * residual;
                for (right, b) in right[piece - touched.start..].iter_mut().zip(b) {
                    *right += weight * b * residual;
                }
            }
            (squares, touched.start, right)
        });
        let mut right = vec![0.0; self.grid.size()];
        let mut squares = self.samples.left;
        for (of_part, first, part) in parts {
            squares += of_part;
            let sums = right[first..].iter_mut().zip(part);
            sums.for_each(|(sum, r)| *sum += r);
        }
        (squares, right)
    }

    /// Cholesky's factor of the normal matrix with a penalty of this strength.
    pub fn factor(&self, strength: f64) -> Option<Banded> {
        self.matrix.plus(strength, &self.penalty).cholesky()
    }

    /// What the penalty has bent away of a solution, estimated by smoothing the solution's own pull once more.
    pub fn bent_away(&self, strength: f64, factor: &Banded, coefficients: &[f64]) -> Vec<f64> {
        let pull = pull(coefficients);
        factor.solve(&pull.iter().map(|p| strength * p).collect::<Vec<f64>>())
    }

    /// What the parameters of a spline under a penalty of this strength are worth.
    pub fn parameters(&self, strength: f64) -> Option<f64> {
        let inverse = self.factor(strength)?.inverse_band();
        Some(inverse.trace_of_product(&self.matrix))
    }

    pub fn rows(&self) -> &Rows<'a> {
        self.samples
    }

    pub fn floor(&self) -> f64 {
        self.samples.floor
    }

    /// Improves a solution for one strength of the penalty until rounding: each step is smaller than the one before by about
    /// the same factor.
    pub fn solve(&self, strength: f64, factor: &Banded, from: Vec<f64>) -> Vec<f64> {
        let mut coefficients = from;
        let mut before = 0.0;
        for _ in 0..3 {
            let (_, mut right) = self.residuals(&coefficients);
            let pull = pull(&coefficients);
            right
                .iter_mut()
                .zip(pull)
                .for_each(|(r, p)| *r -= strength * p);
            let step = factor.solve(&right);
            let size = largest(&step);
            coefficients.iter_mut().zip(step).for_each(|(c, s)| *c += s);
            if before > 0.0 && size * (size / before) < NOTHING * largest(&coefficients) {
                break;
            }
            before = size;
        }
        coefficients
    }
}

/// Sums about a solution that is near all those that are asked for, so that nothing cancels where the noise is small.
pub(super) struct About<'n> {
    pub normal: &'n Normal<'n>,
    pub near: Vec<f64>,
    pub squares: f64,
    data: Vec<f64>,
    pull: Vec<f64>,
}

impl About<'_> {
    /// Least sum of the squares of the residuals and of the penalty, whose strength belongs to the factor: sums of
    /// squares both, so that nothing cancels where the penalty is strong.
    pub fn penalized(&self, strength: f64, factor: &Banded) -> f64 {
        let (step, squares) = self.step(strength, factor);
        let moved: Vec<f64> = self.near.iter().zip(&step).map(|(c, s)| c + s).collect();
        squares + strength * roughness(&moved)
    }

    /// Sum of the squares of the residuals under the same penalty.
    pub fn squares_under(&self, strength: f64, factor: &Banded) -> f64 {
        self.step(strength, factor).1
    }

    /// The way to the solution under the same penalty, and the sum of the squares of the residuals there.
    fn step(&self, strength: f64, factor: &Banded) -> (Vec<f64>, f64) {
        let right = self.data.iter().zip(&self.pull);
        let step = factor.solve(&right.map(|(r, p)| r - strength * p).collect::<Vec<f64>>());
        let fitted = self.normal.matrix.times(&step);
        let change: f64 = (0..step.len())
            .map(|i| step[i] * (fitted[i] - 2.0 * self.data[i]))
            .sum();
        (step, (self.squares + change).max(0.0))
    }

    /// Variance of a sample if this strength of the penalty is the likely one.
    pub fn variance(&self, strength: f64) -> Option<f64> {
        let squares = self.penalized(strength, &self.normal.factor(strength)?);
        let floor = self.normal.floor();
        Some((squares / self.normal.free()).max(floor * floor))
    }

    /// The same least sum, with the logarithm of the determinant, for strengths that are like the one whose solution is near.
    pub fn alike<const N: usize>(&self, strengths: &[f64; N]) -> [[f64; 2]; N] {
        let minus: Vec<f64> = self.pull.iter().map(|p| -p).collect();
        let matrices = [&self.normal.matrix, &self.normal.penalty];
        let sums = sums(matrices, [&self.data, &minus], strengths);
        let rough = roughness(&self.near);
        std::array::from_fn(|i| {
            let before = self.squares + strengths[i] * rough;
            [before - sums[i].square, sums[i].log_determinant]
        })
    }
}

impl Normal<'_> {
    pub fn about(&self, near: Vec<f64>) -> About<'_> {
        let (squares, data) = self.residuals(&near);
        About {
            normal: self,
            pull: pull(&near),
            near,
            squares,
            data,
        }
    }

    /// Mean of the pivots, to which the strength of penalties is relative.
    pub fn mean_pivot(&self) -> f64 {
        let size = self.grid.size();
        (0..size).map(|i| self.matrix.get(i, i)).sum::<f64>() / size as f64
    }

    /// Samples beyond what the penalty leaves free.
    pub fn free(&self) -> f64 {
        self.samples.count as f64 - ORDER as f64
    }

    /// A penalty that cuts off at a frequency this many times as high, but not below the weakest.
    pub fn weaker(&self, strength: f64, cut_off: f64) -> f64 {
        (strength / cut_off.powi(2 * ORDER as i32)).max(self.weakest().min(strength))
    }

    /// The weakest penalty.
    pub fn weakest(&self) -> f64 {
        self.mean_pivot() * WEAKEST.exp()
    }
}
