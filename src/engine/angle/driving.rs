//! A run over the angle: its goal, how fine it is, and where it came to.

use super::swept::Spent;
use super::{Errors, Guide};
use crate::engine::WorkLimit;
use crate::engine::energy::segment::Segment;
use crate::engine::energy::{NotApplicable, Orbit};
use crate::numeric::angle::Angle;

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// This long after its start, s.
    Time(f64),
    /// When the crank has turned by this, rad, in its direction.
    Turned(f64),
}

/// A run, to its goal or to where the angle cannot be the independent variable any more.
pub struct Driving {
    /// Motion, whose own time begins at 0.
    pub orbit: Orbit,
    /// Last time, s.
    pub end: f64,
    /// Work of the loads without a potential until its end, J.
    pub work: f64,
    /// What rounding does to it.
    pub errors: Errors,
    /// How often the loads were evaluated.
    pub evaluations: u64,
    /// What kept it from its goal.
    pub short: Option<Short>,
}

impl Driving {
    /// A whole motion until a time (s), which needed no loads of state or time.
    pub fn whole(orbit: Orbit, end: f64, work: f64) -> Driving {
        Driving {
            orbit,
            end,
            work,
            errors: Errors::at(0.0, 0.0),
            evaluations: 0,
            short: None,
        }
    }
}

/// Where a run ended before its goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short {
    /// Why it did.
    pub why: NotApplicable,
    /// The angle there.
    pub angle: Angle,
    /// Kinetic energy there, J.
    pub kinetic: f64,
}

/// How fine the panels are.
#[derive(Clone, Copy, Debug)]
pub struct Resolution<'a> {
    /// Series end where their coefficients have decayed to this.
    pub tail: f64,
    /// Panels are cut unevenly once more from the start, which makes another discretization to compare with.
    pub other: bool,
    /// The run that is compared, if it is known.
    pub guide: Option<Guide<'a>>,
    /// On evaluations of the loads and positions in tables.
    pub limit: WorkLimit<'a>,
}

/// Turns that are run through one by one before the map of a cycle takes over, and where it ends; turns between those whose
/// starts are kept.
pub(super) const FEW_TURNS: f64 = 48.0;

/// Work from the begin of the last panel until a time in it.
pub(super) fn work_until(leg: &Segment, until: f64, spent: &Spent) -> f64 {
    let Some((panel, since)) = leg.panel_at(until) else {
        return 0.0;
    };
    spent.work(panel.rule, panel.piece.span(), panel.position(since))
}
