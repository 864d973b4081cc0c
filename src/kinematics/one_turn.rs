//! One turn, or the cycle of the loads: kinematics of a scene with forces, sensitivities, and the effect of changed
//! lengths, as far as asked for.

use serde::Serialize;

use super::closed_form::{Kinematics, KinematicsRow, kinematics};
use super::diagrams::Diagrams;
use super::forces::{ForceAnalysis, ForceRow, forces};
use crate::error::Error;
use crate::mechanism::{Length, TorqueSlope};
use crate::numeric::angle;
use crate::scene::{LARGEST_VALUE, Scene};

/// Largest number of rows of a turn: more, from an angle between rows of less than 6e-8 rad, are an error of its unit.
pub const MOST_ROWS_OF_TURN: f64 = 1e8;

/// Quantities to compute beside the kinematics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TurnOptions {
    /// Forces at the scene's speed.
    pub forces: bool,
    /// Diagrams of the forces, with a counterweight for this part of the reciprocating mass.
    pub balance: Option<f64>,
    /// Derivatives with respect to crank, rod and offset.
    pub sensitivity: bool,
    /// Lengths (m) of a second mechanism, which is compared with the first.
    pub change: Vec<(Length, f64)>,
}

/// One turn of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct OneTurn {
    /// Closed-form kinematics.
    #[serde(flatten)]
    pub kinematics: Kinematics,
    /// Forces at constant speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forces: Option<ForceAnalysis>,
    /// Diagrams of the forces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diagrams: Option<Diagrams>,
    /// Kinematics of the mechanism with changed lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub changed: Option<Kinematics>,
    /// Whether rows have derivatives with respect to the lengths.
    #[serde(skip)]
    pub has_slopes: bool,
    /// Derivatives of the driving torque; none if not asked for or not known.
    #[serde(skip)]
    torque_slope: Option<TorqueSlope>,
}

/// Row of a turn: the kinematics and the quantities asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct TurnRow {
    /// Kinematics at the crank angle.
    pub kinematics: KinematicsRow,
    /// Forces.
    pub forces: Option<ForceRow>,
    /// Derivatives with respect to crank, rod and offset.
    pub slopes: Option<[LengthSlope; 3]>,
    /// x, v and a (x' and x'' without speed) of the changed mechanism minus those of the scene.
    pub change: Option<[f64; 3]>,
}

/// Derivatives with respect to one length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthSlope {
    /// Derivative of x, dimensionless
    pub x: f64,
    /// Derivative of v, 1/s; without speed of x', 1/rad
    pub v: f64,
    /// Derivative of a, 1/s²; without speed of x'', 1/rad²
    pub a: f64,
    /// Derivative of the driving torque at constant speed, N; none without speed, not finite where it is not known
    pub torque: Option<f64>,
}

/// Computes the kinematics of a scene and the quantities that `options` ask for.
///
/// # Errors
/// The errors of [`kinematics`] and [`forces`], those of the changed lengths, and [`Error::Refused`] for a balanced part
/// that is no number from zero on.
pub fn one_turn(scene: &Scene, options: &TurnOptions) -> Result<OneTurn, Error> {
    if let Some(part) = options.balance
        && !(0.0..=LARGEST_VALUE).contains(&part)
    {
        return Err(Error::refused(
            format!("a balance of {part:?} of the reciprocating mass cannot be"),
            "give a number that is zero or more, like 0.5",
        ));
    }
    let mut kinematics = kinematics(scene)?;
    let torque_slope = options.sensitivity.then(|| TorqueSlope::new(scene));
    if let (Some(Err(reason)), Some(_)) = (&torque_slope, kinematics.speed_rad_per_s) {
        kinematics.warnings.push(reason.to_string());
    }
    if options.forces {
        kinematics.warnings.extend(left_out_of_forces(scene));
    }
    let forces = options.forces.then(|| forces(scene)).transpose()?;
    if let Some(why) = forces.as_ref().and_then(|f| f.not_repeating.as_ref()) {
        let what = format!("the forces are those of the first turn, others may differ: {why}");
        kinematics.warnings.push(what);
    }
    let balanced = forces.as_ref().zip(options.balance);
    Ok(OneTurn {
        diagrams: balanced.and_then(|(forces, part)| forces.diagrams(scene, part)),
        forces,
        changed: changed(scene, &options.change)?,
        kinematics,
        has_slopes: options.sensitivity,
        torque_slope: torque_slope.and_then(Result::ok),
    })
}

/// Returns warnings about what forces at constant speed leave out of a scene.
pub(crate) fn left_out_of_forces(scene: &Scene) -> impl Iterator<Item = String> {
    let parts = [
        scene.friction.is_some().then_some("friction"),
        scene.clearance.is_some().then_some("clearance"),
    ];
    let said = |name| format!("the {name} of the scene is not in the forces at constant speed");
    parts.into_iter().flatten().map(said)
}

fn changed(scene: &Scene, change: &[(Length, f64)]) -> Result<Option<Kinematics>, Error> {
    if change.is_empty() {
        return Ok(None);
    }
    let mut scene = scene.clone();
    for (i, (length, value)) in change.iter().enumerate() {
        if change[..i].iter().any(|(other, _)| other == length) {
            let name = length.name();
            return Err(Error::refused(
                format!("the changed {name} is given twice"),
                format!("give one length for the {name}"),
            ));
        }
        match length {
            Length::Crank => scene.geometry.crank = *value,
            Length::Rod => scene.geometry.rod = *value,
            Length::Offset => scene.geometry.offset = *value,
        }
    }
    // Only the lengths count; the rod's centre of gravity may lie anywhere.
    kinematics(&scene).map(Some)
}

impl OneTurn {
    /// Returns the row at a crank angle, rad.
    pub fn row(&self, theta: f64) -> TurnRow {
        let kinematics = self.kinematics.row(theta);
        TurnRow {
            forces: self.forces.as_ref().map(|forces| forces.row(theta)),
            slopes: self.has_slopes.then(|| self.slopes(theta)),
            change: self.changed.as_ref().map(|changed| {
                let (before, after) = (kinematics.motion(), changed.row(theta).motion());
                [0, 1, 2].map(|i| after[i] - before[i])
            }),
            kinematics,
        }
    }

    /// Iterates over the rows of one turn, or of the cycle of the loads if forces are computed, from 0 to the end
    /// inclusive, every `step` (rad).
    pub fn rows(&self, step: f64) -> impl Iterator<Item = TurnRow> + '_ {
        let turns = self.forces.as_ref().map_or(1, |forces| forces.cycle_turns);
        angle::turns(turns, step).map(|theta| self.row(theta))
    }

    fn slopes(&self, theta: f64) -> [LengthSlope; 3] {
        let Kinematics {
            linkage,
            speed_rad_per_s: speed,
            ..
        } = &self.kinematics;
        let pose = linkage.pose(theta);
        let rate = speed.unwrap_or(1.0);
        Length::ALL.map(|length| {
            let slope = linkage.slope(&pose, length);
            // No torque without a speed; where the derivative is not known, the cells stay empty.
            let torque = speed.map(|speed| match &self.torque_slope {
                Some(torque) => torque.driving_torque(theta, speed, length),
                None => f64::NAN,
            });
            LengthSlope {
                x: slope.x,
                v: slope.dx * rate,
                a: slope.d2x * rate * rate,
                torque,
            }
        })
    }
}
