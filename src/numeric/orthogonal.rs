//! Least squares by polynomials that are orthonormal over given points and weights.
//!
//! The three-term recurrence of Forsythe (J. SIAM 5 (1957) 74) generates the columns of Q in the QR factorization of
//! the matrix of powers, one after the other, in time and memory linear in the points.

use super::double_double::Real;
use super::{LANES, median, parallel};

/// Expansion in orthonormal polynomials q_j of s = (t − middle)/half:
/// norm_{j+1} q_{j+1} = (s − centre_j) q_j − norm_j q_{j−1}, q_0 = 1/norm_0.
#[derive(Clone, Debug)]
pub struct Expansion<T> {
    /// Middle of the points.
    pub middle: f64,
    /// Half of the span of the points.
    pub half: f64,
    /// Terms of degree 0, 1, ...
    pub terms: Vec<Term<T>>,
}

/// Term of an expansion.
#[derive(Clone, Copy, Debug)]
pub struct Term<T> {
    /// Centre in the recurrence.
    pub centre: T,
    /// Norm in the recurrence.
    pub norm: T,
    /// Coefficient of the least-squares solution.
    pub coefficient: T,
    /// Sum of squared residuals with all coefficients up to this one.
    pub squares: T,
}

/// Solves least squares with rows `weight`·p(t) = `target`, up to the degree `most` or that of the points.
pub fn fit<T: Real>(
    t: &[f64],
    target: &[f64],
    weight: Option<&[f64]>,
    most: usize,
) -> Expansion<T> {
    let (first, last) = median::range(t);
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
    let mut terms = Vec::new();
    let mut norm = now.iter().fold(zero, |sum, q| sum + *q * *q).root();
    // Points that a thread takes at a time.
    let size = 1 << 14;
    for _ in 0..t.len().min(most + 1) {
        if norm.value() == 0.0 {
            break;
        }
        let inverse = T::from(1.0) / norm;
        let pieces = now.chunks_mut(size).zip(s.chunks(size));
        let pieces = pieces.zip(rest.chunks(size));
        let [centre, coefficient] = summed(pieces, |((q, s), rest)| project(q, s, rest, inverse));
        let by = [centre, coefficient, norm];
        let pieces = now.chunks_mut(size).zip(before.chunks_mut(size));
        let pieces = pieces.zip(s.chunks(size)).zip(rest.chunks_mut(size));
        let [squares, next] = summed(pieces, |(((q, p), s), rest)| advance(q, p, s, rest, by));
        terms.push(Term {
            centre,
            norm,
            coefficient,
            squares,
        });
        norm = next.root();
    }
    Expansion {
        middle,
        half,
        terms,
    }
}

/// Returns two sums over pieces.
fn summed<T: Real, P: Send>(
    mut pieces: impl ExactSizeIterator<Item = P>,
    sums: impl Fn(P) -> [T; 2] + Sync,
) -> [T; 2] {
    if pieces.len() == 1
        && let Some(piece) = pieces.next()
    {
        return sums(piece);
    }
    let parts = parallel::map(pieces, sums);
    let add = |[a, b]: [T; 2], [c, d]: [T; 2]| [a + c, b + d];
    parts.into_iter().fold([T::from(0.0); 2], add)
}

fn total<T: Real>([a, b, c, d]: [T; LANES]) -> T {
    (a + b) + (c + d)
}

/// Normalises a polynomial; returns its centre, and its coefficient for the remainder of the targets.
fn project<T: Real>(q: &mut [T], s: &[T], rest: &[T], inverse: T) -> [T; 2] {
    let mut sums = [[T::from(0.0); LANES]; 2];
    let [centre, coefficient] = &mut sums;
    let mut one = |k: usize, q: &mut T, s: T, y: T| {
        *q = *q * inverse;
        centre[k] = centre[k] + s * (*q * *q);
        coefficient[k] = coefficient[k] + *q * y;
    };
    let ((qs, last_q), (ss, last_s)) = (q.as_chunks_mut::<LANES>(), s.as_chunks::<LANES>());
    let (ys, last_y) = rest.as_chunks::<LANES>();
    for ((q, s), y) in qs.iter_mut().zip(ss).zip(ys) {
        for k in 0..LANES {
            one(k, &mut q[k], s[k], y[k]);
        }
    }
    for ((q, s), y) in last_q.iter_mut().zip(last_s).zip(last_y) {
        one(0, q, *s, *y);
    }
    sums.map(total)
}

/// Subtracts a polynomial from the targets and generates the next one; returns the sums of squares of both.
fn advance<T: Real>(
    q: &mut [T],
    before: &mut [T],
    s: &[T],
    rest: &mut [T],
    [centre, coefficient, norm]: [T; 3],
) -> [T; 2] {
    let mut sums = [[T::from(0.0); LANES]; 2];
    let [left, next] = &mut sums;
    let mut one = |k: usize, q: &mut T, before: &mut T, s: T, y: &mut T| {
        *y = *y - coefficient * *q;
        left[k] = left[k] + *y * *y;
        let following = (s - centre) * *q - norm * *before;
        *before = *q;
        *q = following;
        next[k] = next[k] + following * following;
    };
    let (qs, last_q) = q.as_chunks_mut::<LANES>();
    let (ps, last_p) = before.as_chunks_mut::<LANES>();
    let (ss, last_s) = s.as_chunks::<LANES>();
    let (ys, last_y) = rest.as_chunks_mut::<LANES>();
    for (((q, p), s), y) in qs.iter_mut().zip(ps).zip(ss).zip(ys) {
        for k in 0..LANES {
            one(k, &mut q[k], &mut p[k], s[k], &mut y[k]);
        }
    }
    for (((q, p), s), y) in last_q.iter_mut().zip(last_p).zip(last_s).zip(last_y) {
        one(0, q, p, *s, y);
    }
    sums.map(total)
}

impl<T: Copy> Expansion<T> {
    /// Converts the terms up to a degree to another number type.
    pub fn convert<S>(&self, degree: usize, number: impl Fn(T) -> S) -> Expansion<S> {
        let terms = self.terms.iter().take(degree + 1).map(|term| Term {
            centre: number(term.centre),
            norm: number(term.norm),
            coefficient: number(term.coefficient),
            squares: number(term.squares),
        });
        Expansion {
            middle: self.middle,
            half: self.half,
            terms: terms.collect(),
        }
    }
}
