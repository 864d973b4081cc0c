//! Smoothing splines: pieces of degree 5 with a penalty on the differences of their coefficients (Eilers and Marx,
//! Statist. Sci. 11 (1996) 89). Penalty and number of pieces are those of the largest restricted likelihood, and the
//! covariance is that of the Bayesian view, which has the error of smoothing in it (Wahba, J. R. Statist. Soc. B 45
//! (1983) 133).

use super::{Quality, Samples, Size, State};
use crate::numeric::banded::{Banded, DIAGONALS};

/// Degree of the pieces.
pub(super) const DEGREE: usize = 5;

/// Order of the differences that are kept small.
const ORDER: usize = 4;

/// Pieces for each one that the samples ask for, so that the penalty and not the pieces decide how smooth it is.
const FINER: usize = 4;

/// Fewest pieces that are tried.
const FEWEST: usize = 4;

/// A fitted smoothing spline.
#[derive(Clone, Debug)]
pub struct Spline {
    grid: Grid,
    coefficients: Vec<f64>,
    /// Band of the inverse of the penalized normal matrix.
    inverse: Banded,
    quality: Quality,
    condition: f64,
}

/// Evenly spaced knots.
#[derive(Clone, Copy, Debug)]
struct Grid {
    start: f64,
    width: f64,
    pieces: usize,
}

impl Grid {
    fn new(samples: &Samples<'_>, pieces: usize) -> Grid {
        let (first, last) = (samples.t[0], samples.t[samples.t.len() - 1]);
        Grid {
            start: first,
            width: (last - first) / pieces as f64,
            pieces,
        }
    }

    fn size(&self) -> usize {
        self.pieces + DEGREE
    }

    /// The piece at `t` and the place in it, from 0 to 1.
    fn place(&self, t: f64) -> (usize, f64) {
        let at = (t - self.start) / self.width;
        let piece = (at.max(0.0) as usize).min(self.pieces - 1);
        (piece, at - piece as f64)
    }
}

/// The cardinal B-splines of a degree at place u of a piece (de Boor's recurrence on even knots).
fn basis(degree: usize, u: f64) -> [f64; DIAGONALS] {
    let mut b = [0.0; DIAGONALS];
    b[0] = 1.0;
    for d in 1..=degree {
        let per = 1.0 / d as f64;
        let mut saved = 0.0;
        for (r, value) in b.iter_mut().enumerate().take(d) {
            let part = *value * per;
            *value = saved + ((r + 1) as f64 - u) * part;
            saved = (u + (d - 1 - r) as f64) * part;
        }
        b[d] = saved;
    }
    b
}

/// Sums over the samples for one grid.
struct Normal<'a> {
    grid: Grid,
    samples: &'a Samples<'a>,
    matrix: Banded,
    penalty: Banded,
    /// Logarithm of the product of the penalty's nonzero eigenvalues.
    log_penalty: f64,
}

