//! Conclusion of a run: its last state, errors, energy balance and record become the result, whatever the engine.

use std::f64::consts::TAU;

use super::energy_balance::EnergyBalance;
use super::recorder::Record;
use super::result::{Cost, ErrorEstimate, Final, Piece, Summary};
use super::run_setup::RunSetup;
use super::simulation::Simulation;
use super::stalled::stalled;
use super::stop::{Stopped, Why};
use super::warning::Warning;
use crate::engine::time::MotionState;
use crate::plan::Engine;
use crate::scene::Extent;

/// End of a run, as input of its result.
pub(super) struct RunEnd {
    /// Last time, crank angle and crank speed.
    pub at: MotionState,
    /// Engine that names the run.
    pub engine: Engine,
    /// Signed rotation of the crank from the start, rad.
    pub turned: f64,
    pub estimate: Option<Estimate>,
    pub balance: EnergyBalance,
    pub evaluations: u64,
    pub steps: u64,
    /// Wall time of the solution without rows, s.
    pub wall_s: f64,
    pub warnings: Vec<Warning>,
    pub stopped: Option<Why>,
    pub record: Record,
}

/// Global error of a run, and the cost of its estimate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub error: ErrorEstimate,
    /// Error of the worst state on the way, if known.
    pub rows_error: Option<ErrorEstimate>,
    /// Cost of the second run; none without one.
    pub cost: Option<Cost>,
}

impl Estimate {
    /// Makes an estimate with the errors of the last angle (rad) and speed (rad/s) alone.
    pub fn of_end(theta_rad: f64, omega_rad_per_s: f64) -> Estimate {
        Estimate {
            error: ErrorEstimate {
                theta_rad,
                omega_rad_per_s,
            },
            rows_error: None,
            cost: None,
        }
    }
}

impl RunEnd {
    /// Shows speeds as infinite where the inertia vanishes, at the dead centres of a crank without inertia.
    fn with_bounded_speeds(mut self, task: &RunSetup<'_>) -> RunEnd {
        let usual = task.speed.abs().max(self.at.speed.abs());
        // An inertia that vanishes, of 1e-12 of that elsewhere, gives a speed of 1e6 times that elsewhere.
        let unbounded = 1e6 * usual;
        let is_bounded = |speed: f64| speed.abs() < unbounded;
        let (low, high) = self.record.speed_range;
        let mut at_events = self.record.events.iter().map(|event| event.omega_rad_per_s);
        let are_bounded = is_bounded(low) && is_bounded(high) && at_events.all(is_bounded);
        if are_bounded || !task.inertia_vanishes() {
            return self;
        }
        let shown = |speed: f64| match is_bounded(speed) {
            true => speed,
            false => speed * f64::INFINITY,
        };
        self.record.speed_range = (shown(low), shown(high));
        for event in &mut self.record.events {
            let speed = event.omega_rad_per_s;
            // Rounding leaves no sign there: a crank that does not turn back has the sign of all its speeds.
            event.omega_rad_per_s = match (is_bounded(speed), low > 0.0, high < 0.0) {
                (true, ..) => speed,
                (false, true, _) => f64::INFINITY,
                (false, _, true) => f64::NEG_INFINITY,
                (false, ..) => shown(speed),
            };
        }
        if !is_bounded(low) || !is_bounded(high) {
            self.warnings.push(Warning::UnboundedSpeed);
        }
        self
    }

