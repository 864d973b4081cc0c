//! Rotation of the crank along a motion.

use std::f64::consts::TAU;

/// Rotation of the crank along a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation {
    /// Turns from one end to the other, without sign.
    pub turns: f64,
    /// Times that the crank passes an angle of those it is at, in the mean: the turns of one that turns on, and more in a swing.
    pub passes: f64,
    /// Rotation from node to node, rad, its mean over the angle.
    pub step: f64,
}

impl Rotation {
    /// Along the crank angles, rad, of nodes.
    pub fn of(angles: impl Iterator<Item = f64> + Clone) -> Rotation {
        let steps = angles
            .clone()
            .zip(angles.clone().skip(1))
            .map(|(from, to)| to - from);
        let (net, way, squares) = steps.fold((0.0, 0.0, 0.0), |(net, way, squares), step| {
            (net + step, way + step.abs(), squares + step * step)
        });
        let least = angles.clone().fold(f64::INFINITY, f64::min);
        let most = angles.fold(f64::NEG_INFINITY, f64::max);
        Rotation {
            turns: f64::abs(net) / TAU,
            passes: way / f64::min(most - least, TAU),
            step: squares / way,
        }
    }
}
