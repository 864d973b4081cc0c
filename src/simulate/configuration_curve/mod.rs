//! Motion in time on the configuration curve: past the limits of a rocker, and with Coulomb friction.

mod follow;
mod release;
mod rest;

use std::sync::Arc;

use super::balance::Balance;
use super::run_setup::RunSetup;
use super::stick_slip::Phase;
use super::stop::Why;
use super::warning::Warning;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Settings, Start};
use crate::mechanism::{Class, Curve, CurveEquation, Equation};
use crate::numeric::angle::Angle;

/// Crank lengths from a change point within which the last digits of the lengths decide.
const NEAR_CHANGE_POINT: f64 = 1e-6;

/// The equation on the configuration curve, and the start of the run on it.
#[derive(Clone)]
pub(super) struct OnCurve {
    pub equation: Arc<CurveEquation>,
    pub start: Start,
}

/// Whether a free motion in time is computed here.
pub(super) fn serves(task: &RunSetup<'_>) -> bool {
    let may_stick = task.scene.reduced().friction.is_some() || task.equation().loads().are_dry();
    !task.turns_fully() || may_stick
}

/// What the reader should know about the lengths.
pub(super) fn warning(task: &RunSetup<'_>) -> Option<Warning> {
    let near = task.equation().linkage().nearness_to_change_point();
    match task.limits.class {
        Class::ChangePoint => Some(Warning::ChangePoint),
        _ => (near < NEAR_CHANGE_POINT).then_some(Warning::NearChangePoint(near)),
    }
}

impl OnCurve {
    /// The equation on the curve of the start, and the start on it; none where no curve goes through it.
    pub fn through_start(task: &RunSetup<'_>) -> Option<OnCurve> {
        let (curve, angle) = Curve::through(task.equation().linkage(), task.start())?;
        let speed = match task.speed {
            0.0 => 0.0,
            speed => speed / curve.place(angle.rest).dtheta,
        };
        let start = Start {
            t: 0.0,
            angle,
            speed,
        };
        let equation = Arc::new(CurveEquation::new(task.scene, curve));
        Some(OnCurve { equation, start })
    }

    /// Energy at the end of the last step against that at the start and the work (J), for a run whose crank was this fast
    /// (rad/s).
    pub fn energy_balance(
        &self,
        equation: &Equation,
        last: &Step,
        work: f64,
        fastest: f64,
    ) -> Balance {
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
        Balance::new(gained - work, &[kinetic[0], kinetic[1], rise, work, peak])
    }
}

/// Takes what is computed in time.
pub(super) trait Observer {
    /// A part of the motion in a phase of the curve, or in none where the crank angle is the coordinate of a smooth motion;
    /// true ends the run.
    fn step(&mut self, step: &Step, phase: Option<Phase>) -> bool;

    /// Something that happened on the curve.
    fn event(&mut self, _kind: &'static str, _t: f64, _angle: Angle, _speed: f64) {}
}

pub(super) struct Follow<'a> {
    pub equation: &'a CurveEquation,
    pub settings: Settings<'a>,
    /// Of the coordinate.
    pub start: Start,
    /// How far the crank may turn from `turned_from`, rad.
    pub turn_limit: Option<f64>,
    pub turned_from: Angle,
}

/// How a run in time ended.
#[derive(Clone, Debug, Default)]
pub(super) enum End {
    /// At its time, or after its turns, or another piece follows.
    #[default]
    Done,
    /// At rest for good before its turns are complete.
    AtRest,
    /// The observer ended it.
    Stopped,
    /// The integrator could not go on, or the work limit is reached.
    Integrator(Finish),
    /// For a reason that is known at once.
    Named(Box<Why>),
}

pub(super) struct Piece {
    pub last: Step,
    /// Work of all that has no potential, J.
    pub work: f64,
    pub steps: u64,
    pub evaluations: u64,
    pub end: End,
    /// Time, crank angle and speed of the last evaluation without a finite result.
    pub impossible: Option<Start>,
}

/// Time, crank angle and speed (rad/s) at a state of the coordinate.
pub(super) fn crank_state(curve: &Curve, at: Start) -> Start {
    Start {
        t: at.t,
        angle: curve.crank_angle(at.angle),
        speed: curve.place(at.angle.rest).dtheta * at.speed,
    }
}
