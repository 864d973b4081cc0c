//! QR factorization of a tall matrix, some rows at a time: memory does not grow with the rows.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

/// Part of the square of a column below which products do not tell what others leave of it.
const SINGULAR: f64 = 1e-10;

/// What others are to leave of the square of a column, of which only harmonics are as large as the first one: one that is
/// small at all samples is not told.
fn least(column: usize, square: f64, first: f64) -> f64 {
    SINGULAR
        * if column < 2 {
            square
        } else {
            square.max(first)
        }
}

/// The triangle R of A = QR, with Qᵀ times the right-hand side.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    size: usize,
    /// Rows of A and b that are not in the triangle yet, below the triangle.
    rows: DMatrix<f64>,
    filled: usize,
}

impl Triangle {
    /// For a matrix of this many columns.
    pub fn new(size: usize) -> Triangle {
        let width = size + 1;
        Triangle {
            size,
            rows: DMatrix::zeros(width + (4 * width).max(64), width),
            filled: width,
        }
    }

    /// Takes a row of the matrix and its right-hand side.
    pub fn add(&mut self, row: impl Iterator<Item = f64>, right: f64) {
        for (column, value) in row.enumerate() {
            self.rows[(self.filled, column)] = value;
        }
        self.rows[(self.filled, self.size)] = right;
        self.filled += 1;
        if self.filled == self.rows.nrows() {
            self.reduce();
        }
    }

    /// From the products of the columns of matrix and right-hand side, with as many columns, from the first on, as these
    /// tell apart.
    pub fn of_gram(gram: &DMatrix<f64>) -> Triangle {
        let size = gram.nrows() - 1;
        let mut triangle = Triangle::new(size);
        let r = &mut triangle.rows;
        for j in 0..=size {
            for i in 0..=j {
                let known: f64 = (0..i).map(|k| r[(k, i)] * r[(k, j)]).sum();
                let rest = gram[(i, j)] - known;
                r[(i, j)] = if i < j {
                    rest / r[(i, i)]
                } else if j < size
                    && (rest.is_nan() || rest <= least(j, gram[(j, j)], gram[(0, 0)]))
                {
                    return Triangle::of_gram(&without(gram, j..size));
                } else {
                    rest.max(0.0).sqrt()
                };
            }
        }
        triangle
    }

    /// Number of columns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// With as many columns, from the first on, as are told apart.
    pub fn told(mut self) -> Triangle {
        self.reduce();
        let r = &self.rows;
        let is_told = |j: &usize| {
            let square = r.view((0, *j), (j + 1, 1)).norm_squared();
            r[(*j, *j)].powi(2) > least(*j, square, r[(0, 0)].powi(2))
        };
        let size = (0..self.size).take_while(is_told).count();
        let mut told = Triangle::new(size);
        let corner = (size, size);
        told.rows
            .view_mut((0, 0), corner)
            .copy_from(&r.view((0, 0), corner));
        let right = r.column(self.size);
        told.rows
            .view_mut((0, size), (size, 1))
            .copy_from(&right.rows(0, size));
        told.rows[corner] = right.rows(size, self.size + 1 - size).norm();
        told
    }

    fn reduce(&mut self) {
        let (rows, width) = self.rows.shape();
        let r = std::mem::replace(&mut self.rows, DMatrix::zeros(0, 0))
            .qr()
            .unpack_r();
        self.rows = DMatrix::zeros(rows, width);
        self.rows.rows_mut(0, width).copy_from(&r);
        self.filled = width;
    }

    /// The least-squares solution; none for a singular matrix.
    pub fn solve(&mut self) -> Option<Vec<f64>> {
        let n = self.size;
        if self.filled > n + 1 {
            self.reduce();
        }
        let triangle = self.rows.view((0, 0), (n, n));
        let solution = triangle.solve_upper_triangular(&self.rows.view((0, n), (n, 1)))?;
        Some(solution.iter().copied().collect())
    }

    /// Sums of squared residuals with the first 0, 1, 2, ... columns alone, where the right-hand side is what the columns with
    /// these coefficients leave.
    pub fn squares(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.size + 1];
        let mut sum = 0.0;
        for i in (0..=self.size).rev() {
            let known = coefficients.iter().enumerate().skip(i);
            let known: f64 = known.map(|(j, c)| self.rows[(i, j)] * c).sum();
            sum += (self.rows[(i, self.size)] + known).powi(2);
            sums[i] = sum;
        }
        sums
    }

    /// Covariance of the solution for a right-hand side of unit variance, (RᵀR)⁻¹; not numbers for a singular matrix.
    pub fn covariance(&self) -> DMatrix<f64> {
        let n = self.size;
        let triangle = self.rows.view((0, 0), (n, n)).upper_triangle();
        let inverse = triangle.solve_upper_triangular(&DMatrix::identity(n, n));
        let inverse = inverse.unwrap_or_else(|| DMatrix::from_element(n, n, f64::NAN));
        &inverse * inverse.transpose()
    }

    /// Solves RᵀR x = b.
    pub fn normal_solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.size;
        let triangle = self.rows.view((0, 0), (n, n));
        let mut x = DVector::from_column_slice(b);
        // A singular triangle was refused when the parameters were found.
        let regular = triangle.tr_solve_upper_triangular_mut(&mut x)
            && triangle.solve_upper_triangular_mut(&mut x);
        debug_assert!(regular, "a singular triangle");
        x.iter().copied().collect()
    }

    /// Standard errors of the solution for a right-hand side of unit variance, and the condition number in the
    /// Frobenius norm.
    pub fn errors(&self) -> (Vec<f64>, f64) {
        let n = self.size;
        let triangle = self.rows.view((0, 0), (n, n)).upper_triangle();
        let Some(inverse) = triangle.solve_upper_triangular(&DMatrix::identity(n, n)) else {
            return (vec![f64::NAN; n], f64::INFINITY);
        };
        let errors = inverse.row_iter().map(|row| row.norm()).collect();
        (errors, triangle.norm() * inverse.norm())
    }
}

/// Products of columns without some of them.
fn without(gram: &DMatrix<f64>, columns: Range<usize>) -> DMatrix<f64> {
    let (from, count) = (columns.start, columns.len());
    gram.clone()
        .remove_rows(from, count)
        .remove_columns(from, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of three columns and their sum, from rows and from products: the sum is not told, and the squares stay.
    #[test]
    fn columns_that_depend_on_others_are_not_told() {
        let row = |i: usize| {
            let [a, b, c] = [1.0, i as f64, (i * i % 7) as f64];
            [a, b, c, a + b + c, (i * 5 % 11) as f64]
        };
        let mut of_rows = Triangle::new(4);
        let mut gram = DMatrix::zeros(5, 5);
        for i in 0..100 {
            let row = row(i);
            of_rows.add(row[..4].iter().copied(), row[4]);
            let row = DVector::from_column_slice(&row);
            gram += &row * row.transpose();
        }
        let [of_rows, of_gram] = [of_rows.told(), Triangle::of_gram(&gram)];
        assert_eq!([of_rows.size(), of_gram.size()], [3, 3]);
        let right = (0..100).map(|i| row(i)[4].powi(2)).sum::<f64>();
        let pairs = of_rows.squares(&[]).into_iter().zip(of_gram.squares(&[]));
        assert!(pairs.into_iter().all(|(a, b)| (a / b - 1.0).abs() < 1e-9));
        assert!((of_rows.squares(&[])[0] / right - 1.0).abs() < 1e-12);
    }
}
