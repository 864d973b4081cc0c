//! Sums that keep what rounding would lose.

/// a + b as a rounded sum and its rounding error (Knuth, TAOCP vol. 2, 4.2.2, theorem B).
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// a·b as a rounded product and its rounding error.
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

/// a + b + c with one rounding at the end, also where the terms cancel.
pub fn sum3(a: f64, b: f64, c: f64) -> f64 {
    let (ab, error_ab) = two_sum(a, b);
    let (abc, error_abc) = two_sum(ab, c);
    abc + (error_ab + error_abc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancelling_terms_leave_the_exact_rest() {
        assert_eq!(sum3(1.0, 1e-17, -1.0), 1e-17);
        assert_eq!(sum3(0.15, -0.1, -0.05), 0.15 - 0.1 - 0.05);
    }
}
