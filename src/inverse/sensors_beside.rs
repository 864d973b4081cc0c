//! Several sensors of one motion: each has a measurement equation and a noise of its own, and all samples of a time enter the
//! same filter by their information about the crank angle, Σ h′²/σ².

use super::problem::Problem;
use super::smoother::Smoothed;

/// Rounds in which noise and path find each other.
const SENSOR_ROUNDS: usize = 4;

/// Part of the squares of residuals that is noise at least, where the path itself may have made them.
const LEAST_NOISE: f64 = 0.1;

impl Problem<'_> {
    /// A smoothed motion by all sensors, from that by the record's own: the noise of each is that of its residuals, over the part
    /// that the path has not taken (Förstner 1979).
    pub fn by_all_sensors(&mut self, mut smoothed: Smoothed) -> Smoothed {
        if self.record.beside.is_empty() {
            return smoothed;
        }
        for _ in 0..SENSOR_ROUNDS {
            let noises: Vec<[f64; 2]> = (0..self.record.beside.len())
                .map(|k| self.noise_beside(k, &smoothed))
                .collect();
            for (other, [sigma, mean]) in self.record.beside.iter_mut().zip(noises) {
                (other.sigma, other.mean) = (sigma, mean);
            }
            let sigma = smoothed.noise.sigma;
            smoothed = self.kinematic(smoothed.path(true), sigma);
        }
        smoothed
    }

    /// Standard deviation of a sensor's samples about a smoothed motion, and the mean of their residuals.
    fn noise_beside(&self, which: usize, smoothed: &Smoothed) -> [f64; 2] {
        let other = &self.record.beside[which];
        let (mut squares, mut sum, mut free, mut of_path, mut count) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut largest = 0.0f64;
        for (t, value) in self.record.times.iter().zip(other.values.iter()) {
            let estimate = self.at(smoothed, *t);
            let (residual, shown) = other.sensor.residual(*value, estimate.state[0]);
            let spread = shown.slope * shown.slope * estimate.covariance[0];
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
        [variance.sqrt().max(least), sum / f64::max(count, 1.0)]
    }
}
