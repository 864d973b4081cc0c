//! Why an engine over the angle cannot serve a run.

use super::super::angle_motion::reason;
use super::super::run_setup::RunSetup;
use crate::engine::energy::NotApplicable;
use crate::error::Error;

/// Why these engines cannot serve a task.
pub(super) fn why(task: &RunSetup<'_>, unserved: NotApplicable) -> &'static str {
    match task.maker.sliding {
        Some(sliding) if sliding.jams() => "the slider jams in its guide at an angle of the turn",
        _ if unserved == NotApplicable::NotFinite && !task.turns_fully() => {
            "the mechanism reaches the limit of its motion"
        }
        _ => reason(unserved),
    }
}

/// Refuses a method that is asked for and cannot begin.
pub(super) fn of(task: &RunSetup<'_>, unserved: NotApplicable) -> Error {
    Error::refused(
        format!(
            "method {} cannot serve this scene: {}",
            task.options.method,
            why(task, unserved)
        ),
        "use --method auto or time",
    )
}
