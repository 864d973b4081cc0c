//! Penalized least squares with B-splines, and the penalty of the largest restricted likelihood.

use super::condensed::Rows;
use super::pieces::{DEGREE, Grid, basis};
use super::roughness::{ORDER, penalty, pull, roughness};
use crate::numeric::banded::{Banded, DIAGONALS};

/// Logarithm of the weakest penalty, relative to the mean pivot.
const WEAKEST: f64 = -15.0;

/// The same of the strongest one: next to it a spline is a polynomial.
const STRONGEST: f64 = 26.0;

/// Costs that differ by this are of penalties about as likely: one standard deviation of the likely penalty.
const ALIKE: f64 = 1.0;

/// Sums over the samples for one grid.
pub(super) struct Normal<'a> {
    pub grid: Grid,
    samples: &'a Rows<'a>,
    pub matrix: Banded,
    penalty: Banded,
    /// Logarithm of the product of the penalty's nonzero eigenvalues.
    log_penalty: f64,
}

impl<'a> Normal<'a> {
    pub fn new(samples: &'a Rows<'a>, pieces: usize) -> Normal<'a> {
        let grid = Grid::new(samples, pieces);
        let parts = samples.parts(|range| {
            let mut matrix = Banded::new(grid.size());
            for (t, weight, _) in samples.some(range) {
                let (piece, u) = grid.place(t);
                let b = basis(DEGREE, u);
                let weight = weight * weight;
                for row in 0..DIAGONALS {
                    for column in 0..=row {
                        matrix.add(piece + row, piece + column, weight * b[row] * b[column]);
                    }
                }
            }
            Some(matrix)
        });
        let sum = parts
            .into_iter()
            .flatten()
            .reduce(|sum, part| sum.plus(1.0, &part));
        let matrix = sum.unwrap_or_else(|| Banded::new(grid.size()));
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
            let mut right = vec![0.0; self.grid.size()];
            let mut squares = 0.0;
            for (t, weight, target) in self.samples.some(range) {
                let (piece, u) = self.grid.place(t);
                let b = basis(DEGREE, u);
                let part = &coefficients[piece..piece + DIAGONALS];
                let value: f64 = b.iter().zip(part).map(|(b, c)| b * c).sum();
                let residual = target - weight * value;
                squares += residual * residual;
                for (right, b) in right[piece..].iter_mut().zip(b) {
                    *right += weight * b * residual;
                }
            }
            (squares, right)
        });
        let mut right = vec![0.0; self.grid.size()];
        let mut squares = self.samples.left;
        for (of_part, part) in parts {
            squares += of_part;
            right.iter_mut().zip(part).for_each(|(sum, r)| *sum += r);
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

    /// Improves a solution for one strength of the penalty until rounding.
    pub fn solve(&self, strength: f64, factor: &Banded, from: Vec<f64>) -> Vec<f64> {
        let mut coefficients = from;
        for _ in 0..3 {
            let (_, mut right) = self.residuals(&coefficients);
            let pull = pull(&coefficients);
            right
                .iter_mut()
                .zip(pull)
                .for_each(|(r, p)| *r -= strength * p);
            let step = factor.solve(&right);
            coefficients.iter_mut().zip(step).for_each(|(c, s)| *c += s);
        }
        coefficients
    }
}

/// A grid with its most likely penalty.
pub(super) struct Choice {
    grid: Grid,
    /// Minus twice the logarithm of the restricted likelihood.
    pub cost: f64,
    /// Strength of the penalty.
    pub strength: f64,
    pub coefficients: Vec<f64>,
}

impl Choice {
    /// Whether its residuals look like noise, hardly correlated, each with the next, or are those of the digits.
    pub fn follows(&self, rows: &Rows<'_>) -> bool {
        let (mut squares, mut products, mut before) = (0.0, 0.0, 0.0);
        for (t, weight, target) in rows.iter() {
            let (piece, u) = self.grid.place(t);
            let part = &self.coefficients[piece..piece + DIAGONALS];
            let value: f64 = basis(DEGREE, u).iter().zip(part).map(|(b, c)| b * c).sum();
            let residual = target - weight * value;
            squares += residual * residual;
            products += residual * before;
            before = residual;
        }
        products <= 3.0 * squares / (rows.number() as f64).sqrt()
            || rows.are_digits(squares + rows.left, 0.0)
    }
}

/// Sums about a solution that is near all those that are asked for, so that nothing cancels where the noise is small.
struct About<'n> {
    normal: &'n Normal<'n>,
    near: Vec<f64>,
    squares: f64,
    data: Vec<f64>,
    pull: Vec<f64>,
}

