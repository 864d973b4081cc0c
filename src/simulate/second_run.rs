//! Tolerances and error margin of the second run of an error estimate.

/// Least tail of a series, as part of its largest coefficient: below it rounding hides the decay of the coefficients.
pub(super) const LEAST_TAIL: f64 = 4e-15;
/// Largest tolerance of a second run by collocation. Below it rounding inside the steps dominates: a tenth of it takes up
/// to four times as many evaluations for equal stated errors.
const TIGHT: f64 = 1e-14;
/// Ratio of the tolerances of both runs, for a loose joint and where collocation does not reach the end.
pub(super) const TIGHTER: f64 = 50.0;
/// Least ratio of the tolerances of both runs, near rounding.
const LEAST_RATIO: f64 = 5.0;
/// Least tolerance of a second run by the method of the first, unless [`LEAST_RATIO`] asks for less: below it rounding
/// inside the steps would make them collapse.
const TIGHT_AGAIN: f64 = 1e-13;
/// Factor from the distance of two runs to the stated error, for the error of the second run.
pub(super) const MARGIN: f64 = 1.5;

/// Returns the tolerance of a second run by collocation, with negligible error.
pub(super) fn collocation_tolerance(tolerance: f64) -> f64 {
    TIGHT.min(tolerance / LEAST_RATIO)
}

/// Returns the tolerance of a second run by the method of the first.
pub(super) fn same_method_tolerance(tolerance: f64) -> f64 {
    (tolerance / TIGHTER).max(TIGHT_AGAIN.min(tolerance / LEAST_RATIO))
}
