//! Sums over rows for B-splines: one pass for the normal matrix and the residuals of coefficients that are near.

use std::ops::Range;

use super::condensed::Rows;
use super::pieces::{Grid, basis};
use crate::numeric::banded::{Banded, DIAGONALS};

/// Sums over some of the samples, for coefficients from `first` on.
#[derive(Debug)]
pub(super) struct Sums {
    first: usize,
    pub matrix: Banded,
    /// Squares of the residuals.
    pub squares: f64,
    /// Products of the splines with the residuals.
    pub right: Vec<f64>,
}

impl Sums {
    /// Over a range of rows, with residuals from `coefficients`; the matrix only if `MATRIX`.
    fn of<const MATRIX: bool>(
        samples: &Rows<'_>,
        grid: &Grid,
        range: Range<usize>,
        coefficients: &[f64],
    ) -> Sums {
        let touched = grid.touched(samples, &range);
        let mut sums = Sums {
            first: touched.start,
            matrix: Banded::new(if MATRIX { touched.len() } else { 0 }),
            squares: 0.0,
            right: vec![0.0; touched.len()],
        };
        for (t, weight, target) in samples.some(range) {
            let (piece, u) = grid.place(t);
            let b = basis(u);
            let part = &coefficients[piece..piece + DIAGONALS];
            let value: f64 = b.iter().zip(part).map(|(b, c)| b * c).sum();
            let residual = target - weight * value;
            sums.squares += residual * residual;
            let from = piece - sums.first;
            let right = &mut sums.right[from..from + DIAGONALS];
            for (right, b) in right.iter_mut().zip(b) {
                *right += weight * b * residual;
            }
            if MATRIX {
                sums.matrix.add_products(from, weight * weight, &b);
            }
        }
        sums
    }

    /// Over all rows.
    pub fn all<const MATRIX: bool>(samples: &Rows<'_>, grid: &Grid, coefficients: &[f64]) -> Sums {
        let parts =
            samples.parts(|range| Some(Sums::of::<MATRIX>(samples, grid, range, coefficients)));
        let mut all = Sums {
            first: 0,
            matrix: Banded::new(if MATRIX { grid.size() } else { 0 }),
            squares: samples.left,
            right: vec![0.0; grid.size()],
        };
        for part in parts.into_iter().flatten() {
            if MATRIX {
                all.matrix.add_from(part.first, &part.matrix);
            }
            all.squares += part.squares;
            let sums = all.right[part.first..].iter_mut().zip(part.right);
            sums.for_each(|(sum, r)| *sum += r);
        }
        all
    }
}
