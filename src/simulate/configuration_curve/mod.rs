//! Motion in time on the configuration curve, past the limits of a rocker and with Coulomb friction or dry loads.

mod follow;
mod rest;

pub(super) use follow::CurveRun;

use std::sync::Arc;

use super::coordinate::Coordinate;
use super::energy_balance::EnergyBalance;
use super::run_setup::RunSetup;
use super::stop::Why;
use super::warning::Warning;
use crate::engine::step::Step;
use crate::engine::time::{Finish, MotionState};
use crate::mechanism::{Class, Curve, CurveEquation, Equation};
use crate::numeric::angle::Angle;

/// Initial value problem on the configuration curve through the start: equation, and state of the coordinate there.
#[derive(Clone)]
pub(super) struct CurveProblem {
    pub equation: Arc<CurveEquation>,
    pub start: MotionState,
}

/// Whether a free motion in time follows the configuration curve.
pub(super) fn is_followed(task: &RunSetup<'_>) -> bool {
    !task.turns_fully() || task.may_stick()
}

/// Returns the warning about lengths at or near a change point, if any.
pub(super) fn warning(task: &RunSetup<'_>) -> Option<Warning> {
    // In crank lengths; lengths given to six digits do not tell on which side of a change point they are.
    let (near, as_given) = (task.equation().linkage().nearness_to_change_point(), 1e-6);
    match task.limits.class {
        Class::ChangePoint => Some(Warning::ChangePoint),
        _ => (near < as_given).then_some(Warning::NearChangePoint(near)),
    }
}

impl CurveProblem {
    /// Places a run on the curve through its start; none where no curve passes through it.
    pub fn through_start(task: &RunSetup<'_>) -> Option<CurveProblem> {
        let (curve, angle) = Curve::through(task.equation().linkage(), task.start())?;
        let speed = match task.speed {
            0.0 => 0.0,
            speed => speed / curve.pose(angle.rest).dtheta,
        };
        let t = 0.0;
        let start = MotionState { t, angle, speed };
        let equation = Arc::new(CurveEquation::new(task.scene, curve));
        Some(CurveProblem { equation, start })
    }

    /// Computes the energy balance up to the end of the last step, from work (J) and the largest crank speed (rad/s).
    pub fn energy_balance(
        &self,
        equation: &Equation,
        last: &Step,
        work: f64,
        fastest: f64,
    ) -> EnergyBalance {
        let (on, start) = (&self.equation, self.start);
        let angle = last.angle(last.end.theta);
        let turns = on.curve().crank_angle(start.angle).turns;
        let potential = |q: Angle| on.potential_energy(q, turns);
        let kinetic = [
            on.kinetic_energy(start.angle, start.speed),
            on.kinetic_energy(angle, last.end.omega),
        ];
        let rise = potential(angle) - potential(start.angle);
        let gained = (kinetic[1] - kinetic[0]) + rise;
        let peak = equation.kinetic_energy(on.curve().crank_angle(angle).rest, fastest);
        let peak = if peak.is_finite() { peak } else { 0.0 };
        EnergyBalance::new(gained - work, &[kinetic[0], kinetic[1], rise, work, peak])
    }
}

/// Receiver of motion in time, step by step.
pub(super) trait StepObserver {
    /// Takes a step along a coordinate; true ends the run.
    fn step(&mut self, step: &Step, along: &Coordinate<'_>) -> bool;

    /// Takes an event on the curve.
    fn event(&mut self, _kind: &'static str, _at: MotionState) {}
}

/// End of a piece in time.
#[derive(Debug)]
pub(super) enum EndReason {
    /// The piece reached its time or its turns, or another piece follows.
    Done,
    /// The mechanism is at rest for good before its turns are complete.
    AtRest,
    /// The observer ended the piece.
    Stopped,
    /// The integrator could not go on, or the work limit is reached.
    Integrator(Finish),
    /// A reason that is known at once.
    Named(Box<Why>),
}

/// Result of a piece in time: last step, work, counts and end.
pub(super) struct TimePiece {
    pub last: Step,
    /// Work of friction and of the loads without potential, J.
    pub work: f64,
    pub steps: u64,
    pub evaluations: u64,
    pub end: EndReason,
    /// Time, crank angle and speed of the last evaluation without a finite result.
    pub singular_state: Option<MotionState>,
}
