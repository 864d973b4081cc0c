//! Interface of a pass to its recorder, ends of its pieces, and the state in which it arrives.

use std::borrow::Cow;

use super::super::configuration_curve::{End, Observer, OnCurve};
use crate::engine::Counted;
use crate::engine::angle::AngleRun;
use crate::engine::energy::NotApplicable;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::plan::Engine;

/// Receiver of the pieces of a pass.
pub(super) trait Sink: Observer {
    /// Takes note that an engine takes over at a time, s.
    fn begins(&mut self, _engine: Engine, _from: f64, _why: Cow<'static, str>) {}

    /// Takes a piece over the angle.
    fn over_angle(&mut self, piece: &AnglePiece) -> Result<(), Error>;

    /// Keeps the motion of a piece over the angle that is one of several.
    fn keep(&mut self, _piece: AnglePiece) {}

    /// Begins a piece in time, on a configuration curve or with the crank angle as the coordinate.
    fn begin_in_time(&mut self, from: Start, on: Option<&OnCurve>);

    /// Ends a piece in time; returns the shortened last step if the run ends inside it.
    fn end_in_time(
        &mut self,
        _motion: &Counted<'_>,
        _last: &Step,
        _settings: &Settings<'_>,
    ) -> Option<Step> {
        None
    }
}

/// Piece over the crank angle, placed in the time of the run.
pub(super) struct AnglePiece {
    pub run: AngleRun,
    pub engine: Engine,
    pub from: Start,
    pub to: Start,
}

/// Reason for the end of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PieceEnd {
    /// The run reached its goal or cannot go on.
    Ended,
    /// The crank is clear of rest again.
    Clear,
    /// The engine cannot begin or go on.
    NotApplicable(NotApplicable),
}

#[derive(Default)]
pub(super) struct Arrived {
    pub now: Start,
    /// Last step, if the pass ended in time.
    pub last: Option<Step>,
    /// Whether the last piece followed the configuration curve.
    pub on_curve: bool,
    /// Last piece, if over the angle, until the next piece begins; after the pass, the piece if it is the only one.
    pub angle_piece: Option<AnglePiece>,
    /// Work of friction and of the loads without potential, J.
    pub work: f64,
    /// Largest kinetic energy at the ends of panels and steps, J.
    pub largest_kinetic: f64,
    pub evaluations: u64,
    pub steps: u64,
    /// Number of pieces over the angle, and number of pieces in time.
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
