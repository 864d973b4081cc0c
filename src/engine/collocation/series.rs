//! Legendre series of the acceleration on a step.

use super::super::NODES;
use super::state::State;

/// Rounding of the accelerations of a step. They are those of rounded angles, and steep where the position
/// is near to a limit.
pub(super) fn rounding(state: &State, h: f64, coefficients: &[f64; NODES]) -> f64 {
    let size = coefficients.iter().map(|c| c.abs()).sum::<f64>();
    let variation = size - coefficients[0].abs();
    let travel = h * state.omega.abs() + 0.5 * h * h * size;
    let steepness = 2.0 * variation / travel.max(f64::MIN_POSITIVE);
    f64::EPSILON * (8.0 * size + 4.0 * (1.0 + state.theta.abs()) * steepness)
}

pub(super) fn dot(a: &[f64; NODES], b: &[f64; NODES]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A Legendre series at many places, by its recurrence.
pub fn legendre<const N: usize>(coefficients: &[f64; NODES], x: [f64; N]) -> [f64; N] {
    let (mut p, mut before) = ([1.0; N], [0.0; N]);
    let mut sum = [0.0; N];
    for (k, coefficient) in coefficients.iter().enumerate() {
        let n = k as f64;
        let (by_last, by_before) = ((2.0 * n + 1.0) / (n + 1.0), n / (n + 1.0));
        for i in 0..N {
            sum[i] += coefficient * p[i];
            (p[i], before[i]) = (by_last * x[i] * p[i] - by_before * before[i], p[i]);
        }
    }
    sum
}
