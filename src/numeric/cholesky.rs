//! Cholesky factorization in blocks: nearly all of its work is products of matrices, at their speed.

use nalgebra::{Cholesky, DMatrix, Dyn};

/// Columns of a block, whose square takes 18 kB: half of a usual first cache.
const BLOCK: usize = 48;

/// Factorizes A = L Lᵀ, symmetric and given by its lower triangle; none where A is not positive definite.
pub(crate) fn cholesky(mut a: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let order = a.nrows();
    for first in (0..order).step_by(BLOCK) {
        let size = BLOCK.min(order - first);
        let (left, below) = (order - first, order - first - size);
        let (known, mut rest) = a.columns_range_pair_mut(..first, first..);
        let mut block = rest.view_mut((first, 0), (left, size));
        let beside = known.rows(first, size).transpose();
        block.gemm(-1.0, &known.rows(first, left), &beside, 1.0);
        let lower = Cholesky::new(block.rows(0, size).into_owned())?.l();
        block.rows_mut(0, size).copy_from(&lower);
        let inverse = inverse_of_block(&lower);
        let under = block.rows(size, below) * inverse.transpose();
        block.rows_mut(size, below).copy_from(&under);
    }
    Some(Cholesky::pack_dirty(a))
}

/// Returns the inverse of a lower triangular matrix, by halves.
pub(crate) fn inverse_of_lower(lower: &DMatrix<f64>) -> DMatrix<f64> {
    let order = lower.nrows();
    if order <= BLOCK {
        return inverse_of_block(lower);
    }
    let (first, rest) = (order / 2, order - order / 2);
    let square = |at: usize, size: usize| lower.view((at, at), (size, size)).into_owned();
    let above = inverse_of_lower(&square(0, first));
    let below = inverse_of_lower(&square(first, rest));
    let beside = &below * (lower.view((first, 0), (rest, first)) * &above);
    let mut inverse = DMatrix::zeros(order, order);
    inverse.view_mut((0, 0), (first, first)).copy_from(&above);
    inverse
        .view_mut((first, 0), (rest, first))
        .copy_from(&-beside);
    inverse
        .view_mut((first, first), (rest, rest))
        .copy_from(&below);
    inverse
}

/// Returns the inverse of a lower triangular matrix, column by column.
fn inverse_of_block(lower: &DMatrix<f64>) -> DMatrix<f64> {
    let order = lower.nrows();
    let mut inverse = DMatrix::identity(order, order);
    for (first, column) in inverse
        .as_mut_slice()
        .chunks_exact_mut(order.max(1))
        .enumerate()
    {
        for (k, factors) in lower
            .as_slice()
            .chunks_exact(order.max(1))
            .enumerate()
            .skip(first)
        {
            column[k] /= factors[k];
            let known = column[k];
            let pairs = column[k + 1..].iter_mut().zip(&factors[k + 1..]);
            pairs.for_each(|(value, factor)| *value -= factor * known);
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_times_its_transpose_is_the_matrix() {
        for order in [1, 47, 48, 49, 150] {
            let root = DMatrix::from_fn(order, order, |i, j| ((i * 31 + j * 17) as f64).sin());
            let matrix = &root * root.transpose() + DMatrix::identity(order, order);
            let lower = cholesky(matrix.clone()).expect("positive definite").l();
            let off = (&lower * lower.transpose() - &matrix).amax();
            assert!(off < 1e-13 * matrix.amax(), "{order}: {off}");
            let inverse = inverse_of_lower(&lower);
            let off = (inverse * lower - DMatrix::identity(order, order)).amax();
            assert!(off < 1e-11, "{order}: {off}");
            assert!(cholesky(matrix - DMatrix::identity(order, order) * 2.0).is_none());
        }
    }
}