impl<'a> Normal<'a> {
    fn new(samples: &'a Samples<'a>, pieces: usize) -> Normal<'a> {
        let grid = Grid::new(samples, pieces);
        let mut matrix = Banded::new(grid.size());
        for (i, t) in samples.t.iter().enumerate() {
            let (piece, u) = grid.place(*t);
            let b = basis(DEGREE, u);
            let weight = samples.weight.map_or(1.0, |w| w[i] * w[i]);
            for row in 0..DIAGONALS {
                for column in 0..=row {
                    matrix.add(piece + row, piece + column, weight * b[row] * b[column]);
                }
            }
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
    fn residuals(&self, coefficients: &[f64]) -> (f64, Vec<f64>) {
        let mut right = vec![0.0; self.grid.size()];
        let mut squares = 0.0;
        for (i, (t, target)) in self.samples.t.iter().zip(self.samples.target).enumerate() {
            let (piece, u) = self.grid.place(*t);
            let b = basis(DEGREE, u);
            let weight = self.samples.weight.map_or(1.0, |w| w[i]);
            let part = &coefficients[piece..piece + DIAGONALS];
            let value: f64 = b.iter().zip(part).map(|(b, c)| b * c).sum();
            let residual = target - weight * value;
            squares += residual * residual;
            for (right, b) in right[piece..].iter_mut().zip(b) {
                *right += weight * b * residual;
            }
        }
        (squares, right)
    }

    /// Whether the residuals look like noise: hardly correlated, each with the next.
    fn follows(&self, coefficients: &[f64]) -> bool {
        let (mut squares, mut products, mut before) = (0.0, 0.0, 0.0);
        for (i, (t, target)) in self.samples.t.iter().zip(self.samples.target).enumerate() {
            let (piece, u) = self.grid.place(*t);
            let part = &coefficients[piece..piece + DIAGONALS];
            let value: f64 = basis(DEGREE, u).iter().zip(part).map(|(b, c)| b * c).sum();
            let residual = target - self.samples.weight.map_or(1.0, |w| w[i]) * value;
            squares += residual * residual;
            products += residual * before;
            before = residual;
        }
        products <= 3.0 * squares / (self.samples.t.len() as f64).sqrt()
    }

    fn factor(&self, strength: f64) -> Option<Banded> {
        self.matrix.plus(strength, &self.penalty).cholesky()
    }

    /// Improves a solution for one strength of the penalty until rounding.
    fn solve(&self, strength: f64, factor: &Banded, from: Vec<f64>) -> Vec<f64> {
        let mut coefficients = from;
        for _ in 0..3 {
            let (_, mut right) = self.residuals(&coefficients);
            let pull = self.penalty.times(&coefficients);
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

/// Weights of a difference: binomial coefficients of alternating sign.
fn difference() -> [f64; ORDER + 1] {
    let mut difference = [0.0; ORDER + 1];
    difference[0] = 1.0;
    for order in 1..=ORDER {
        for k in (1..=order).rev() {
            difference[k] -= difference[k - 1];
        }
    }
    difference
}

/// Sum of squares of the differences of coefficients.
fn roughness(coefficients: &[f64]) -> f64 {
    let difference = difference();
    let one = |w: &[f64]| w.iter().zip(difference).map(|(c, d)| c * d).sum::<f64>();
    coefficients
        .windows(ORDER + 1)
        .map(|w| one(w) * one(w))
        .sum()
}

/// DᵀD for differences of `ORDER`, and the logarithm of the determinant of DDᵀ.
fn penalty(size: usize) -> (Banded, f64) {
    let difference = difference();
    let mut penalty = Banded::new(size);
    for row in 0..size - ORDER {
        for i in 0..=ORDER {
            for j in 0..=i {
                penalty.add(row + i, row + j, difference[i] * difference[j]);
            }
        }
    }
    // The determinant of the symmetric Toeplitz matrix of the symbol (2 − 2 cos)^ORDER, but for a constant factor
    // (Böttcher and Silbermann, Integral Equations Oper. Theory 9 (1986) 1; for order 1 it is the size plus 1).
    let rows = (size - ORDER) as f64;
    let pairs = (0..ORDER).flat_map(|i| (0..ORDER).map(move |j| i + j));
    let log_determinant = pairs.map(|k| (rows + 1.0 + k as f64).ln()).sum();
    (penalty, log_determinant)
}

/// A grid with its best penalty.
struct Choice {
    /// Minus twice the logarithm of the restricted likelihood.
    cost: f64,
    strength: f64,
    coefficients: Vec<f64>,
}

impl Normal<'_> {
    /// The strength of the penalty with the largest restricted likelihood.
    fn choose(&self) -> Option<Choice> {
        let rows = self.samples.t.len() as f64;
        let size = self.grid.size();
        let trace = (0..size).map(|i| self.matrix.get(i, i)).sum::<f64>() / size as f64;
        let weak = 1e-7 * trace;
        let near = self.solve(weak, &self.factor(weak)?, vec![0.0; size]);
        let (squares, data) = self.residuals(&near);
        let pull = self.penalty.times(&near);
        let least = rows * self.samples.floor * self.samples.floor;
        let free = rows - ORDER as f64;
        // All sums are taken about the weakly smoothed solution, so that nothing cancels where the noise is small.
        let cost = |log_strength: f64| {
            let strength = trace * log_strength.exp();
            let Some(factor) = self.factor(strength) else {
                return f64::INFINITY;
            };
            let right: Vec<f64> = data
                .iter()
                .zip(&pull)
                .map(|(r, p)| r - strength * p)
                .collect();
            let step = factor.solve(&right);
            let fitted = self.matrix.times(&step);
            // Squares of the residuals after the step, and the penalty from the differences themselves: sums of
            // squares both, so that nothing cancels where the penalty is strong.
            let change: f64 = (0..size)
                .map(|i| step[i] * (fitted[i] - 2.0 * data[i]))
                .sum();
            let moved: Vec<f64> = near.iter().zip(&step).map(|(c, s)| c + s).collect();
            let penalized = (squares + change).max(0.0) + strength * roughness(&moved);
            let penalized = penalized.max(least);
            free * (penalized / free).ln() + factor.log_determinant()
                - (size - ORDER) as f64 * strength.ln()
                - self.log_penalty
        };
        let log_strength = minimum(&cost, -15.0, 24.0);
        let strength = trace * log_strength.exp();
        Some(Choice {
            cost: cost(log_strength),
            strength,
            coefficients: self.solve(strength, &self.factor(strength)?, near),
        })
    }
}

/// Place of the least value: a grid of 2, then golden section.
fn minimum(f: &dyn Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let steps = ((to - from) / 2.0).ceil() as usize;
    let place = |i: usize| from + 2.0 * i as f64;
    let values: Vec<f64> = (0..=steps).map(|i| f(place(i))).collect();
    let best = (0..=steps).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    let (mut a, mut b) = (place(best.saturating_sub(1)), place((best + 1).min(steps)));
    const GOLDEN: f64 = 0.618_033_988_749_895;
    for _ in 0..14 {
        let (c, d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        if f(c) < f(d) { b = d } else { a = c }
    }
    0.5 * (a + b)
}

impl Spline {
    /// Fits a smoothing spline of this many pieces, or of as many as the samples ask for.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn fit(samples: &Samples<'_>, size: Size) -> Result<Spline, String> {
        let failed = || "the samples do not determine a spline".to_owned();
        let rows = samples.t.len();
        let pieces = match size {
            Size::Fixed(pieces) => pieces,
            Size::Auto => {
                let most = (rows / 2).saturating_sub(DEGREE).max(1);
                let (mut pieces, mut worse) = (FEWEST.min(most), 0);
                let mut best: Option<(f64, usize, bool)> = None;
                while pieces <= most && (worse < 2 || best.is_some_and(|best| !best.2)) {
                    let normal = Normal::new(samples, pieces);
                    let choice = normal.choose().ok_or_else(failed)?;
                    if best.is_none_or(|best| choice.cost < best.0) {
                        let follows = normal.follows(&choice.coefficients);
                        best = Some((choice.cost, pieces, follows));
                        worse = 0;
                    } else {
                        worse += 1;
                    }
                    pieces *= 2;
                }
                let enough = best.ok_or_else(failed)?.1;
                (FINER * enough).min(most).max(enough)
            }
        };
        let normal = Normal::new(samples, pieces);
        let choice = normal.choose().ok_or_else(failed)?;
        let factor = normal.factor(choice.strength).ok_or_else(failed)?;
        let inverse = factor.inverse_band();
        let (squares, _) = normal.residuals(&choice.coefficients);
        let bent = roughness(&choice.coefficients);
        let free = (rows - ORDER) as f64;
        let sigma = ((squares + choice.strength * bent) / free).sqrt();
        Ok(Spline {
            grid: normal.grid,
            quality: Quality {
                squares,
                parameters: inverse.trace_of_product(&normal.matrix),
                sigma: sigma.max(samples.floor),
                floor: samples.floor,
            },
            condition: factor.diagonal_ratio(),
            coefficients: choice.coefficients,
            inverse,
        })
    }

    /// Number of its pieces.
    pub fn pieces(&self) -> usize {
        self.grid.pieces
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Coefficients of the B-splines, their standard errors for samples of unit variance, and the ratio of the largest
    /// to the smallest pivot of their equations.
    pub fn coefficients(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let error = |i| self.inverse.get(i, i).sqrt();
        let errors = (0..self.coefficients.len()).map(error).collect();
        (self.coefficients.clone(), errors, self.condition)
    }

    /// The spline and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let (piece, u) = self.grid.place(t);
        let per = 1.0 / self.grid.width;
        let (value, lower, lowest) = (basis(DEGREE, u), basis(DEGREE - 1, u), basis(DEGREE - 2, u));
        let at = |list: &[f64; DIAGONALS], i: usize, back: usize| {
            if i >= back { list[i - back] } else { 0.0 }
        };
        let bases: [[f64; DIAGONALS]; 3] = [
            value,
            std::array::from_fn(|i| per * (at(&lower, i, 1) - lower[i])),
            std::array::from_fn(|i| {
                per * per * (at(&lowest, i, 2) - 2.0 * at(&lowest, i, 1) + lowest[i])
            }),
        ];
        let mut state = State::default();
        for (k, basis) in bases.iter().enumerate() {
            for (b, c) in basis.iter().zip(&self.coefficients[piece..]) {
                state.value[k] += b * c;
                state.rounding[k] += 2.0 * f64::EPSILON * (b * c).abs();
            }
        }
        let mut entry = 0;
        for k in 0..3 {
            for l in 0..=k {
                for (i, a) in bases[k].iter().enumerate() {
                    for (j, b) in bases[l].iter().enumerate() {
                        state.covariance[entry] += a * b * self.inverse.get(piece + i, piece + j);
                    }
                }
                entry += 1;
            }
        }
        state
    }
}
