//! Start, settings and end of an integration in time.

use super::runge_kutta::RungeKutta;
use super::step::Step;
use crate::numeric::angle::Angle;
use crate::numeric::stop::Stop;

/// Settings of an integration in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<'a> {
    /// Explicit Runge-Kutta method of the crate ode_solvers; none: Gauss collocation of order 24, solved by Picard
    /// iteration (sweeps).
    pub method: Option<RungeKutta>,
    /// Tolerance of the local error, relative and absolute.
    pub tolerance: f64,
    /// Last time, s.
    pub t_end: f64,
    /// Crank rotation, rad, that ends the run; infinite if there is none.
    pub way: f64,
    /// Evaluation limit; at it the run ends with [`Finish::WorkLimit`].
    pub limit: WorkLimit<'a>,
    /// Unit of work, J, for the local error of the work.
    pub work_unit: f64,
    /// Leading steps of another run from the same start, used as first guess.
    pub guide: &'a [Step],
}

impl Settings<'_> {
    /// Returns the conditions that end the run.
    pub fn ends(&self) -> Ends<'_> {
        Ends {
            t: self.t_end,
            way: self.way,
            limit: self.limit,
        }
    }
}

/// Reason for the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finish {
    /// Last time reached.
    AtEnd,
    /// Stopped by the sink.
    Stopped,
    /// Work limit reached.
    WorkLimit,
    /// Forecast: at the present progress the work limit comes long before the end.
    WorkLimitAhead,
    /// Forecast: at the present, lasting speed of rotation the work limit comes long before the end.
    TooManyTurns,
    /// Step size below the resolution of the time: a singularity.
    StepTooSmall,
    /// Pole of a load: there the motion has no finite acceleration.
    NoValue,
    /// No finite acceleration at the start.
    NoStart,
}

/// State of a motion with one degree of freedom.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionState {
    /// Time, s.
    pub t: f64,
    /// Crank angle, or coordinate along the configuration curve.
    pub angle: Angle,
    /// Speed, rad/s.
    pub speed: f64,
}

/// Last time, s, from which on a run counts as unlimited in time: 30 years.
pub const UNLIMITED_TIME: f64 = 1e9;

/// Conditions that end a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends<'a> {
    /// Last time, s.
    pub t: f64,
    /// Crank rotation, rad; infinite if unlimited.
    pub way: f64,
    /// Evaluation limit.
    pub limit: WorkLimit<'a>,
}

/// Limit of a computation: a number of evaluations, or a request to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkLimit<'a> {
    /// Most evaluations.
    pub evaluations: u64,
    /// Request to stop, if there may be one.
    pub stop: Option<&'a Stop>,
}

impl WorkLimit<'static> {
    /// No limit.
    pub const NONE: WorkLimit<'static> = WorkLimit {
        evaluations: u64::MAX,
        stop: None,
    };
}

impl WorkLimit<'_> {
    /// True if the limit is reached after `spent` evaluations, or a stop is requested.
    pub fn is_reached(&self, spent: u64) -> bool {
        spent >= self.evaluations || self.stop.is_some_and(Stop::is_requested)
    }

    /// Returns the remaining limit after `spent` evaluations.
    pub fn after(self, spent: u64) -> Self {
        WorkLimit {
            evaluations: self.evaluations.saturating_sub(spent),
            ..self
        }
    }
}
