//! Result of a run in numbers.

use std::borrow::Cow;

use serde::Serialize;

use super::clearance::ClearanceSummary;
use super::steady::SteadyState;
use super::stop::Stopped;
use super::warning::Warning;
use crate::engine::time::MotionState;
use crate::plan::Plan;

/// Summary of a run; its JSON is the object that `simulate --json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Title of the scene.
    pub scene: String,
    /// Name of the engine.
    pub engine: String,
    /// Plan of the run: what was computed, and how.
    pub plan: Plan,
    /// Engine of each part of the run and the reason for it: the first parts, at most `Options::events_kept`.
    pub pieces: Vec<Piece>,
    /// Last state.
    #[serde(rename = "final")]
    pub last: Final,
    /// Number of turns made, negative clockwise.
    pub revolutions: f64,
    /// Estimated global error of the last state; none if not asked for or not available.
    pub error_estimate: Option<ErrorEstimate>,
    /// Error of the worst compared state on the way: a run may be more exact at its end than before. None with a loose
    /// joint, at prescribed speed, for a run that changed engines, and over the crank angle without rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows_error: Option<ErrorEstimate>,
    /// Energy at the end minus energy at the start minus work of the loads, divided by the largest of the energies that
    /// occur; not finite for a prescribed speed that runs into a limit, where the energies grow without bound.
    pub energy_residual: f64,
    /// Energy residual, J.
    pub energy_residual_j: f64,
    /// Number of evaluations of the equation for the solution.
    pub evaluations: u64,
    /// Number of steps or panels.
    pub steps: u64,
    /// Wall time of the solution, without rows and estimate, s.
    pub wall_s: f64,
    /// Additional cost of the error estimate; none without a second run.
    pub estimate_cost: Option<Cost>,
    /// Least crank speed, rad/s.
    pub omega_min: f64,
    /// Largest crank speed, rad/s.
    pub omega_max: f64,
    /// Torque that keeps a prescribed speed; none for a free motion or if the range is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub driving_torque: Option<TorqueRange>,
    /// Largest joint forces, if asked for and if the run came to its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peaks: Option<Peaks>,
    /// Results of the loose joint, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceSummary>,
    /// Periodic motion, for a run that was started in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_state: Option<SteadyState>,
    /// Events in order of time: the first, at most [`Options::events_kept`](super::Options::events_kept).
    pub events: Vec<Event>,
    /// Number of all events.
    pub events_total: u64,
    /// Warnings for the reader.
    pub warnings: Vec<Warning>,
    /// Reason for an end before the goal; none if the run reached it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<Stopped>,
}

/// Last state of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Final {
    /// Time, s.
    pub t_s: f64,
    /// Crank angle, rad, unwrapped.
    pub theta_rad: f64,
    /// Crank speed, rad/s.
    pub omega_rad_per_s: f64,
}

/// Estimate of a global error, which is no bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// Error of the crank angle, rad.
    pub theta_rad: f64,
    /// Error of the crank speed, rad/s.
    pub omega_rad_per_s: f64,
}

impl ErrorEstimate {
    /// Returns the larger error of each quantity.
    pub(super) fn max(self, other: ErrorEstimate) -> ErrorEstimate {
        ErrorEstimate {
            theta_rad: self.theta_rad.max(other.theta_rad),
            omega_rad_per_s: self.omega_rad_per_s.max(other.omega_rad_per_s),
        }
    }
}

/// Part of a run that one engine computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Piece {
    /// Name of the engine.
    pub engine: &'static str,
    /// First time, s.
    pub from_s: f64,
    /// Last time, s.
    pub to_s: f64,
    /// Reason for this engine.
    pub why: Cow<'static, str>,
}

/// Cost of a computation: evaluations and time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Number of evaluations of the equation.
    pub evaluations: u64,
    /// Wall time, s.
    pub wall_s: f64,
}

/// Range of the driving torque over the run, or over one turn if all turns are equal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TorqueRange {
    /// Least torque, N m.
    pub min_nm: f64,
    /// Largest torque, N m.
    pub max_nm: f64,
    /// Mean torque over time, N m.
    pub mean_nm: f64,
}

/// Event of a run: kind, time and crank state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Event {
    /// `dead-centre`, `turning-point`, `limit`, `stick`, `slip`, `rest`, `impact` or `separation`.
    pub kind: &'static str,
    /// Time, s.
    pub t_s: f64,
    /// Crank angle, rad, unwrapped.
    pub theta_rad: f64,
    /// Crank speed, rad/s; infinite, and null in JSON, where the inertia vanishes and the speed has no bound.
    pub omega_rad_per_s: f64,
}

impl Event {
    pub(super) fn new(kind: &'static str, at: MotionState) -> Event {
        Event {
            kind,
            t_s: at.t,
            theta_rad: at.angle.radians(),
            omega_rad_per_s: at.speed,
        }
    }
}

/// Number of joint forces whose maxima are searched.
pub(super) const FORCES: usize = 5;

/// Largest size of a joint force in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peak {
    /// Size of the force, N.
    pub value_n: f64,
    /// Time of the maximum, s.
    pub t_s: f64,
    /// Crank angle at the maximum, rad, unwrapped.
    pub theta_rad: f64,
    /// Excess beside the maximum or, with a loose joint, gain over samples, N. The error of the motion comes on top.
    pub added_n: f64,
}

/// Largest sizes of the joint forces in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peaks {
    /// Force of the crank bearing at O.
    pub crank_bearing: Peak,
    /// Force between crank and rod.
    pub crank_pin: Peak,
    /// Force between rod and slider.
    pub wrist_pin: Peak,
    /// Force of the guide, normal to it.
    pub guide: Peak,
    /// Shaking force: minus the rate of change of the momentum of the mechanism.
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

    /// Lists all maxima with the names of their forces.
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
