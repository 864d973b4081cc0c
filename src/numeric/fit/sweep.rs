//! Factorizations of A + sP for several strengths s side by side, of which only sums are kept: the steps of one wait for
//! each other.

use std::array;

use crate::numeric::banded::{Banded, DIAGONALS};

/// Rows after which the product of the pivots is taken for its logarithm.
const TOGETHER: usize = 4;

/// What a factorization of A + sP = L D Lᵀ tells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums {
    /// Logarithm of the determinant.
    pub log_determinant: f64,
    /// gᵀ (A + sP)⁻¹ g for a vector g = a + s b.
    pub square: f64,
}

/// A row of L, of which an entry k places before the diagonal is the k-th, and what L takes from a vector g there.
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    entries: [[f64; N]; DIAGONALS],
    per_pivot: [f64; N],
    taken: [f64; N],
}

/// The sums for each strength; not a number where the matrix is not positive definite.
pub(super) fn sums<const N: usize>(
    [matrix, penalty]: [&Banded; 2],
    [a, b]: [&[f64]; 2],
    strengths: &[f64; N],
) -> [Sums; N] {
    let zero = Row {
        entries: [[0.0; N]; DIAGONALS],
        per_pivot: [0.0; N],
        taken: [0.0; N],
    };
    // The last rows, each at its number modulo their count.
    let mut last = [zero; DIAGONALS];
    let (mut logarithms, mut squares, mut product) = ([0.0; N], [0.0; N], [1.0; N]);
    for i in 0..matrix.size() {
        let (of_matrix, of_penalty) = (matrix.row(i), penalty.row(i));
        let mut sum: [[f64; N]; DIAGONALS] = array::from_fn(|k| {
            array::from_fn(|lane| of_matrix[k] + strengths[lane] * of_penalty[k])
        });
        let mut entries = [[0.0; N]; DIAGONALS];
        let mut taken: [f64; N] = array::from_fn(|lane| a[i] + strengths[lane] * b[i]);
        // From the farthest column on; rows before the first one are zero.
        for k in (1..DIAGONALS).rev() {
            let above = &last[i.wrapping_sub(k) % DIAGONALS];
            for lane in 0..N {
                entries[k][lane] = sum[k][lane] * above.per_pivot[lane];
            }
            // Row i − k of L has its entries for the columns nearer to the diagonal in those after it.
            for nearer in 0..k {
                let other = &last[i.wrapping_sub(nearer) % DIAGONALS];
                let factor = if nearer == 0 {
                    &entries[k]
                } else {
                    &other.entries[k - nearer]
                };
                for lane in 0..N {
                    sum[nearer][lane] -= sum[k][lane] * factor[lane];
                }
            }
            for lane in 0..N {
                taken[lane] -= entries[k][lane] * above.taken[lane];
            }
        }
        let mut per_pivot = [0.0; N];
        for lane in 0..N {
            let pivot = if sum[0][lane] > 0.0 {
                sum[0][lane]
            } else {
                f64::NAN
            };
            per_pivot[lane] = 1.0 / pivot;
            squares[lane] += taken[lane] * taken[lane] * per_pivot[lane];
            product[lane] *= pivot;
        }
        if i % TOGETHER == TOGETHER - 1 {
            for lane in 0..N {
                logarithms[lane] += product[lane].ln();
                product[lane] = 1.0;
            }
        }
        last[i % DIAGONALS] = Row {
            entries,
            per_pivot,
            taken,
        };
    }
    array::from_fn(|lane| Sums {
        log_determinant: logarithms[lane] + product[lane].ln(),
        square: squares[lane],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::fit::roughness::penalty;

    /// As the factors themselves have them, and not a number where there is none.
    #[test]
    fn they_are_those_of_the_factors() {
        let size = 37;
        let mut matrix = Banded::new(size);
        for i in 0..size {
            for k in 0..DIAGONALS.min(i + 1) {
                let value = ((i * 7 + k * 3) % 5) as f64 / 4.0 - 0.5;
                matrix.add(i, i - k, if k == 0 { 9.0 } else { value });
            }
        }
        let (penalty, _) = penalty(size);
        let a: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let b: Vec<f64> = (0..size).map(|i| (2.0 * i as f64).cos()).collect();
        let strengths = [1e-6, 0.3, 1e4, -1.0];
        let found = sums([&matrix, &penalty], [&a, &b], &strengths);
        for (strength, found) in strengths.into_iter().zip(found).take(3) {
            let factor = matrix
                .plus(strength, &penalty)
                .cholesky()
                .expect("positive definite");
            let g: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + strength * b).collect();
            let square: f64 = factor.solve(&g).iter().zip(&g).map(|(x, g)| x * g).sum();
            assert!((found.square / square - 1.0).abs() < 1e-11);
            assert!((found.log_determinant / factor.log_determinant() - 1.0).abs() < 1e-12);
        }
        assert!(found[3].square.is_nan() && found[3].log_determinant.is_nan());
    }
}
