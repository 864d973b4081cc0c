//! Smoothed motion at a node, with its covariance.

use super::motion_estimate::MotionEstimate;
use super::prior::State;

/// Smoothed motion at a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Estimate {
    pub state: State,
    /// Crank acceleration θ̈, rad/s².
    pub alpha: f64,
    /// Covariance of θ, ω, θ̈: 00, 01, 11, 02, 12, 22.
    pub covariance: [f64; 6],
    /// Prediction error of the samples of the node over its standard deviation; NaN without samples.
    pub innovation: f64,
}

impl Estimate {
    /// Returns θ (rad), ω (rad/s), θ̈ (rad/s²).
    pub fn motion(&self) -> [f64; 3] {
        [self.state[0], self.state[1], self.alpha]
    }

    /// Returns the motion with covariance and numerical errors.
    pub fn estimated(&self) -> MotionEstimate {
        MotionEstimate {
            value: self.motion(),
            covariance: self.covariance,
            numerical: [f64::EPSILON * self.state[0].abs(), 0.0, 0.0],
        }
    }
}