    pub fn conclude(mut self, task: &RunSetup<'_>) -> Simulation {
        if matches!(self.engine, Engine::Energy | Engine::Angle) {
            self = self.with_bounded_speeds(task);
        }
        let (at, turned, balance, record) = (self.at, self.turned, self.balance, self.record);
        let mut warnings = self.warnings;
        let last = Final {
            t_s: at.t,
            theta_rad: at.angle.radians(),
            omega_rad_per_s: at.speed,
        };
        let (kept, total) = (record.events.len(), record.events_total);
        if kept > 0 && total > kept as u64 {
            warnings.push(Warning::EventsLeftOut { total, kept });
        }
        let mut pieces = record.pieces;
        match pieces.last_mut() {
            Some(last) => last.to_s = last.to_s.min(at.t),
            None => pieces.push(Piece {
                engine: self.engine.name(),
                from_s: 0.0,
                to_s: at.t,
                why: task.plan.reason.clone(),
            }),
        }
        let stopped = self
            .stopped
            .or_else(|| unexplained_end(task.extent, &last, turned));
        let stopped = stopped.map(|why| Stopped {
            why: stalled(task, &last).unwrap_or(why),
            at,
        });
        let summary = Summary {
            scene: task.scene.title.clone().unwrap_or_default(),
            engine: self.engine.name().to_owned(),
            plan: task.plan.clone(),
            pieces,
            last,
            revolutions: turned / TAU,
            error_estimate: self.estimate.map(|estimate| estimate.error),
            rows_error: self.estimate.and_then(|estimate| estimate.rows_error),
            energy_residual: match balance.largest {
                0.0 => 0.0,
                largest => balance.residual / largest,
            },
            energy_residual_j: balance.residual,
            evaluations: self.evaluations,
            steps: self.steps,
            wall_s: self.wall_s,
            estimate_cost: self.estimate.and_then(|estimate| estimate.cost),
            omega_min: record.speed_range.0,
            omega_max: record.speed_range.1,
            driving_torque: None,
            peaks: None,
            clearance: None,
            steady_state: None,
            events: record.events,
            events_total: total,
            warnings,
            stopped,
        };
        Simulation {
            summary,
            trajectory: record.trajectory,
            work: None,
            maker: (self.engine != Engine::Contact).then(|| task.maker.clone()),
            curve: record.curve,
            phases: record.phases,
        }
    }
}

/// Returns the reason for a run that misses its goal or ends without a finite state, though no engine gave one.
fn unexplained_end(extent: Extent, last: &Final, turned: f64) -> Option<Why> {
    let (goal, reached, angle_rounding) = match extent {
        Extent::Duration(duration) => (duration, last.t_s, 0.0),
        Extent::Revolutions(turns) => {
            let rounding = 2.0 * f64::EPSILON * last.theta_rad.abs();
            (turns * TAU, turned.abs(), rounding)
        }
    };
    // Half of all digits: far more than the rounding of a goal.
    let missed = goal - reached > f64::EPSILON.sqrt() * goal + angle_rounding;
    let state = [last.t_s, last.theta_rad, last.omega_rad_per_s, reached];
    let is_state = state.iter().all(|number| number.is_finite());
    (missed || !is_state).then_some(Why::Untold)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_short_of_its_goal_never_ends_in_silence() {
        let says = |extent, t_s, theta_rad, turned| {
            let last = Final {
                t_s,
                theta_rad,
                omega_rad_per_s: 1.0,
            };
            unexplained_end(extent, &last, turned).is_some()
        };
        let (second, turn) = (Extent::Duration(1.0), Extent::Revolutions(1.0));
        assert!(!says(second, 1.0, 0.3, 0.3) && !says(turn, 0.2, -TAU, -TAU));
        assert!(!says(turn, 0.2, TAU, TAU) && !says(Extent::Duration(0.0), 0.0, 0.3, 0.3));
        assert!(says(second, 0.999, 0.3, 0.3) && says(turn, 0.2, -6.2, -6.2));
        assert!(says(second, 1.0, f64::NAN, f64::NAN) && says(second, f64::NAN, 0.3, 0.3));
        assert!(says(turn, 0.2, f64::INFINITY, f64::INFINITY));
        // Angles near 1 rad differ by a multiple of their rounding.
        let (goal, reached) = (6.28e-9, 6.28e-9 - 2.0 * f64::EPSILON);
        assert!(!says(Extent::Revolutions(goal / TAU), 1e-9, 1.0, reached));
    }
}
