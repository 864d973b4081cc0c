//! Several sensors of one motion: each has a measurement equation and a noise of its own, and all samples of a time enter the
//! same filter by their information about the crank angle, Σ h′²/σ².

use std::borrow::Cow;

use super::measurement_model::Sensor;
use super::problem::Problem;
use super::record::{Grid, Piece, Record};
use super::smoother::Smoothed;
use super::state_space::Observed;

/// A sensor beside that of the record, with a value at each of its times.
#[derive(Clone, Debug)]
pub(super) struct SensorBeside<'a> {
    pub sensor: Sensor<'a>,
    /// rad or m
    pub values: Cow<'a, [f64]>,
    /// Standard deviation of a sample, rad or m; infinite as long as it is not known.
    pub sigma: f64,
    /// Mean of the residuals, rad or m.
    pub mean: f64,
}

/// Rounds in which noise and path find each other.
const ROUNDS: usize = 4;

/// Part of the squares of residuals that is noise at least, where the path itself may have made them.
const LEAST: f64 = 0.1;

impl Record<'_> {
    /// What all sensors show at a node, in terms of the crank angle, with Σ w h′² and Σ w h′ r of the record's own.
    pub fn observed_by_all(
        &self,
        [mut information, mut sum]: [f64; 2],
        grid: &Grid,
        path: &Piece<'_>,
        node: usize,
        sigma: f64,
    ) -> Observed {
        for i in grid.first[node]..grid.first[node + 1] {
            let theta = self.angle(grid, path, node, i);
            for other in &self.beside {
                let (residual, shown) = other.sensor.residual(other.values[i], theta);
                let variance = path.variances.map_or(0.0, |list| list[node - path.first]);
                let bent = 0.5 * shown.curvature * variance / other.sigma;
                let weight = (sigma / other.sigma).powi(2) / (1.0 + 2.0 * bent * bent);
                if weight > 0.0 && residual.is_finite() && shown.slope.is_finite() {
                    information += weight * shown.slope * shown.slope;
                    sum += weight * shown.slope * residual;
                }
            }
        }
        match information > 0.0 {
            true => Observed {
                residual: sum / information,
                slope: 1.0,
                variance: 1.0 / information,
            },
            false => Observed {
                variance: f64::INFINITY,
                ..Observed::default()
            },
        }
    }
}

impl Problem<'_> {
    /// A smoothed motion by all sensors, from that by the record's own: the noise of each is that of its residuals, over the part
    /// that the path has not taken (Förstner 1979).
    pub fn by_all_sensors(&mut self, mut smoothed: Smoothed) -> Smoothed {
        if self.record.beside.is_empty() {
            return smoothed;
        }
        for _ in 0..ROUNDS {
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
            false => (squares - of_path).max(LEAST * squares) / f64::max(count, 1.0),
        };
        let least = 4.0 * f64::EPSILON * largest;
        [variance.sqrt().max(least), sum / f64::max(count, 1.0)]
    }
}
