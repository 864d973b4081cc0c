//! Factorizations of A + sP for several strengths s side by side, of which only sums are kept: the steps of one wait for
//! each other.

use std::array;

use super::roughness::Penalty;
use crate::numeric::banded::{Banded, DIAGONALS};

/// Rows after which the product of the pivots is taken for its logarithm.
const TOGETHER: usize = 4;

/// What a factorization of A + sP = L D Lᵀ tells.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Factored {
    /// Logarithm of the determinant.
    pub log_determinant: f64,
    /// gᵀ (A + sP)⁻¹ g for a vector g = a + s b.
    pub square: f64,
}

/// A row of A + sP from the diagonal on and the entry of g there, less what the rows before it take.
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    entries: [[f64; N]; DIAGONALS],
    right: [f64; N],
}

/// The sums for each strength; not a number where the matrix is not positive definite.
pub(super) fn sums<const N: usize>(
    matrix: &Banded,
    penalty: &Penalty,
    [a, b]: [&[f64]; 2],
    strengths: &[f64; N],
) -> [Factored; N] {
    let zero = Row {
        entries: [[0.0; N]; DIAGONALS],
        right: [0.0; N],
    };
    let given = |i: usize| {
        if i >= matrix.size() {
            return zero;
        }
        let (of_matrix, of_penalty) = (matrix.row(i), penalty.row(i));
        Row {
            entries: array::from_fn(|k| strengths.map(|s| of_matrix[k] + s * of_penalty[k])),
            right: strengths.map(|s| a[i] + s * b[i]),
        }
    };
    // The next rows, each at its number modulo their count.
    let mut next: [Row<N>; DIAGONALS] = array::from_fn(given);
    let (mut logarithms, mut squares, mut product) = ([0.0; N], [0.0; N], [1.0; N]);
    for i in 0..matrix.size() {
        let row = next[i % DIAGONALS];
        next[i % DIAGONALS] = given(i + DIAGONALS);
        let pivot = row.entries[0].map(|pivot| if pivot > 0.0 { pivot } else { f64::NAN });
        let per_pivot = pivot.map(|pivot| 1.0 / pivot);
        for k in 1..DIAGONALS {
            let below = &mut next[(i + k) % DIAGONALS];
            let factor: [f64; N] = array::from_fn(|lane| row.entries[k][lane] * per_pivot[lane]);
            let entries = below.entries.iter_mut().zip(&row.entries[k..]);
            entries.for_each(|(entries, of)| take(entries, &factor, of));
            take(&mut below.right, &factor, &row.right);
        }
        for lane in 0..N {
            squares[lane] += row.right[lane] * row.right[lane] * per_pivot[lane];
            product[lane] *= pivot[lane];
        }
        if i % TOGETHER == TOGETHER - 1 {
            for lane in 0..N {
                logarithms[lane] += product[lane].ln();
                product[lane] = 1.0;
            }
        }
    }
    array::from_fn(|lane| Factored {
        log_determinant: logarithms[lane] + product[lane].ln(),
        square: squares[lane],
    })
}

/// Takes products from numbers, side by side.
#[inline(always)]
fn take<const N: usize>(from: &mut [f64; N], factor: &[f64; N], of: &[f64; N]) {
    for ((from, factor), of) in from.iter_mut().zip(factor).zip(of) {
        *from -= factor * of;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::banded::Factors;

    /// As the factors themselves have them, and not a number where there is none.
    #[test]
    fn they_are_those_of_the_factors() {
        let size = 37;
        let mut matrix = Banded::new(size);
        for i in 0..size {
            for k in 0..DIAGONALS.min(size - i) {
                let value = ((i * 7 + k * 3) % 5) as f64 / 4.0 - 0.5;
                matrix.add(i, i + k, if k == 0 { 9.0 } else { value });
            }
        }
        let penalty = Penalty::new(size);
        let a: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let b: Vec<f64> = (0..size).map(|i| (2.0 * i as f64).cos()).collect();
        let strengths = [1e-6, 0.3, 1e4, -1.0];
        let found = sums(&matrix, &penalty, [&a, &b], &strengths);
        for (strength, found) in strengths.into_iter().zip(found).take(3) {
            let factor = Factors::of(matrix.plus(strength, |i| penalty.row(i)));
            let factor = factor.expect("positive definite");
            let g: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + strength * b).collect();
            let square: f64 = factor.solve(&g).iter().zip(&g).map(|(x, g)| x * g).sum();
            assert!((found.square / square - 1.0).abs() < 1e-11);
            assert!((found.log_determinant / factor.log_determinant() - 1.0).abs() < 1e-12);
        }
        assert!(found[3].square.is_nan() && found[3].log_determinant.is_nan());
    }
}
