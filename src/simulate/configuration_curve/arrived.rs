//! A run on the curve: what it is given, what it hands on, and where it arrives.

use super::stick_slip::Phase;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Settings, Start};
use crate::mechanism::{Curve, CurveEquation, Jam};
use crate::numeric::angle::Angle;

/// Takes what is computed.
pub(in crate::simulate) trait Observer {
    /// A part of the motion; true ends the run.
    fn step(&mut self, step: &Step, phase: Phase) -> bool;

    /// Something that happened.
    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64);
}

/// A run.
pub(in crate::simulate) struct Follow<'a> {
    pub equation: &'a CurveEquation,
    pub settings: Settings,
    /// Of the coordinate.
    pub start: Start,
    /// How far the crank may turn from `turned_from`, rad.
    pub turn_limit: Option<f64>,
    /// Crank angle.
    pub turned_from: Angle,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulate) enum End {
    /// At its time, or after its turns.
    Done,
    /// The integrator could not go on.
    Integrator(Finish),
    /// Rigid bodies do not say how it goes on.
    Jam {
        solutions: Jam,
        /// Coefficient of friction.
        mu: f64,
        /// |dN/dF| of the guide.
        kappa: f64,
    },
    /// At rest for good before its turns are complete.
    AtRest,
    /// The observer ended it.
    Stopped,
}

/// Where a run arrived.
pub(in crate::simulate) struct Arrived {
    /// Last piece.
    pub last: Step,
    /// Work of all that has no potential, J.
    pub work: f64,
    pub steps: u64,
    pub evaluations: u64,
    /// Pieces of the motion.
    pub pieces: u64,
    pub end: End,
    /// Time, crank angle (rad) and crank speed of the last evaluation without a finite result.
    pub impossible: Option<(f64, f64, f64)>,
    /// Whether the run ended as it would pass a position without inertia.
    pub vanished: bool,
}

/// Crank angle and speed (rad/s) at the end of a step of the coordinate.
pub(in crate::simulate) fn crank_state(curve: &Curve, last: &Step) -> (Angle, f64) {
    let angle = last.angle(last.end.theta);
    let dtheta = curve.place(angle.rest).dtheta;
    (curve.crank_angle(angle), dtheta * last.end.omega)
}
