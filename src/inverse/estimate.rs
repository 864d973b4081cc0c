//! Smoothed motion at nodes and at times, with its covariance.

use super::measurement_model::Turning;
use super::model::prior::State;
use super::motion_estimate::MotionEstimate;
use super::problem::Problem;
use super::smoother::Smoothed;
use crate::numeric::parallel;

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

    /// Returns crank angle and speed.
    pub fn turning(&self) -> Turning {
        [self.state[0], self.state[1]]
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

impl Problem<'_> {
    /// Returns the smoothed motion at times, with what its steps leave out of the equation.
    pub fn motion_at(&self, smoothed: &Smoothed, times: &[f64]) -> Vec<MotionEstimate> {
        let left = self.left_out(smoothed);
        parallel::list(times.len(), |i| {
            let step = self.grid.before(times[i]);
            // A node has the errors of the steps on both sides.
            let beside = left.iter().skip(step.saturating_sub(1)).take(3);
            let mut motion = self.at(smoothed, times[i]).estimated();
            motion.numerical[2] += beside.fold(0.0, |most: f64, left| most.max(*left));
            motion
        })
    }

    /// Returns the number of parameters that a smoothed motion is worth, the trace of its hat matrix; `motion` at the samples,
    /// or at those that intervals or means stand for.
    pub fn parameters(&self, smoothed: &Smoothed, motion: &[MotionEstimate]) -> f64 {
        let record = &self.record;
        let motion = match motion.len() == record.times.len() {
            true => motion,
            false => &self.motion_at(smoothed, &record.times)[..],
        };
        let shares = parallel::list(motion.len(), |i| {
            let shown = record.sensor.shown(motion[i].turning());
            let variance = record.sensor.variance(&shown, &motion[i].covariance);
            record.weights[i] * variance / smoothed.noise.sigma.powi(2)
        });
        shares.iter().filter(|share| share.is_finite()).sum()
    }

    /// Returns the acceleration, rad/s², that would make up for what each step leaves out of angle and speed, if the samples are
    /// computed; others have more noise.
    fn left_out(&self, smoothed: &Smoothed) -> Vec<f64> {
        if !self.is_computed() {
            return Vec::new();
        }
        let motion = self.motion(smoothed.prior);
        let torque = smoothed.repeating.as_ref();
        parallel::list(self.grid.len() - 1, |k| {
            let [a, b] = [k, k + 1]
                .map(|k| motion.node(self.grid.times[k], &smoothed.estimates[k].state, torque));
            let [theta, omega] = motion.left_out(&a, &b, torque).map(f64::abs);
            let h = b.t - a.t;
            omega / h + 2.0 * theta / (h * h)
        })
    }
}
