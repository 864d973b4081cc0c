//! How long an engine may go on.

use crate::numeric::stop::Stop;

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
