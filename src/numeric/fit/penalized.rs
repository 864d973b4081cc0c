//! Penalized least squares with B-splines.

use std::array;

use super::condensed::Rows;
use super::likely::STRONGEST;
use super::pieces::Grid;
use super::roughness::{ORDER, Penalty, pull, roughness};
use super::sums::Sums;
use super::sweep::{Factored, sums};
use crate::numeric::banded::{Banded, Factors};
use crate::numeric::chebyshev::largest;
use crate::numeric::parallel;

/// Logarithm of the weakest penalty, relative to the mean pivot.
pub(super) const WEAKEST: f64 = -15.0;

/// Part of the largest coefficient that is nothing beside its rounding.
const NOTHING: f64 = 0.1 * f64::EPSILON;

/// Part of a sum of squares below which a difference from it has lost its digits.
const CANCELLED: f64 = 1e-8;

/// Sums over the samples for one grid.
#[derive(Clone)]
pub(super) struct Normal<'a> {
    pub grid: Grid,
    samples: &'a Rows<'a>,
    pub matrix: Banded,
    penalty: Penalty,
    /// Logarithm of the product of the penalty's nonzero eigenvalues.
    pub log_penalty: f64,
    /// Coefficients that are near, and the squares of the residuals that they leave and Bᵀ times these.
    near: Vec<f64>,
    squares: f64,
    data: Vec<f64>,
}

impl<'a> Normal<'a> {
    pub fn new(samples: &'a Rows<'a>, pieces: usize) -> Normal<'a> {
        let nothing = vec![0.0; Grid::new(samples, pieces).size()];
        Normal::next_to(samples, pieces, nothing)
    }

    /// The sums about coefficients that are near.
    pub fn next_to(samples: &'a Rows<'a>, pieces: usize, near: Vec<f64>) -> Normal<'a> {
        let grid = Grid::new(samples, pieces);
        let sums = Sums::all::<true>(samples, &grid, &near);
        let penalty = Penalty::new(grid.size());
        Normal {
            grid,
            samples,
            matrix: sums.matrix,
            penalty,
            log_penalty: penalty.log_determinant(),
            near,
            squares: sums.squares,
            data: sums.right,
        }
    }

    /// Residuals of the samples, their sum of squares, and Bᵀ times them.
    pub fn residuals(&self, coefficients: &[f64]) -> (f64, Vec<f64>) {
        let sums = Sums::all::<false>(self.samples, &self.grid, coefficients);
        (sums.squares, sums.right)
    }

    /// Cholesky's factor of the normal matrix with a penalty of this strength.
    pub fn factor(&self, strength: f64) -> Option<Factors> {
        Factors::of(self.matrix.plus(strength, |i| self.penalty.row(i)))
    }

    /// What the penalty has bent away of a solution, estimated by smoothing the solution's own pull once more.
    pub fn bent_away(&self, strength: f64, factor: &Factors, coefficients: &[f64]) -> Vec<f64> {
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

    /// The solution for one strength of the penalty by one step from the coefficients that are near, and the squares of the
    /// residuals that it leaves.
    pub fn step(&self, strength: f64) -> Option<(Vec<f64>, f64)> {
        let right = self.data.iter().zip(pull(&self.near));
        let right: Vec<f64> = right.map(|(r, p)| r - strength * p).collect();
        let step = self.factor(strength)?.solve(&right);
        let moved = self.near.iter().zip(&step).map(|(c, s)| c + s);
        let moved: Vec<f64> = moved.collect();
        let mut left = self.squares + self.change(&step, &self.data);
        if left < CANCELLED * self.squares {
            left = self.residuals(&moved).0;
        }
        Some((moved, left))
    }

    /// What a step changes of the sum of squares of the residuals, whose products with the splines are `data`.
    fn change(&self, step: &[f64], data: &[f64]) -> f64 {
        let fitted = self.matrix.times(step);
        let terms = step.iter().zip(&fitted).zip(data);
        terms.map(|((s, fitted), d)| s * (fitted - 2.0 * d)).sum()
    }

    /// The solution for one strength of the penalty.
    pub fn solve(&self, strength: f64, factor: &Factors) -> Vec<f64> {
        self.improve(strength, factor, self.near.clone(), Some(self.data.clone()))
    }

    /// The same from coefficients that are nearer.
    pub fn solve_from(&self, strength: f64, factor: &Factors, nearer: Vec<f64>) -> Vec<f64> {
        self.improve(strength, factor, nearer, None)
    }

    /// Improves a solution until rounding: each step is smaller than the one before by about the same factor. Products of the
    /// splines with its residuals may be known.
    fn improve(
        &self,
        strength: f64,
        factor: &Factors,
        mut coefficients: Vec<f64>,
        mut known: Option<Vec<f64>>,
    ) -> Vec<f64> {
        let mut before = 0.0;
        for _ in 0..3 {
            let known = known.take();
            let mut right = known.unwrap_or_else(|| self.residuals(&coefficients).1);
            let pull = pull(&coefficients);
            right
                .iter_mut()
                .zip(pull)
                .for_each(|(r, p)| *r -= strength * p);
            let step = factor.solve(&right);
            let size = largest(&step);
            coefficients.iter_mut().zip(step).for_each(|(c, s)| *c += s);
            let next = if before > 0.0 {
                size * (size / before)
            } else {
                size
            };
            if next < NOTHING * largest(&coefficients) {
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
    pub fn penalized(&self, strength: f64, factor: &Factors) -> f64 {
        let (step, squares) = self.step(strength, factor);
        let moved: Vec<f64> = self.near.iter().zip(&step).map(|(c, s)| c + s).collect();
        squares + strength * roughness(&moved)
    }

    /// Sum of the squares of the residuals under the same penalty.
    pub fn squares_under(&self, strength: f64, factor: &Factors) -> f64 {
        self.step(strength, factor).1
    }

    /// The way to the solution under the same penalty, and the sum of the squares of the residuals there.
    fn step(&self, strength: f64, factor: &Factors) -> (Vec<f64>, f64) {
        let right = self.data.iter().zip(&self.pull);
        let step = factor.solve(&right.map(|(r, p)| r - strength * p).collect::<Vec<f64>>());
        let change = self.normal.change(&step, &self.data);
        (step, (self.squares + change).max(0.0))
    }

    /// Variance of a sample if this strength of the penalty is the likely one.
    pub fn variance(&self, strength: f64) -> Option<f64> {
        let squares = self.penalized(strength, &self.normal.factor(strength)?);
        let floor = self.normal.floor();
        Some((squares / self.normal.free()).max(floor * floor))
    }

    /// The same least sum, with the logarithm of the determinant, for strengths that are like the one whose solution is near.
    pub fn alike(&self, strengths: &[f64; 4]) -> [[f64; 2]; 4] {
        let minus: Vec<f64> = self.pull.iter().map(|p| -p).collect();
        let Normal {
            matrix, penalty, ..
        } = self.normal;
        let [first, second, third, fourth] = *strengths;
        let pairs = [[first, second], [third, fourth]];
        let found = parallel::map(pairs.iter(), |pair| {
            sums(matrix, penalty, [&self.data, &minus], pair)
        });
        let rough = roughness(&self.near);
        array::from_fn(|i| {
            let Factored {
                square,
                log_determinant,
            } = found[i / 2][i % 2];
            [
                self.squares + strengths[i] * rough - square,
                log_determinant,
            ]
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

    /// The strongest penalty.
    pub fn strongest(&self) -> f64 {
        self.mean_pivot() * STRONGEST.exp()
    }
}
