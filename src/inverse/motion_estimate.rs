//! Crank angle, speed and acceleration at one time with their covariance.

use super::measurement_model::Turning;

/// θ (rad), ω (rad/s) and θ̈ (rad/s²) with their errors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MotionEstimate {
    pub value: [f64; 3],
    /// Covariance, rows of the lower triangle.
    pub covariance: [f64; 6],
    /// Bounds of the numerical errors of the three values.
    pub numerical: [f64; 3],
}

impl MotionEstimate {
    /// Returns the standard error of a linear combination of the three, with their numerical errors and `more` rounding.
    pub fn error(&self, gradient: &[f64; 3], more: f64) -> f64 {
        let parts = gradient.iter().zip(&self.numerical);
        let rounding: f64 = parts.map(|(g, r)| (g * r).abs()).sum();
        let rounding =
            DEVIATION_PER_BOUND * DEVIATION_PER_BOUND * (rounding * rounding + more * more);
        (quadratic(&self.covariance, gradient) + rounding).sqrt()
    }

    /// Returns crank angle and speed.
    pub fn turning(&self) -> Turning {
        [self.value[0], self.value[1]]
    }

    /// Returns the standard error of the crank angle, rad.
    pub fn angle_error(&self) -> f64 {
        self.error(&[1.0, 0.0, 0.0], 0.0)
    }

    /// Returns the motion with the error of a time scale whose relative standard error is `part`.
    pub fn stretched(self, part: f64) -> MotionEstimate {
        let [_, first, second] = self.value;
        self.widened([0.0, part * first, 2.0 * part * second])
    }

    /// Returns the motion with the band that it has where another one has this part of the probability.
    pub fn beside(mut self, other: MotionEstimate, part: f64) -> MotionEstimate {
        let other = other.about(self.value);
        let pairs = self.covariance.iter_mut().zip(other.covariance);
        pairs.for_each(|(own, other)| *own += part * (other - *own));
        self
    }

    /// Returns the motion with the mean squares of its deviations from these values in place of its covariance.
    pub fn about(self, values: [f64; 3]) -> MotionEstimate {
        let off = std::array::from_fn(|k| self.value[k] - values[k]);
        self.widened(off)
    }

    /// Returns the motion with an error that all three have in common.
    fn widened(mut self, off: [f64; 3]) -> MotionEstimate {
        let mut entry = 0;
        for k in 0..3 {
            for l in 0..=k {
                self.covariance[entry] += off[k] * off[l];
                entry += 1;
            }
        }
        self
    }
}

/// Standard deviation of a rounding error over its bound: roundings of many terms seldom add up.
const DEVIATION_PER_BOUND: f64 = 0.5;

/// Returns gᵀ S g, at least 0, for a symmetric matrix given by its lower triangle.
fn quadratic(matrix: &[f64; 6], gradient: &[f64; 3]) -> f64 {
    let [aa, ba, bb, ca, cb, cc] = *matrix;
    let [a, b, c] = *gradient;
    let sum =
        a * (a * aa + 2.0 * b * ba) + b * (b * bb + 2.0 * c * cb) + c * (c * cc + 2.0 * a * ca);
    sum.max(0.0)
}
