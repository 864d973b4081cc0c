//! How many terms the samples support.

use crate::numeric::real::Real;

/// Steps that are tried beyond the best one before it counts as the best.
const PATIENCE: usize = 8;

/// Information criterion of Akaike, corrected for small samples (Hurvich and Tsai, Biometrika 76 (1989) 297).
pub(super) fn criterion(n: f64, parameters: f64, squares: f64) -> f64 {
    let p = parameters + 1.0;
    if n - p - 1.0 <= 0.0 {
        return f64::INFINITY;
    }
    n * (squares / n).ln() + 2.0 * p * n / (n - p - 1.0)
}

/// The number of steps with the least criterion; `squares` has the sums of squared residuals for `first`,
/// `first` + `step`, ... parameters, none taken to be below what is left of noise whose sum of squares is `least`.
pub(super) fn best<T: Real>(
    rows: usize,
    first: usize,
    step: usize,
    squares: &[T],
    least: f64,
) -> usize {
    let value = |i: usize| {
        let parameters = first + step * i;
        let left = least * rows.saturating_sub(parameters) as f64 / rows as f64;
        let squares = squares[i].value().max(left);
        criterion(rows as f64, parameters as f64, squares)
    };
    (0..squares.len()).fold(0, |best, i| if value(i) < value(best) { i } else { best })
}

/// Whether more steps may be better still.
pub(super) fn undecided<T: Real>(
    rows: usize,
    first: usize,
    step: usize,
    squares: &[T],
    least: f64,
) -> bool {
    squares.len() <= best(rows, first, step, squares, least) + PATIENCE
}
