//! Small matrices of fixed size.

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

/// N numbers.
pub(in crate::inverse) type Vector<const N: usize> = [f64; N];

/// N rows of N numbers.
pub(in crate::inverse) type Matrix<const N: usize> = [[f64; N]; N];

/// Returns the matrix with these numbers on its diagonal.
pub(in crate::inverse) fn diagonal<const N: usize>(numbers: Vector<N>) -> Matrix<N> {
    let mut matrix = [[0.0; N]; N];
    for (k, number) in numbers.into_iter().enumerate() {
        matrix[k][k] = number;
    }
    matrix
}

/// Returns A P Aᵀ + Q, symmetric.
#[inline(always)]
pub(in crate::inverse) fn congruent<const N: usize>(
    a: &Matrix<N>,
    p: &Matrix<N>,
    q: &Matrix<N>,
) -> Matrix<N> {
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
pub(in crate::inverse) fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
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
pub(in crate::inverse) fn times<const N: usize>(a: &Matrix<N>, x: &Vector<N>) -> Vector<N> {
    std::array::from_fn(|i| dot(&a[i], x))
}

#[inline(always)]
pub(in crate::inverse) fn dot<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}

#[inline(always)]
pub(in crate::inverse) fn sum<const N: usize>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Returns Aᵀ.
#[inline(always)]
pub(in crate::inverse) fn transposed<const N: usize>(a: &Matrix<N>) -> Matrix<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// Returns the Cholesky factor L of P = L Lᵀ, with the rounding of P's diagonal added; a number that is known has a column of
/// zeros.
#[inline(always)]
fn roots<const N: usize>(p: &Matrix<N>) -> Matrix<N> {
    let mut root = [[0.0; N]; N];
    for j in 0..N {
        let rounding = f64::EPSILON * p[j][j];
        let mut pivot = p[j][j] + rounding;
        for k in 0..j {
            pivot -= root[j][k] * root[j][k];
        }
        let size = pivot.max(rounding);
        if size > 0.0 {
            root[j][j] = size.sqrt();
            let per = 1.0 / root[j][j];
            for i in j + 1..N {
                let mut left = p[i][j];
                for k in 0..j {
                    left -= root[i][k] * root[j][k];
                }
                root[i][j] = left * per;
            }
        }
    }
    root
}

/// Covariance of a state by more information.
pub(in crate::inverse) struct Informed<const N: usize> {
    pub covariance: Matrix<N>,
    /// Root of the determinant of I + P Y, up to its sign.
    pub root_determinant: f64,
}

/// Returns the covariance (P⁻¹ + Y)⁻¹ of a state with the covariance P by more information Y: L (I + BᵀB)⁻¹ Lᵀ with B = RᵀL for
/// P = L Lᵀ and Y = R Rᵀ. Householder reflections bring I above B to triangular form: the square of a diffuse B would leave
/// no digits.
#[inline(always)]
pub(in crate::inverse) fn informed<const N: usize>(
    p: &Matrix<N>,
    information: &Matrix<N>,
) -> Informed<N> {
    let mut part = transposed(&roots(p));
    // Columns of B.
    let mut rest = product(&part, &roots(information));
    let mut told = diagonal([1.0; N]);
    for j in 0..N {
        let column = rest[j];
        let square = dot(&column, &column);
        let size = (told[j][j] * told[j][j] + square).sqrt();
        let head = told[j][j] + size;
        let per = 2.0 / (head * head + square);
        for k in j + 1..N {
            let share = per * (head * told[j][k] + dot(&column, &rest[k]));
            told[j][k] -= share * head;
            for i in 0..N {
                rest[k][i] -= share * column[i];
            }
        }
        told[j][j] = -size;
    }
    let mut root_determinant = 1.0;
    for i in 0..N {
        root_determinant *= told[i][i];
        let per = 1.0 / told[i][i];
        for j in 0..N {
            for k in 0..i {
                part[i][j] -= told[k][i] * part[k][j];
            }
            part[i][j] *= per;
        }
    }
    Informed {
        covariance: product(&transposed(&part), &part),
        root_determinant,
    }
}
