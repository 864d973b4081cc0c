//! Polynomials that are orthonormal over given points and weights, and least squares with them.
//!
//! The three-term recurrence of Forsythe (J. SIAM 5 (1957) 74) makes the columns of Q in the QR
//! factorization of the matrix of powers, one after the other, in time and memory linear in the points.

use super::real::Real;

/// Coefficients over orthonormal polynomials q_j of s = (t − middle)/half:
/// norm_{j+1} q_{j+1} = (s − centre_j) q_j − norm_j q_{j−1}, q_0 = 1/norm_0.
#[derive(Clone, Debug)]
pub struct Expansion<T> {
    /// Middle of the points.
    pub middle: f64,
    /// Half of their span.
    pub half: f64,
    /// Centres of the recurrence.
    pub centres: Vec<T>,
    /// Norms of the recurrence.
    pub norms: Vec<T>,
    /// Coefficients of the least-squares solution, degree by degree.
    pub coefficients: Vec<T>,
    /// Sum of squared residuals with all coefficients up to each degree.
    pub squares: Vec<T>,
}

/// Least squares with rows `weight`·p(t) = `target`, degree by degree from 0 until `go_on`, which sees the
/// sums of squared residuals so far, says no, or the points are used up.
pub fn fit<T: Real>(
    t: &[f64],
    target: &[f64],
    weight: Option<&[f64]>,
    mut go_on: impl FnMut(&[T]) -> bool,
) -> Expansion<T> {
    let (first, last) = (t[0], t[t.len() - 1]);
    let middle = 0.5 * first + 0.5 * last;
    let half = (0.5 * last - 0.5 * first).max(f64::MIN_POSITIVE);
    let zero = T::from(0.0);
    let scaled = |t: f64| (T::from(t) - T::from(middle)) / T::from(half);
    let s: Vec<T> = t.iter().map(|t| scaled(*t)).collect();
    let mut rest: Vec<T> = target.iter().map(|y| T::from(*y)).collect();
    let mut before = vec![zero; t.len()];
    let mut now: Vec<T> = match weight {
        Some(weight) => weight.iter().map(|w| T::from(*w)).collect(),
        None => vec![T::from(1.0); t.len()],
    };
    let mut fit = Expansion {
        middle,
        half,
        centres: Vec::new(),
        norms: Vec::new(),
        coefficients: Vec::new(),
        squares: Vec::new(),
    };
    let mut norm = sum(&now, |q| *q * *q).root();
    for degree in 0..t.len() {
        if norm.value() == 0.0 {
            break;
        }
        let inverse = T::from(1.0) / norm;
        let (mut centre, mut coefficient) = (zero, zero);
        for ((q, s), y) in now.iter_mut().zip(&s).zip(&rest) {
            *q = *q * inverse;
            centre = centre + *s * (*q * *q);
            coefficient = coefficient + *q * *y;
        }
        let mut square = zero;
        for (q, y) in now.iter().zip(&mut rest) {
            *y = *y - coefficient * *q;
            square = square + *y * *y;
        }
        fit.norms.push(norm);
        fit.centres.push(centre);
        fit.coefficients.push(coefficient);
        fit.squares.push(square);
        if degree + 1 == t.len() || !go_on(&fit.squares) {
            break;
        }
        let mut square = zero;
        for ((q, p), s) in now.iter_mut().zip(&mut before).zip(&s) {
            let next = (*s - centre) * *q - norm * *p;
            *p = *q;
            *q = next;
            square = square + next * next;
        }
        norm = square.root();
    }
    fit
}

fn sum<T: Real>(values: &[T], f: impl Fn(&T) -> T) -> T {
    values.iter().fold(T::from(0.0), |sum, v| sum + f(v))
}

impl<T> Expansion<T> {
    /// Leaves out all beyond a degree.
    pub fn truncate(&mut self, degree: usize) {
        for list in [
            &mut self.centres,
            &mut self.norms,
            &mut self.coefficients,
            &mut self.squares,
        ] {
            list.truncate(degree + 1);
        }
    }
}
