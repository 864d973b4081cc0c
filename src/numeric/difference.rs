//! Numerical derivatives by central differences, for searches that need only their sign.

/// Returns the derivative by the central difference of sixth order (Fornberg, Math. Comp. 51 (1988) 699, table 1). The
/// rounding error is about ε f/step, the truncation error step⁶ f⁽⁷⁾/140.
pub fn slope(f: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
    let odd = |n: f64| f(at + n * step) - f(at - n * step);
    (45.0 * odd(1.0) - 9.0 * odd(2.0) + odd(3.0)) / (60.0 * step)
}
