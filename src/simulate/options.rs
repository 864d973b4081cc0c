//! What is asked of a run.

use crate::engine::WorkLimit;
use crate::numeric::stop::Stop;
use crate::plan::Method;

/// What is asked of a run beside what the scene says.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The method; [`Method::Auto`] leaves it to the plan.
    pub method: Method,
    /// Joint forces in the rows, and the largest of them.
    pub reactions: bool,
    /// Driving torque in the rows, for prescribed motions.
    pub driving_torque: bool,
    /// Whether the global error is estimated, by a second run.
    pub estimate: bool,
    /// Most evaluations of the equation; the run ends there with what it has.
    pub max_evaluations: u64,
    /// Most events that are listed; all are counted.
    pub events_kept: usize,
    /// A request to stop; the run ends where it is made with what it has.
    pub stop: Option<Stop>,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            method: Method::Auto,
            reactions: false,
            driving_torque: false,
            estimate: true,
            max_evaluations: 2_000_000_000,
            events_kept: 1000,
            stop: None,
        }
    }
}

impl Options {
    pub(super) fn limit(&self) -> WorkLimit<'_> {
        WorkLimit {
            evaluations: self.max_evaluations,
            stop: self.stop.as_ref(),
        }
    }
}
