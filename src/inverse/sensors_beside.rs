//! Fusion of several sensors of one motion: each has its own measurement equation and noise, and all samples of a time
//! enter one filter by their information about the crank angle, Σ h′²/σ².

use super::motion_estimate::MotionEstimate;
use super::problem::Problem;
use super::record::SensorBeside;
use super::residual_tests::Whiteness;
use super::result::summary::SensorSummary;
use super::smoother::Smoothed;

/// Number of rounds that alternate between noise and path.
const SENSOR_ROUNDS: usize = 4;

/// Least fraction of the squared residuals that is noise, where the uncertainty of the path itself may explain them.
const LEAST_NOISE: f64 = 0.1;

impl Problem<'_> {
    /// Smooths the motion by all sensors, from the motion by the record's own: the variance of each is that of its
    /// residuals over their redundancy, the part not absorbed by the path (Förstner 1979).
    pub fn by_all_sensors(&mut self, mut smoothed: Smoothed) -> Smoothed {
        if self.record.beside.is_empty() {
            return smoothed;
        }
        for _ in 0..SENSOR_ROUNDS {
            let mut beside = self.record.beside.clone();
            for other in &mut beside {
                (other.sigma, other.mean) = self.noise_beside(other, &smoothed);
            }
            self.record.beside = beside;
            smoothed = self.kinematic(smoothed.path(), smoothed.noise.sigma);
        }
        smoothed
    }

    /// Returns the standard deviation of a sensor's samples about a smoothed motion, and their mean residual, rad or m.
    fn noise_beside(&self, other: &SensorBeside<'_>, smoothed: &Smoothed) -> (f64, f64) {
        let (mut squares, mut sum, mut free, mut of_path, mut count) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut largest = 0.0f64;
        for (t, value) in self.record.times.iter().zip(other.values.iter()) {
            let estimate = self.at(smoothed, *t);
            let (residual, shown) = other.sensor.residual(*value, estimate.turning());
            let spread = other.sensor.variance(&shown, &estimate.covariance);
            if residual.is_finite() && spread.is_finite() {
                squares += residual * residual;
                sum += residual;
                of_path += spread;
                free += 1.0 - (spread / (other.sigma * other.sigma)).min(1.0);
                count += 1.0;
                largest = largest.max(value.abs());
            }
        }
        let variance = match other.sigma.is_finite() {
            true => squares / f64::max(free, 1.0),
            false => (squares - of_path).max(LEAST_NOISE * squares) / f64::max(count, 1.0),
        };
        let least = 4.0 * f64::EPSILON * largest;
        (variance.sqrt().max(least), sum / f64::max(count, 1.0))
    }
}

impl SensorBeside<'_> {
    /// Summarises what it shows beside the motion at its samples.
    pub fn summary(&self, motion: &[MotionEstimate]) -> SensorSummary {
        let pairs = self.values.iter().zip(motion);
        let residuals =
            pairs.map(|(value, at)| self.sensor.residual(*value, at.turning()).0 - self.mean);
        let residuals = residuals.filter(|residual| !residual.is_nan());
        SensorSummary {
            column: self.sensor.measured.name(),
            sigma: self.sigma,
            mean_residual: self.mean,
            residual_ljung_box: Whiteness::of(residuals).ljung_box,
        }
    }
}
