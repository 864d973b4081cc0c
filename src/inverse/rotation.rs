//! Rotation of the crank along a motion.

use std::f64::consts::TAU;

/// Rotation of the crank along a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation {
    /// Turns from one end to the other, without sign.
    pub turns: f64,
    /// Rotation from node to node, rad, its mean over the angle.
    pub step: f64,
}

impl Rotation {
    /// Along the crank angles, rad, of nodes.
    pub fn of(angles: impl Iterator<Item = f64> + Clone) -> Rotation {
        let steps = angles
            .clone()
            .zip(angles.skip(1))
            .map(|(from, to)| to - from);
        let (net, way, squares) = steps.fold((0.0, 0.0, 0.0), |(net, way, squares), step| {
            (net + step, way + step.abs(), squares + step * step)
        });
        Rotation {
            turns: f64::abs(net) / TAU,
            step: squares / way,
        }
    }
}
