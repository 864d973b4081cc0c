//! Polynomials that are orthonormal over given points and weights, and least squares with them.
//!
//! The three-term recurrence of Forsythe (J. SIAM 5 (1957) 74) makes the columns of Q in the QR
//! factorization of the matrix of powers, one after the other, in time and memory linear in the points.

use std::array::{from_mut, from_ref};

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
    let mut norm = now.iter().fold(zero, |sum, q| sum + *q * *q).root();
    for degree in 0..t.len() {
        if norm.value() == 0.0 {
            break;
        }
        let inverse = T::from(1.0) / norm;
        let mut sums = [[zero; LANES]; 2];
        let ((qs, last_qs), (ss, last_ss), (ys, last_ys)) =
            (now.as_chunks_mut(), s.as_chunks(), rest.as_chunks());
        for ((q, s), y) in qs.iter_mut().zip(ss).zip(ys) {
            project::<T, LANES>(q, s, y, inverse, &mut sums);
        }
        for ((q, s), y) in last_qs.iter_mut().zip(last_ss).zip(last_ys) {
            project(from_mut(q), from_ref(s), from_ref(y), inverse, &mut sums);
        }
        let [centre, coefficient] = sums.map(total);
        let by = [centre, coefficient, norm];
        let mut sums = [[zero; LANES]; 2];
        let ((qs, last_qs), (ps, last_ps), (ss, last_ss), (ys, last_ys)) = (
            now.as_chunks_mut(),
            before.as_chunks_mut(),
            s.as_chunks(),
            rest.as_chunks_mut(),
        );
        for (((q, p), s), y) in qs.iter_mut().zip(ps).zip(ss).zip(ys) {
            advance::<T, LANES>(q, p, s, y, by, &mut sums);
        }
        for (((q, p), s), y) in last_qs.iter_mut().zip(last_ps).zip(last_ss).zip(last_ys) {
            advance(
                from_mut(q),
                from_mut(p),
                from_ref(s),
                from_mut(y),
                by,
                &mut sums,
            );
        }
        let [square, next] = sums.map(total);
        fit.norms.push(norm);
        fit.centres.push(centre);
        fit.coefficients.push(coefficient);
        fit.squares.push(square);
        if degree + 1 == t.len() || !go_on(&fit.squares) {
            break;
        }
        norm = next.root();
    }
    fit
}

/// Sums that are formed side by side.
const LANES: usize = 4;

fn total<T: Real>([a, b, c, d]: [T; LANES]) -> T {
    (a + b) + (c + d)
}

/// Norms a polynomial, and adds to the sums of its centre and of its coefficient for what is left of the targets.
#[inline(always)]
fn project<T: Real, const N: usize>(
    q: &mut [T; N],
    s: &[T; N],
    rest: &[T; N],
    inverse: T,
    [centre, coefficient]: &mut [[T; LANES]; 2],
) {
    for k in 0..N {
        q[k] = q[k] * inverse;
        centre[k] = centre[k] + s[k] * (q[k] * q[k]);
        coefficient[k] = coefficient[k] + q[k] * rest[k];
    }
}

/// Takes a polynomial out of the targets, makes the next one, and adds to the sums of squares of both.
#[inline(always)]
fn advance<T: Real, const N: usize>(
    q: &mut [T; N],
    before: &mut [T; N],
    s: &[T; N],
    rest: &mut [T; N],
    [centre, coefficient, norm]: [T; 3],
    [left, next]: &mut [[T; LANES]; 2],
) {
    for k in 0..N {
        rest[k] = rest[k] - coefficient * q[k];
        left[k] = left[k] + rest[k] * rest[k];
        let following = (s[k] - centre) * q[k] - norm * before[k];
        before[k] = q[k];
        q[k] = following;
        next[k] = next[k] + following * following;
    }
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
