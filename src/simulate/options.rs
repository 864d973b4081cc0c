//! What is asked of a run.

use crate::plan::Method;

/// What is asked of a run beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        }
    }
}
