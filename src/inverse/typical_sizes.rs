//! Typical magnitudes along a record: root mean squares over at most 1000 of its nodes.

use super::grid::Path;
use super::model::prior::{Prior, powers_of};
use super::problem::Problem;
use super::quantised::Codes;
use super::scales::{Scales, root_mean_square};

impl Problem<'_> {
    /// Returns the root mean square of d measured/dθ along a path; a sample of the speed is one of the way in the mean time
    /// between samples, over that time.
    pub fn slope(&self, path: &Path) -> f64 {
        let stride = path.states.len().div_ceil(1000);
        let states = path.states.iter().step_by(stride);
        let sensor = self.record.sensor;
        let slopes = states.map(|state| sensor.shown([state[0], state[1]]).slope);
        let by_time = match sensor.is_of_speed() {
            true => self.spacing(),
            false => 1.0,
        };
        root_mean_square(slopes.filter(|slope| slope.is_finite())) / by_time
    }

    /// Returns the mean time between samples that count, s.
    fn spacing(&self) -> f64 {
        let times = &self.grid.times;
        (times[times.len() - 1] - times[0]) / (self.record.counted() - 1.0)
    }

    /// Returns the typical magnitudes along a path with a prior, for samples of a slope and a standard deviation σ.
    pub fn scales(&self, prior: Prior, path: &Path, slope: f64, sigma: f64) -> Scales {
        let (motion, times) = (self.motion(prior), &self.grid.times);
        let duration = times[times.len() - 1] - times[0];
        let stride = path.states.len().div_ceil(1000);
        let (mut lever, mut torque, mut count) = (0.0, 0.0, 0.0);
        for (node, state) in path.nodes().step_by(stride) {
            let rates = motion.rates(times[node], state);
            if rates.by_unknown.is_finite() {
                lever += rates.by_unknown * rates.by_unknown;
                torque += state[2] * state[2];
                count += 1.0;
            }
        }
        Scales {
            spacing: self.spacing(),
            samples: self.single().counted() / self.record.counted(),
            duration,
            slope,
            lever: (lever / count).sqrt(),
            // The start of the first prior is compared with others only once the motion is known.
            acceleration: 1.0,
            speed: path.speed(),
            powers: std::array::from_fn(|k| {
                let states = path.states.iter().step_by(stride);
                spread(states.map(|state| powers_of(state[1])[k]))
            }),
            torque: f64::sqrt(torque / count) / sigma,
            floor: self.record.floor,
            known: self.record.codes.map(Codes::spread),
            begins_at_angle: self.record.sensor.is_of_speed(),
            identified: None,
        }
    }
}

/// Returns the standard deviation of numbers, at least the smallest positive double.
fn spread(numbers: impl Iterator<Item = f64> + Clone) -> f64 {
    let (sum, count) = (numbers.clone()).fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
    let about = numbers.map(|x| x - sum / count);
    root_mean_square(about).max(f64::MIN_POSITIVE)
}
