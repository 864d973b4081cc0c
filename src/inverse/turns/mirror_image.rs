//! Mirror image of a crank motion at the line from pivot to slider pin: a second motion with the same slider positions.

use std::f64::consts::TAU;

use super::branch_tracking::CrankAngles;

/// Difference of crank angle at which two motions are distinct, rad.
pub(in crate::inverse) const DISTINCT_ROTATION: f64 = 0.5;

/// Motion with its mirror image.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct Imaged<'a> {
    pub angles: CrankAngles<'a>,
    pub image: CrankAngles<'a>,
    /// First sample at which the image leaves the branch of the scene.
    pub leaves: Option<usize>,
}

impl<'a> Imaged<'a> {
    /// Adds the mirror image of a motion.
    pub fn new(motion: CrankAngles<'a>) -> Imaged<'a> {
        let linkage = motion.sensor.linkage;
        let image = |theta: &f64| 2.0 * (-linkage.e).atan2(linkage.pose(*theta).x) - theta;
        // The image begins within half a turn of angle 0, as the motions do.
        let turns = (motion.theta.first().map_or(0.0, image) / TAU).round() * TAU;
        let angles = motion.theta.iter().map(|theta| image(theta) - turns);
        let theta: Vec<f64> = angles.collect();
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
pub(in crate::inverse) fn fork(a: &CrankAngles<'_>, b: &CrankAngles<'_>) -> Option<usize> {
    let off = |k: usize| a.theta[k] - b.theta[k];
    let turns = (off(0) / TAU).round() * TAU;
    (0..a.theta.len()).find(|k| (off(*k) - turns).abs() > DISTINCT_ROTATION)
}

/// Returns the first sample at which a motion is more than `DISTINCT_ROTATION` from where it begins.
pub(in crate::inverse) fn departure(motion: &CrankAngles<'_>) -> Option<usize> {
    let begin = motion.theta[0];
    let far = |theta: &f64| (theta - begin).abs() > DISTINCT_ROTATION;
    motion.theta.iter().position(far)
}
