//! Extremes of a mechanism over its offset: a scene with each of several offsets, in closed form.

use serde::Serialize;

use super::closed_form::{Located, kinematics};
use super::forces::{StrokeTorque, forces};
use crate::error::Error;
use crate::scene::Scene;

/// Extremes of a mechanism with one offset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OffsetExtremes {
    /// Offset, m.
    pub offset_m: f64,
    /// Stroke, m.
    pub stroke_m: f64,
    /// Outward over inward stroke; none if the crank cannot turn fully.
    pub time_ratio: Option<f64>,
    /// Largest slider acceleration, m/s²; m/rad² without a speed.
    pub acceleration_max: Option<Located>,
    /// Smallest slider acceleration, m/s²; m/rad² without a speed.
    pub acceleration_min: Option<Located>,
    /// Extremes of the driving torque on the outward stroke, N m; none without a speed.
    pub outward: Option<StrokeTorque>,
    /// Extremes of the driving torque on the inward stroke, N m; none without a speed.
    pub inward: Option<StrokeTorque>,
}

/// Computes the extremes of a scene with each of some offsets (m).
///
/// # Errors
/// The errors of [`kinematics`] and [`forces`].
pub fn offset_extremes(scene: &Scene, offsets: &[f64]) -> Result<Vec<OffsetExtremes>, Error> {
    let of = |offset: &f64| {
        let scene = scene.clone().offset(*offset);
        let motion = kinematics(&scene)?;
        let moves = scene.motion.speed != 0.0;
        let forces = moves.then(|| forces(&scene)).transpose()?;
        Ok(OffsetExtremes {
            offset_m: *offset,
            stroke_m: motion.stroke_m,
            time_ratio: motion.time_ratio,
            acceleration_max: motion.acceleration_max,
            acceleration_min: motion.acceleration_min,
            outward: forces.as_ref().and_then(|forces| forces.outward),
            inward: forces.as_ref().and_then(|forces| forces.inward),
        })
    };
    offsets.iter().map(of).collect()
}
