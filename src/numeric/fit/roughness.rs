//! The roughness of a spline: sums of squares of differences of its coefficients.

use std::array;
use std::ops::RangeInclusive;

use crate::numeric::banded::DIAGONALS;

/// Order of the differences that are kept small.
pub(super) const ORDER: usize = 6;

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

/// Differences of coefficients.
fn differences(coefficients: &[f64]) -> impl Iterator<Item = f64> {
    let difference = difference();
    let windows = coefficients.windows(ORDER + 1);
    windows.map(move |w| w.iter().zip(difference).map(|(c, d)| c * d).sum())
}

/// Sum of squares of the differences of coefficients.
pub(super) fn roughness(coefficients: &[f64]) -> f64 {
    differences(coefficients).map(|d| d * d).sum()
}

/// DᵀD times coefficients, from the differences themselves: rounding then stays in the range of Dᵀ, where a strong
/// penalty damps it.
pub(super) fn pull(coefficients: &[f64]) -> Vec<f64> {
    let weights = difference();
    let mut pull = vec![0.0; coefficients.len()];
    for (i, value) in differences(coefficients).enumerate() {
        for (pull, weight) in pull[i..].iter_mut().zip(weights) {
            *pull += weight * value;
        }
    }
    pull
}

/// DᵀD for differences of `ORDER` of so many coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Penalty {
    size: usize,
    /// A row far from both ends.
    inner: [f64; DIAGONALS],
}

impl Penalty {
    pub fn new(size: usize) -> Penalty {
        Penalty {
            size,
            inner: products(0..=ORDER),
        }
    }

    /// Row i from the diagonal on.
    #[inline(always)]
    pub fn row(&self, i: usize) -> [f64; DIAGONALS] {
        if i >= ORDER && i + ORDER < self.size {
            return self.inner;
        }
        // Differences begin at the first coefficient, and end at the last.
        products((i + ORDER + 1).saturating_sub(self.size)..=i.min(ORDER))
    }

    /// Logarithm of the determinant of DDᵀ: that of the symmetric Toeplitz matrix of the symbol (2 − 2 cos)^ORDER, but for
    /// a constant factor (Böttcher and Silbermann, Integral Equations Oper. Theory 9 (1986) 1; for order 1 it is the size
    /// plus 1).
    pub fn log_determinant(&self) -> f64 {
        let rows = (self.size - ORDER) as f64;
        let pairs = (0..ORDER).flat_map(|i| (0..ORDER).map(move |j| i + j));
        pairs.map(|k| (rows + 1.0 + k as f64).ln()).sum()
    }
}

/// Sums of the products of weights of differences, of which a coefficient has these places, with those so many places on.
fn products(places: RangeInclusive<usize>) -> [f64; DIAGONALS] {
    let difference = difference();
    array::from_fn(|k| {
        let pairs = places.clone().filter(|place| place + k <= ORDER);
        pairs
            .map(|place| difference[place] * difference[place + k])
            .sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::banded::Banded;

    /// The matrix times coefficients is what differences of differences give, at the ends too.
    #[test]
    fn the_penalty_is_that_of_the_differences() {
        for size in [8, 11, 20] {
            let penalty = Penalty::new(size);
            let matrix: Banded = (0..size).map(|i| penalty.row(i)).collect();
            let x: Vec<f64> = (0..size).map(|i| (1.7 * i as f64).sin()).collect();
            let pairs = matrix.times(&x).into_iter().zip(pull(&x));
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-11));
        }
    }
}
