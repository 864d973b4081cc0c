//! A run in time: its start, how it is integrated, where and how it ends.

use super::runge_kutta;
use super::step::Step;
use crate::numeric::angle::Angle;
use crate::numeric::stop::Stop;

/// The methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Gauss collocation of order 24 by sweeps.
    Picard,
    /// One of ode_solvers.
    Library(runge_kutta::RungeKutta),
}

/// How to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<'a> {
    /// The method.
    pub method: Method,
    /// Local error target, relative and absolute.
    pub tolerance: f64,
    /// Last time, s.
    pub t_end: f64,
    /// How far (rad) the crank has to turn, if the run ends with that; else infinite.
    pub way: f64,
    /// The run ends there with [`Finish::WorkLimit`].
    pub limit: WorkLimit<'a>,
    /// Unit of work, J, in which its error is measured.
    pub work_unit: f64,
    /// First steps of a run from the same start, from which this one sets out.
    pub guide: &'a [Step],
}

impl Settings<'_> {
    /// Where a run ends.
    pub fn ends(&self) -> Ends<'_> {
        Ends {
            t: self.t_end,
            way: self.way,
            limit: self.limit,
        }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finish {
    /// At the last time.
    AtEnd,
    /// Where the sink wanted it to end.
    Stopped,
    /// The work limit is reached.
    WorkLimit,
    /// At the pace of the last steps it would be reached long before the end.
    WorkLimitAhead,
    /// At the speed of the last turns it would be.
    TooManyTurns,
    /// The step size became too small for the time to move on: a singularity.
    StepTooSmall,
    /// There is no acceleration at the start.
    NoStart,
}

/// A run's start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// s
    pub t: f64,
    /// rad
    pub angle: Angle,
    /// rad/s
    pub speed: f64,
}

/// A last time (s) from which on a run has none of its own.
pub const FAR: f64 = 1e9;

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends<'a> {
    /// Last time, s.
    pub t: f64,
    /// How far (rad) the crank turns, or infinite.
    pub way: f64,
    /// The work limit.
    pub limit: WorkLimit<'a>,
}

/// A computation ends after so many evaluations, or where somebody asks it to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkLimit<'a> {
    /// Most evaluations.
    pub evaluations: u64,
    /// The request to stop, if there may be one.
    pub stop: Option<&'a Stop>,
}

impl WorkLimit<'static> {
    /// As long as it takes.
    pub const NONE: WorkLimit<'static> = WorkLimit {
        evaluations: u64::MAX,
        stop: None,
    };
}

impl WorkLimit<'_> {
    /// Whether it ends after so many evaluations.
    pub fn is_reached(&self, spent: u64) -> bool {
        spent >= self.evaluations || self.stop.is_some_and(Stop::is_requested)
    }

    /// What is left of it after so many evaluations.
    pub fn after(self, spent: u64) -> Self {
        WorkLimit {
            evaluations: self.evaluations.saturating_sub(spent),
            ..self
        }
    }
}
