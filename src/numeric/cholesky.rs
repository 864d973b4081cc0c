//! Cholesky factorization in blocks: nearly all of its work is products of matrices, at their speed.

use nalgebra::{Cholesky, DMatrix, Dyn};

/// Factorizes A = L Lᵀ, symmetric and given by its lower triangle; none where A is not positive definite.
pub(crate) fn cholesky(mut a: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let order = a.nrows();
    let columns = 48;
    for first in (0..order).step_by(columns) {
        let size = columns.min(order - first);
        let (left, below) = (order - first, order - first - size);
        let (known, mut rest) = a.columns_range_pair_mut(..first, first..);
        let mut block = rest.view_mut((first, 0), (left, size));
        let beside = known.rows(first, size).transpose();
        block.gemm(-1.0, &known.rows(first, left), &beside, 1.0);
        let lower = Cholesky::new(block.rows(0, size).into_owned())?.l();
        block.rows_mut(0, size).copy_from(&lower);
        let inverse = lower.solve_lower_triangular(&DMatrix::identity(size, size))?;
        let under = block.rows(size, below) * inverse.transpose();
        block.rows_mut(size, below).copy_from(&under);
    }
    Some(Cholesky::pack_dirty(a))
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
            assert!(cholesky(matrix - DMatrix::identity(order, order) * 2.0).is_none());
        }
    }
}
