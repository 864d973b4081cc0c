//! A piece of motion on the curve: what it is given, what it hands on, and where it arrives.

use super::super::stop::Why;
use super::stick_slip::Phase;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Settings, Start};
use crate::mechanism::{Curve, CurveEquation};
use crate::numeric::angle::Angle;

/// Takes what is computed in time.
pub(in crate::simulate) trait Observer {
    /// A part of the motion in a phase of the curve, or in none where the crank angle is the coordinate of a smooth motion;
    /// true ends the run.
    fn step(&mut self, step: &Step, phase: Option<Phase>) -> bool;

    /// Something that happened on the curve.
    fn event(&mut self, _kind: &'static str, _t: f64, _angle: Angle, _speed: f64) {}
}

/// What is followed, and how far.
pub(in crate::simulate) struct Follow<'a> {
    pub equation: &'a CurveEquation,
    pub settings: Settings<'a>,
    /// Of the coordinate.
    pub start: Start,
    /// How far the crank may turn from `turned_from`, rad.
    pub turn_limit: Option<f64>,
    /// Crank angle.
    pub turned_from: Angle,
}

/// How a run in time ended.
#[derive(Clone, Debug)]
pub(in crate::simulate) enum End {
    /// At its time, or after its turns, or another piece follows.
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

/// A piece of motion in time.
pub(in crate::simulate) struct Piece {
    /// Last step.
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
pub(in crate::simulate) fn crank_state(curve: &Curve, at: Start) -> Start {
    Start {
        t: at.t,
        angle: curve.crank_angle(at.angle),
        speed: curve.place(at.angle.rest).dtheta * at.speed,
    }
}
