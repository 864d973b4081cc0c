//! Small matrices of fixed size.

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

/// N numbers.
pub(super) type Vector<const N: usize> = [f64; N];

/// N rows of N numbers.
pub(super) type Matrix<const N: usize> = [[f64; N]; N];

/// Returns the matrix with these numbers on its diagonal.
pub(super) fn diagonal<const N: usize>(numbers: Vector<N>) -> Matrix<N> {
    let mut matrix = [[0.0; N]; N];
    for (k, number) in numbers.into_iter().enumerate() {
        matrix[k][k] = number;
    }
    matrix
}

/// Returns A P Aᵀ + Q, symmetric.
#[inline(always)]
pub(super) fn congruent<const N: usize>(a: &Matrix<N>, p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let half = product(a, p);
    let mut whole = *q;
    for i in 0..N {
        for j in 0..=i {
            whole[i][j] += dot(&half[i], &a[j]);
            whole[j][i] = whole[i][j];
        }
    }
    whole
}

/// Returns A B.
#[inline(always)]
pub(super) fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let mut whole = [[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            for j in 0..N {
                whole[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    whole
}

/// Returns A x.
#[inline(always)]
pub(super) fn times<const N: usize>(a: &Matrix<N>, x: &Vector<N>) -> Vector<N> {
    std::array::from_fn(|i| dot(&a[i], x))
}

#[inline(always)]
pub(super) fn dot<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}

#[inline(always)]
pub(super) fn sum<const N: usize>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Returns Q P⁻¹ for a covariance P and a symmetric Q, by Cholesky factors of P, scaled to a unit diagonal to which its
/// rounding is added.
#[inline(always)]
pub(super) fn shares<const N: usize>(p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let scale: Vector<N> = std::array::from_fn(|k| 1.0 / p[k][k].sqrt());
    // L below the diagonal, and 1/L on it.
    let mut factor = [[0.0; N]; N];
    for j in 0..N {
        let mut pivot = 1.0 + f64::EPSILON;
        for k in 0..j {
            pivot -= factor[j][k] * factor[j][k];
        }
        let pivot = if pivot <= 0.0 { f64::EPSILON } else { pivot };
        let per = 1.0 / pivot.sqrt();
        factor[j][j] = per;
        for i in j + 1..N {
            let mut left = scale[i] * scale[j] * p[i][j];
            for k in 0..j {
                left -= factor[i][k] * factor[j][k];
            }
            factor[i][j] = left * per;
        }
    }
    let solved = |row: &Vector<N>| {
        let mut x: Vector<N> = std::array::from_fn(|k| row[k] * scale[k]);
        for i in 0..N {
            for k in 0..i {
                x[i] -= factor[i][k] * x[k];
            }
            x[i] *= factor[i][i];
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                x[i] -= factor[k][i] * x[k];
            }
            x[i] *= factor[i][i];
        }
        std::array::from_fn(|k| x[k] * scale[k])
    };
    let mut whole = [[0.0; N]; N];
    for i in 0..N {
        whole[i] = solved(&q[i]);
    }
    whole
}
