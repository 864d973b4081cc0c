//! Error-free transformations: sums and products with their rounding errors.

/// Rounding error of a sum of some dozen terms that cancel, relative to the largest.
pub const SUM_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Returns a + b as a rounded sum and its rounding error (Knuth, TAOCP vol. 2, 4.2.2, theorem B).
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// Returns a·b as a rounded product and its rounding error.
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

/// Returns a + b + c with one rounding at the end, also where the terms cancel.
pub fn sum3(a: f64, b: f64, c: f64) -> f64 {
    let (ab, error_ab) = two_sum(a, b);
    let (abc, error_abc) = two_sum(ab, c);
    abc + (error_ab + error_abc)
}
