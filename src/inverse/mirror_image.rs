//! Mirror image of a crank motion at the line from pivot to slider pin: a second motion with the same slider positions.

use std::f64::consts::TAU;

use super::branch_tracking::{CrankAngles, DISTINCT_ROTATION};

/// Motion with its mirror image.
#[derive(Clone, Debug)]
pub(super) struct Imaged<'a> {
    pub angles: CrankAngles<'a>,
    pub image: CrankAngles<'a>,
    /// First sample at which the image leaves the branch of the scene.
    pub leaves: Option<usize>,
}

impl<'a> Imaged<'a> {
    /// Adds the mirror image of a motion.
    pub fn new(motion: CrankAngles<'a>) -> Imaged<'a> {
        let linkage = motion.sensor.linkage;
        let mut theta: Vec<f64> = Vec::with_capacity(motion.theta.len());
        for angle in &motion.theta {
            let x = linkage.pose(*angle).x;
            let there = 2.0 * (-linkage.e).atan2(x) - angle;
            let last = theta.last().map_or(0.0, |last| *last);
            theta.push(there + ((last - there) / TAU).round() * TAU);
        }
        // Half of the digits are lost at a limit.
        let is_there = |k: usize| {
            let [pose, image] = [motion.theta[k], theta[k]].map(|theta| linkage.pose(theta).x);
            (pose - image).abs() < f64::EPSILON.sqrt() * linkage.r
        };
        let leaves = (0..theta.len()).find(|k| !is_there(*k));
        Imaged {
            image: CrankAngles {
                theta,
                ..motion.clone()
            },
            angles: motion,
            leaves,
        }
    }
}

/// Returns the first sample at which two motions are more than `DISTINCT_ROTATION` apart.
pub(super) fn fork(a: &CrankAngles<'_>, b: &CrankAngles<'_>) -> Option<usize> {
    let off = |k: usize| a.theta[k] - b.theta[k];
    let turns = (off(0) / TAU).round() * TAU;
    (0..a.theta.len()).find(|k| (off(*k) - turns).abs() > DISTINCT_ROTATION)
}
