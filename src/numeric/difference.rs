//! Numerical derivatives, where a search needs no more than their sign.

/// Derivative by the central difference of sixth order (Fornberg, Math. Comp. 51 (1988) 699, table 1). Its
/// rounding error is about ε f/step, its truncation error step⁶ f⁽⁷⁾/140.
pub fn slope(f: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
    let odd = |n: f64| f(at + n * step) - f(at - n * step);
    (45.0 * odd(1.0) - 9.0 * odd(2.0) + odd(3.0)) / (60.0 * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_six_are_exact() {
        let got = slope(|x| x.powi(6) - 3.0 * x.powi(5) + x, 0.7, 0.125);
        let want = 6.0 * 0.7f64.powi(5) - 15.0 * 0.7f64.powi(4) + 1.0;
        assert!((got - want).abs() < 1e-14, "{got} {want}");
    }
}
