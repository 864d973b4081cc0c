//! What a pass hands on, why its pieces end, and where it arrives.

use std::borrow::Cow;

use super::super::configuration_curve::{End, Observer, OnCurve};
use crate::engine::Counted;
use crate::engine::angle::Driving;
use crate::engine::energy::NotApplicable;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::plan::Engine;

/// Takes what is computed.
pub(super) trait Sink: Observer {
    /// An engine takes over at a time, s.
    fn begins(&mut self, _engine: Engine, _from: f64, _why: Cow<'static, str>) {}

    /// A piece over the angle.
    fn over_angle(&mut self, driven: &Driven) -> Result<(), Error>;

    /// Keeps the motion of a piece over the angle that is one of several.
    fn keep(&mut self, _driven: Driven) {}

    /// A piece in time begins, on a configuration curve or with the crank angle as its coordinate.
    fn begin_in_time(&mut self, from: Start, on: Option<&OnCurve>);

    /// A piece in time has ended; the last step, if the run ends inside it.
    fn end_in_time(
        &mut self,
        _motion: &Counted<'_>,
        _last: &Step,
        _settings: &Settings<'_>,
    ) -> Option<Step> {
        None
    }
}

/// A piece over the angle in the time of the run.
pub(super) struct Driven {
    pub driving: Driving,
    pub engine: Engine,
    pub from: Start,
    pub to: Start,
}

/// Why a piece ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Why {
    /// The run is at its goal, or cannot go on.
    Ended,
    /// The crank turns safely again.
    Clear,
    /// The engine cannot go on, or not begin.
    NotApplicable(NotApplicable),
}

#[derive(Default)]
pub(super) struct Arrived {
    pub now: Start,
    /// Last step, if the pass ended in time.
    pub last: Option<Step>,
    /// Whether that followed the configuration curve.
    pub on_curve: bool,
    /// Last piece, if that was over the angle, until another one follows; at the end, if it is the only one.
    pub driven: Option<Driven>,
    /// Work of all that has no potential, J.
    pub work: f64,
    /// Largest kinetic energy at the ends of panels and steps, J.
    pub largest_kinetic: f64,
    pub evaluations: u64,
    pub steps: u64,
    /// Pieces over the angle, and in time.
    pub over_angle: u64,
    pub in_time: u64,
    pub end: End,
    /// Time, crank angle and speed of the last evaluation without a finite result.
    pub impossible: Option<Start>,
}

impl Arrived {
    /// Whether one engine computed the run in one piece.
    pub fn is_one_piece(&self) -> bool {
        self.over_angle + self.in_time == 1
    }
}
