//! Run over the angle: goal, resolution and result.

use super::Errors;
use super::cycle_panels::PanelShape;
use crate::engine::WorkLimit;
use crate::engine::energy::{NotApplicable, Orbit};
use crate::numeric::angle::Angle;

/// Condition that ends a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Time from the start of the run, s.
    Time(f64),
    /// Crank rotation from the start in the direction of motion, rad.
    Turned(f64),
}

/// Run up to its goal, or to where the angle can no longer be the independent variable.
#[derive(Debug)]
pub struct AngleRun {
    /// Motion, with time zero at its start.
    pub orbit: Orbit,
    /// Panels of a cycle; empty for a run by the Poincaré map.
    pub(super) shapes: Vec<PanelShape>,
    /// Last time, s.
    pub end: f64,
    /// Work of the non-conservative loads up to the end, J.
    pub work: f64,
    /// Propagated rounding errors.
    pub errors: Errors,
    /// Evaluations of the loads.
    pub evaluations: u64,
    /// End before the goal, if there was one.
    pub early_end: Option<EarlyEnd>,
}

impl AngleRun {
    /// Makes the result of a complete motion up to a time (s) under loads of the position alone.
    pub fn whole(orbit: Orbit, end: f64, work: f64) -> AngleRun {
        AngleRun {
            orbit,
            shapes: Vec::new(),
            end,
            work,
            errors: Errors::at(0.0, 0.0),
            evaluations: 0,
            early_end: None,
        }
    }
}

/// End of a run before its goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarlyEnd {
    /// Reason for the end.
    pub why: NotApplicable,
    /// Crank angle at the end.
    pub angle: Angle,
    /// Kinetic energy at the end, J.
    pub kinetic: f64,
}

/// Resolution of a run.
#[derive(Clone, Copy, Debug)]
pub struct Resolution<'a> {
    /// Largest tail of a resolved series.
    pub tail: f64,
    /// True for a second run: panels unlike those of the first, and the roundoff of both runs.
    pub is_second: bool,
    /// True if another engine may take over before the crank is slow.
    pub may_decline: bool,
    /// Run in one direction to compare with, if it is known.
    pub guide: Option<&'a AngleRun>,
    /// Limit of load evaluations and tabulated positions.
    pub limit: WorkLimit<'a>,
}
