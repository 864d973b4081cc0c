//! Length of means that a smoothed motion allows.

use std::f64::consts::PI;

use super::condensed::Condensed;
use super::problem::{MOST_NODES, Problem};
use super::rotation::Rotation;
use super::smoother::Smoothed;

/// Largest product of the time of a mean and the corner frequency of a smoother, rad: motion in that time is then below the noise.
const PHASE: f64 = 0.3;

/// Finds something by means of samples: by shorter ones until it allows those that it was found by. Returns it with the most samples
/// of these means.
pub(super) fn by_means<T>(
    samples: usize,
    of: impl Fn(usize) -> T,
    finer: impl Fn(&T) -> Option<usize>,
) -> (T, usize) {
    let mut most = samples.div_ceil(MOST_NODES);
    loop {
        let found = of(most);
        match finer(&found) {
            Some(shorter) => most = shorter,
            None => return (found, most),
        }
    }
}

impl Problem<'_> {
    /// Returns the most samples of a mean, if a smoothed motion may change by more than noise in the time of one, or has harmonics of
    /// which the next ones would be too short for the nodes; `kinematic` is smoothed at all of these.
    pub fn finer(&self, smoothed: &Smoothed, kinematic: &Smoothed) -> Option<usize> {
        let Condensed { blocks, .. } = self.condensed.as_ref()?;
        let Smoothed { noise, prior, .. } = smoothed;
        let of_time = PHASE / (blocks.time * noise.corner.max(noise.speed_corner));
        let of_angle = PI / (2.0 * prior.waves() * Rotation::of(kinematic.angles()).step);
        (of_time.min(of_angle) < 1.0).then(|| blocks.shorter(of_time, of_angle))
    }
}