impl About<'_> {
    /// Least sum of the squares of the residuals and of the penalty, whose strength belongs to the factor: sums of
    /// squares both, so that nothing cancels where the penalty is strong.
    fn penalized(&self, strength: f64, factor: &Banded) -> f64 {
        let right = self.data.iter().zip(&self.pull);
        let step = factor.solve(&right.map(|(r, p)| r - strength * p).collect::<Vec<f64>>());
        let fitted = self.normal.matrix.times(&step);
        let change: f64 = (0..step.len())
            .map(|i| step[i] * (fitted[i] - 2.0 * self.data[i]))
            .sum();
        let moved: Vec<f64> = self.near.iter().zip(&step).map(|(c, s)| c + s).collect();
        (self.squares + change).max(0.0) + strength * roughness(&moved)
    }
}

impl Normal<'_> {
    fn about(&self, near: Vec<f64>) -> About<'_> {
        let (squares, data) = self.residuals(&near);
        About {
            normal: self,
            pull: pull(&near),
            near,
            squares,
            data,
        }
    }

    fn mean_pivot(&self) -> f64 {
        let size = self.grid.size();
        (0..size).map(|i| self.matrix.get(i, i)).sum::<f64>() / size as f64
    }

    fn free(&self) -> f64 {
        self.samples.count as f64 - ORDER as f64
    }

    /// Variance of a sample if this strength of the penalty is the likely one, from a solution that is near.
    pub fn variance(&self, strength: f64, near: &[f64]) -> Option<f64> {
        let factor = self.factor(strength)?;
        let squares = self.about(near.to_vec()).penalized(strength, &factor);
        let floor = self.samples.floor;
        Some((squares / self.free()).max(floor * floor))
    }

    /// A penalty that cuts off at a frequency this many times as high, but not below the weakest.
    pub fn weaker(&self, strength: f64, cut_off: f64) -> f64 {
        (strength / cut_off.powi(2 * ORDER as i32)).max(self.weakest().min(strength))
    }

    /// The weakest penalty.
    pub fn weakest(&self) -> f64 {
        self.mean_pivot() * WEAKEST.exp()
    }

    /// The strength of the penalty with the largest restricted likelihood.
    pub fn choose(&self) -> Option<Choice> {
        let size = self.grid.size();
        let pivot = self.mean_pivot();
        let weak = 1e-7 * pivot;
        let near = self.solve(weak, &self.factor(weak)?, vec![0.0; size]);
        let about = self.about(near);
        let free = self.free();
        let least = self.samples.count as f64 * self.samples.floor * self.samples.floor;
        // What the penalty leaves free has a volume that goes with the number of coefficients.
        let of_size = ORDER as f64 * (size as f64).ln() - self.log_penalty;
        let cost = |log_strength: f64| {
            let strength = pivot * log_strength.exp();
            let Some(factor) = self.factor(strength) else {
                return f64::INFINITY;
            };
            let penalized = about.penalized(strength, &factor).max(least);
            free * (penalized / free).ln() + factor.log_determinant()
                - (size - ORDER) as f64 * strength.ln()
                + of_size
        };
        let best = minimum(&cost, WEAKEST, STRONGEST);
        let least = cost(best);
        // Samples that allow any strong penalty tell but the weakest one that goes with them.
        let strength = if cost(STRONGEST) <= least + ALIKE {
            crossing(&cost, least + ALIKE, WEAKEST, best)
        } else {
            best
        };
        let strength = pivot * strength.exp();
        Some(Choice {
            grid: self.grid,
            cost: least,
            strength,
            coefficients: self.solve(strength, &self.factor(strength)?, about.near),
        })
    }
}

/// The last place before `to` at which a function that falls comes down to a value.
fn crossing(f: &dyn Fn(f64) -> f64, value: f64, mut from: f64, mut to: f64) -> f64 {
    for _ in 0..8 {
        let middle = 0.5 * (from + to);
        if f(middle) > value {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}

/// Place of the least value: a grid of 2, then golden section.
fn minimum(f: &dyn Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let steps = ((to - from) / 2.0).ceil() as usize;
    let place = |i: usize| from + 2.0 * i as f64;
    let values: Vec<f64> = (0..=steps).map(|i| f(place(i))).collect();
    let best = (0..=steps).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    let (mut a, mut b) = (place(best.saturating_sub(1)), place((best + 1).min(steps)));
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut at_c, mut at_d) = (f(c), f(d));
    for _ in 0..14 {
        if at_c < at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - GOLDEN * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + GOLDEN * (b - a);
            at_d = f(d);
        }
    }
    0.5 * (a + b)
}
