//! The result of a run in numbers.

use std::borrow::Cow;

use serde::Serialize;

use super::clearance::ClearanceSummary;
use super::steady::SteadyState;
use super::stop::Stopped;
use super::warning::Warning;
use crate::plan::Plan;

/// Summary of a run; its JSON is the object that `simulate --json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Title of the scene.
    pub scene: String,
    /// Name of the engine.
    pub engine: String,
    /// What was computed, and how.
    pub plan: Plan,
    /// Which engine computed which part of the run, and why that one: the first parts, at most as many as events.
    pub pieces: Vec<Piece>,
    /// Last state.
    #[serde(rename = "final")]
    pub last: Final,
    /// Turns made, negative clockwise.
    pub revolutions: f64,
    /// Estimate of the global error of the last state; none if it was not asked for or cannot be given.
    pub error_estimate: Option<ErrorEstimate>,
    /// Error of the worst state on the way at which a second run is compared: a run may end better than it was before. None for
    /// a loose joint, for a run that was handed from one engine to another, and without rows over the crank angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows_error: Option<ErrorEstimate>,
    /// Energy at the end minus energy at the start minus work of the loads, divided by the largest of the
    /// energies that occur; not finite for a prescribed speed that runs into a limit, where they grow without bound.
    pub energy_residual: f64,
    /// Energy residual, J.
    pub energy_residual_j: f64,
    /// Evaluations of the equation for the solution.
    pub evaluations: u64,
    /// Steps taken.
    pub steps: u64,
    /// Wall time of the solution itself, without rows and estimate, s.
    pub wall_s: f64,
    /// What the error estimate cost beside it.
    pub estimate_cost: Option<Cost>,
    /// Least crank speed, rad/s.
    pub omega_min: f64,
    /// Largest crank speed, rad/s.
    pub omega_max: f64,
    /// Torque that keeps the prescribed speed, for prescribed motions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub driving_torque: Option<TorqueRange>,
    /// Largest joint forces, if forces were asked for and the run came to its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peaks: Option<Peaks>,
    /// The loose joint, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceSummary>,
    /// The periodic motion, for a run that was started in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_state: Option<SteadyState>,
    /// Dead centres, turning points, impacts and separations: the first of them, at most as many as were asked for.
    pub events: Vec<Event>,
    /// How many there were.
    pub events_total: u64,
    /// What the reader should know.
    pub warnings: Vec<Warning>,
    /// Why the run ended before its time, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<Stopped>,
}

/// A last state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Final {
    /// s
    pub t_s: f64,
    /// rad, unwrapped
    pub theta_rad: f64,
    /// rad/s
    pub omega_rad_per_s: f64,
}

/// Estimate of the global error, which is no bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// rad
    pub theta_rad: f64,
    /// rad/s
    pub omega_rad_per_s: f64,
}

impl ErrorEstimate {
    /// The larger one of each.
    pub(super) fn max(self, other: ErrorEstimate) -> ErrorEstimate {
        ErrorEstimate {
            theta_rad: self.theta_rad.max(other.theta_rad),
            omega_rad_per_s: self.omega_rad_per_s.max(other.omega_rad_per_s),
        }
    }
}

/// A part of a run that one engine computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Piece {
    /// Name of the engine.
    pub engine: &'static str,
    /// s
    pub from_s: f64,
    /// s
    pub to_s: f64,
    /// Why this engine.
    pub why: Cow<'static, str>,
}

/// Evaluations and time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Evaluations of the equation.
    pub evaluations: u64,
    /// s
    pub wall_s: f64,
}

/// Range of the driving torque over the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TorqueRange {
    /// N m
    pub min_nm: f64,
    /// N m
    pub max_nm: f64,
    /// Mean over time, N m
    pub mean_nm: f64,
}

/// Something that happened.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Event {
    /// `dead-centre`, `turning-point`, `limit`, `stick`, `slip`, `rest`, `impact` or `separation`.
    pub kind: &'static str,
    /// s
    pub t_s: f64,
    /// rad, unwrapped
    pub theta_rad: f64,
    /// rad/s; infinite, and null in JSON, where the inertia vanishes and the speed has no bound
    pub omega_rad_per_s: f64,
}

/// Joint forces of which the largest are looked for.
pub(super) const FORCES: usize = 5;

/// The largest size of a force in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peak {
    /// N
    pub value_n: f64,
    /// When, s.
    pub t_s: f64,
    /// Where the crank is then, rad, unwrapped.
    pub theta_rad: f64,
    /// What the last refinement added, N. The error of the motion itself comes on top.
    pub added_n: f64,
}

/// The largest sizes of the joint forces in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peaks {
    /// Of the crank's bearing at O.
    pub crank_bearing: Peak,
    /// Between crank and rod.
    pub crank_pin: Peak,
    /// Between rod and slider.
    pub wrist_pin: Peak,
    /// Of the guide, normal to it.
    pub guide: Peak,
    /// Minus the rate of change of the momentum of the mechanism.
    pub shaking: Peak,
}

impl Peaks {
    pub(super) fn new(
        [crank_bearing, crank_pin, wrist_pin, guide, shaking]: [Peak; FORCES],
    ) -> Peaks {
        Peaks {
            crank_bearing,
            crank_pin,
            wrist_pin,
            guide,
            shaking,
        }
    }

    /// All of them, with their names.
    pub fn named(&self) -> [(&'static str, Peak); FORCES] {
        [
            ("crank bearing", self.crank_bearing),
            ("crank pin", self.crank_pin),
            ("wrist pin", self.wrist_pin),
            ("guide", self.guide),
            ("shaking force", self.shaking),
        ]
    }
}
