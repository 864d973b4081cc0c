//! Curves fitted to samples by least squares, with their derivatives and what is known of their errors.

mod choice;
mod condensed;
mod covariance;
mod curve;
mod decay;
mod dense;
mod dependent;
mod design;
mod differences;
mod enough;
mod fourier;
mod gram;
mod likely;
mod outstanding;
mod penalized;
mod pieces;
mod polynomial;
mod refinement;
mod rotation;
mod roughness;
mod smoothest;
mod spline;
mod spread;
mod sums;
mod support;
mod sweep;
mod told;
mod triangle;
mod turn;

pub use crate::numeric::powers::Powers;
pub use condensed::Rows;
pub use curve::{Curve, Kind};
pub use dependent::Dependent;
pub use fourier::Fourier;
pub use polynomial::Polynomial;
pub use spline::Spline;

use crate::numeric::chebyshev::largest;
use crate::numeric::parallel;

/// Rows `weight`·y(t) = `target` of a least-squares problem; t rises strictly.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    /// Arguments.
    pub t: &'a [f64],
    /// Right-hand sides.
    pub target: &'a [f64],
    /// Weights; none: all 1.
    pub weight: Option<&'a [f64]>,
    /// Standard deviation of a target that is due to its digits alone.
    pub floor: f64,
}

/// Units of rounding to which targets that were computed are right.
const COMPUTED: f64 = 2.0;

/// Samples whose products are formed at a time.
const TOGETHER: usize = 1 << 14;

impl Samples<'_> {
    /// Standard deviation of targets that were computed: a computed motion goes on with the errors of its largest values.
    fn computed(&self) -> f64 {
        COMPUTED * f64::EPSILON * largest(self.target)
    }

    /// What a curve of these values leaves of the targets.
    pub fn left(&self, values: &[f64]) -> Vec<f64> {
        let weight = |i: usize| self.weight.map_or(1.0, |weight| weight[i]);
        parallel::list(values.len(), |i| self.target[i] - weight(i) * values[i])
    }

    /// Products of the terms of a curve, which are given for an argument one after the other with their numbers, with lists
    /// of errors of the targets.
    fn products(
        &self,
        size: usize,
        errors: &[Vec<f64>],
        terms: impl Fn(f64, &mut dyn FnMut(usize, f64)) + Sync,
    ) -> Vec<Vec<f64>> {
        let rows = self.t.len();
        let starts = (0..rows).step_by(TOGETHER);
        let parts = parallel::map(starts, |start| {
            let mut products = vec![vec![0.0; size]; errors.len()];
            for i in start..(start + TOGETHER).min(rows) {
                let weight = self.weight.map_or(1.0, |weight| weight[i]);
                terms(self.t[i], &mut |term, value| {
                    for (products, error) in products.iter_mut().zip(errors) {
                        products[term] += weight * value * error[i];
                    }
                });
            }
            products
        });
        let mut sums = vec![vec![0.0; size]; errors.len()];
        for part in parts {
            let pairs = sums.iter_mut().flatten().zip(part.iter().flatten());
            pairs.for_each(|(sum, product)| *sum += product);
        }
        sums
    }
}

/// How many terms a fit has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// As many as the samples support.
    Auto,
    /// Degree of the polynomial, number of harmonics.
    Fixed(usize),
}

/// Value, first and second derivative of a fitted curve at one argument.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// The curve and its derivatives.
    pub value: [f64; 3],
    /// What rounding may have done to them.
    pub rounding: [f64; 3],
    /// Covariance of the three, for samples of unit variance: rows of the lower triangle.
    pub covariance: [f64; 6],
    /// Mean products of what terms that are left out, and errors of samples that depend on each other, may add to the
    /// three, in the same order.
    pub bias: [f64; 6],
}

impl State {
    /// Variance of a combination of the three, for samples of unit variance.
    pub fn variance(&self, gradient: &[f64; 3]) -> f64 {
        quadratic(&self.covariance, gradient)
    }

    /// Square of what terms that are left out, and errors that depend on each other, may add to a combination of the
    /// three.
    pub fn bias_of(&self, gradient: &[f64; 3]) -> f64 {
        quadratic(&self.bias, gradient)
    }

    /// This curve with another as what is wrong with it, instead of what may be left out; the other one is as it is for
    /// samples of this standard deviation. Where its value and derivatives cancel, this part of each is left.
    pub fn wrong_by(mut self, other: &State, sigma: f64, left: f64) -> State {
        self.bias = other.bias;
        add_products(&mut self.bias, &other.value, 1.0);
        for (bias, covariance) in self.bias.iter_mut().zip(other.covariance) {
            *bias += sigma * sigma * covariance;
        }
        for (entry, value) in DIAGONAL.into_iter().zip(other.value) {
            self.bias[entry] += (left * value).powi(2);
        }
        self
    }

    /// This curve where it and its derivatives may be off by these amounts together.
    pub fn off_by(mut self, amounts: &[f64; 3]) -> State {
        add_products(&mut self.bias, amounts, 1.0);
        self
    }

    /// This curve where its arguments may be stretched by such a part.
    pub fn stretched(self, part: f64) -> State {
        let [_, first, second] = self.value;
        self.off_by(&[0.0, part * first, 2.0 * part * second])
    }

    /// What rounding may have done to a combination of the three.
    pub fn rounding_of(&self, gradient: &[f64; 3]) -> f64 {
        let parts = gradient.iter().zip(&self.rounding);
        parts.map(|(g, r)| (g * r).abs()).sum()
    }
}

/// Where a lower triangle has the squares.
const DIAGONAL: [usize; 3] = [0, 2, 5];

/// gᵀ S g for a symmetric matrix given by its lower triangle.
fn quadratic(matrix: &[f64; 6], gradient: &[f64; 3]) -> f64 {
    let [aa, ba, bb, ca, cb, cc] = *matrix;
    let [a, b, c] = *gradient;
    let sum =
        a * (a * aa + 2.0 * b * ba) + b * (b * bb + 2.0 * c * cb) + c * (c * cc + 2.0 * a * ca);
    sum.max(0.0)
}

/// Adds the products of a vector with itself to a lower triangle.
fn add_products(matrix: &mut [f64; 6], vector: &[f64; 3], factor: f64) {
    let mut entry = 0;
    for k in 0..3 {
        for l in 0..=k {
            matrix[entry] += factor * vector[k] * vector[l];
            entry += 1;
        }
    }
}

/// What a fit leaves of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Sum of squared residuals.
    pub squares: f64,
    /// Number of parameters, or what they are worth under a penalty.
    pub parameters: f64,
    /// Estimated standard deviation of a target, at least that of its digits.
    pub sigma: f64,
    /// That of its digits.
    pub floor: f64,
}

/// The most rows for which polynomials are fitted in double-double arithmetic.
const MOST_IN_DOUBLE: usize = 100_000;
