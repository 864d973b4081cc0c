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
