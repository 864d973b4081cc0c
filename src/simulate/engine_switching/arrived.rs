//! What a pass is given, what it hands on, and where it arrives.

use super::super::configuration_curve;
use crate::engine::Counted;
use crate::engine::angle::Driving;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Settings, Start};
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::plan::Engine;

/// Takes what is computed.
pub(super) trait Observer {
    /// An engine takes over at a time, s.
    fn begins(&mut self, _engine: Engine, _from: f64, _why: &'static str) {}

    /// A piece over the angle, from a start until a time, s.
    fn over_angle(&mut self, from: Start, until: f64, driving: Driving) -> Result<(), Error>;

    /// A piece in time begins.
    fn begin_in_time(&mut self, from: Start);

    /// A step of it; true ends the run.
    fn step(&mut self, step: &Step) -> bool;

    /// A piece in time with friction: calls `run` with what takes it.
    fn with_friction(&mut self, run: &mut dyn FnMut(&mut dyn configuration_curve::Observer));

    /// A piece in time has ended; the last step, if the run ends inside it.
    fn end_in_time(
        &mut self,
        motion: &Counted<'_>,
        last: &Step,
        settings: &Settings,
    ) -> Option<Step>;
}

/// How a pass ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// At its time, or after its turns.
    AtGoal,
    /// The integrator in time could not go on, or the work limit is reached.
    Integrator(Finish),
}

/// Where a pass arrived.
pub(super) struct Arrived {
    pub now: Start,
    /// Last step, if the pass ended in time.
    pub last: Option<Step>,
    /// Work of all that has no potential, J.
    pub work: f64,
    /// Largest kinetic energy at the ends of panels and steps, J.
    pub largest_kinetic: f64,
    pub evaluations: u64,
    pub steps: u64,
    /// Pieces over the angle, and in time.
    pub over_angle: u64,
    pub in_time: u64,
    /// How often the angle handed over to the time, and the other way round.
    pub to_time: u64,
    pub to_angle: u64,
    pub end: End,
    /// Where its last piece in time with friction arrived.
    pub rubbed: Option<configuration_curve::Arrived>,
    /// Time, angle and speed of the last evaluation without a finite result.
    pub impossible: Option<(f64, Angle, f64)>,
}

impl Arrived {
    /// At the start.
    pub fn at(start: Start) -> Arrived {
        Arrived {
            now: start,
            last: None,
            work: 0.0,
            largest_kinetic: 0.0,
            evaluations: 0,
            steps: 0,
            over_angle: 0,
            in_time: 0,
            to_time: 0,
            to_angle: 0,
            end: End::AtGoal,
            rubbed: None,
            impossible: None,
        }
    }
}
