//! The result of a run in numbers.

use std::f64::consts::TAU;

use serde::Serialize;

use super::clearance::ClearanceSummary;
use super::joint_force_maxima::Peaks;
use super::run_setup::RunSetup;
use super::stalled;
use super::steady::SteadyState;
use crate::plan::Plan;
use crate::scene::Extent;

/// Summary of a run; its JSON is the object that `simulate --json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Title of the scene.
    pub scene: String,
    /// Name of the engine.
    pub engine: String,
    /// What was computed, and how.
    pub plan: Plan,
    /// Last state.
    #[serde(rename = "final")]
    pub last: Final,
    /// Turns made, negative clockwise.
    pub revolutions: f64,
    /// Estimate of the global error of the last state; none if it was not asked for or cannot be given.
    pub error_estimate: Option<ErrorEstimate>,
    /// Error of the worst state on the way, of up to 128 that a second run is compared at: a run may end better than it was
    /// before. None for a loose joint, for a run that was handed from one engine to another, and without rows over the
    /// crank angle.
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
    pub warnings: Vec<String>,
    /// Why the run ended before its time, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

/// What an engine found, before it is put into words.
#[derive(Clone, Debug, Default)]
pub(super) struct Solved {
    pub last: Final,
    /// rad, signed
    pub turned: f64,
    pub error_estimate: Option<ErrorEstimate>,
    pub rows_error: Option<ErrorEstimate>,
    /// Residual and the largest energy that occurs, J.
    pub energy: (f64, f64),
    pub evaluations: u64,
    pub steps: u64,
    pub wall_s: f64,
    pub estimate_cost: Option<Cost>,
    pub speed: (f64, f64),
    pub driving_torque: Option<TorqueRange>,
    pub peaks: Option<Peaks>,
    pub clearance: Option<ClearanceSummary>,
    pub events: Vec<Event>,
    pub events_total: u64,
    pub warnings: Vec<String>,
    pub stopped: Option<String>,
}

impl Summary {
    pub(super) fn new(task: &RunSetup<'_>, solved: Solved) -> Summary {
        let (residual, scale) = solved.energy;
        let mut warnings = solved.warnings;
        let kept = solved.events.len();
        if kept > 0 && solved.events_total > kept as u64 {
            let total = solved.events_total;
            warnings.push(format!(
                "{total} events occurred; the first {kept} are listed"
            ));
        }
        let stopped = solved
            .stopped
            .or_else(|| short_of(task.extent, &solved.last, solved.turned));
        let stopped = stopped.map(|why| stalled::reason(task, &solved.last).unwrap_or(why));
        Summary {
            scene: task.scene.title.clone().unwrap_or_default(),
            engine: task.plan.engine.name().to_owned(),
            plan: task.plan.clone(),
            last: solved.last,
            revolutions: solved.turned / TAU,
            error_estimate: solved.error_estimate,
            rows_error: solved.rows_error,
            energy_residual: if scale == 0.0 { 0.0 } else { residual / scale },
            energy_residual_j: residual,
            evaluations: solved.evaluations,
            steps: solved.steps,
            wall_s: solved.wall_s,
            estimate_cost: solved.estimate_cost,
            omega_min: solved.speed.0,
            omega_max: solved.speed.1,
            driving_torque: solved.driving_torque,
            peaks: solved.peaks,
            clearance: solved.clearance,
            steady_state: None,
            events: solved.events,
            events_total: solved.events_total,
            warnings,
            stopped,
        }
    }
}

/// What is said of a run that ended short of its goal, or without a state, though no engine told why.
fn short_of(extent: Extent, last: &Final, turned: f64) -> Option<String> {
    let (goal, reached) = match extent {
        Extent::Duration(duration) => (duration, last.t_s),
        Extent::Revolutions(turns) => (turns * TAU, turned.abs()),
    };
    // Half of all digits: far more than a goal is missed by in rounding.
    let missed = goal - reached > f64::EPSILON.sqrt() * goal;
    let state = [last.t_s, last.theta_rad, last.omega_rad_per_s, reached];
    let is_state = state.iter().all(|number| number.is_finite());
    (missed || !is_state).then(|| {
        format!(
            "the run ended before its goal: stopped at t = {} s, theta = {} rad, omega = {} rad/s; no engine gave a reason, which is a defect of this program",
            last.t_s, last.theta_rad, last.omega_rad_per_s
        )
    })
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

/// A run that was compared with a better one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged {
    /// Error of its last state.
    pub end: ErrorEstimate,
    /// Error of the worst state on its way.
    pub rows: ErrorEstimate,
    /// What the better one cost.
    pub cost: Cost,
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
    /// rad/s
    pub omega_rad_per_s: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_short_of_its_goal_never_ends_in_silence() {
        let says = |extent, t_s, turned| {
            let last = Final {
                t_s,
                theta_rad: turned,
                omega_rad_per_s: 1.0,
            };
            short_of(extent, &last, turned).is_some()
        };
        let (second, turn) = (Extent::Duration(1.0), Extent::Revolutions(1.0));
        assert!(!says(second, 1.0, 0.3) && !says(turn, 0.2, -TAU) && !says(turn, 0.2, TAU));
        assert!(says(second, 0.999, 0.3) && says(turn, 0.2, -6.2));
        assert!(says(second, 1.0, f64::NAN) && says(second, f64::NAN, 0.3));
        assert!(says(turn, 0.2, f64::INFINITY) && !says(Extent::Duration(0.0), 0.0, 0.3));
    }
}
