//! Options of a run.

use crate::engine::WorkLimit;
use crate::numeric::stop::Stop;
use crate::plan::Method;

/// Options of a run, beside the settings of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Method of integration; [`Method::Auto`] leaves the choice to the plan.
    pub method: Method,
    /// Whether the rows hold the joint forces and the summary the largest of them.
    pub reactions: bool,
    /// Whether the rows hold the driving torque of a prescribed motion.
    pub driving_torque: bool,
    /// Whether the global error is estimated, by a second run unless the engine states the error itself.
    pub estimate: bool,
    /// Largest number of evaluations of the equation; the run ends there and keeps its result up to then.
    pub max_evaluations: u64,
    /// Largest number of events and of pieces that are listed; all events are counted.
    pub events_kept: usize,
    /// Request to stop; the run ends at once and keeps its result up to then.
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
