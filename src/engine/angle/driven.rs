//! What the engine needs of a mechanism.

use std::cell::RefCell;

use super::Table;
use super::panel::PanelTable;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Values;
use crate::numeric::enclosure::{Detail, Reach};

/// A state of the crank at a position of a table.
#[derive(Clone, Copy)]
pub struct State<'a, P> {
    pub place: &'a P,
    /// s
    pub t: f64,
    pub angle: Angle,
    /// rad/s
    pub speed: f64,
}

/// What the engine needs of a mechanism.
pub trait Driven {
    /// What the loads need to know of a position.
    type Place: Copy;

    /// Fills a table at the first `count` of some angles, rad, beside these whole turns, where the switch has the sign
    /// `side`, ±1.
    fn tabulate(
        &self,
        turns: f64,
        angles: (&Values, usize),
        side: f64,
        table: &mut Table<Self::Place>,
    );

    /// Where the panels of a run are left for the next one from the same angle; none where each run stands alone.
    fn shared(&self) -> Option<&RefCell<Panels<Self::Place>>>;

    /// How many positions were tabulated so far.
    fn positions(&self) -> u64;

    /// Whole turns after which everything that depends on the angle is the same again.
    fn cycle(&self) -> u32;

    /// Whether there are loads beside those of the table.
    fn is_driven(&self) -> bool;

    /// Whether these depend on time.
    fn reads_time(&self) -> bool;

    /// Their generalized force, N m, in some states.
    fn drive<const N: usize>(&self, at: &[State<'_, Self::Place>; N]) -> [f64; N];

    /// Whether they may do something between the points of a panel that the decay of their series does not tell.
    fn has_detail(&self) -> bool;

    /// What their generalized force (N m) does on a piece of the motion, and in a Bernstein ellipse of this size around it.
    fn detail(&self, reach: &Reach, ellipse: f64) -> Detail;

    /// Their part of the switch.
    fn drive_switch(&self, at: &State<'_, Self::Place>) -> f64;

    /// Angles of a cycle from zero on, in rising order, at which panels end.
    fn corners(&self) -> &[f64];

    /// Corners and other angles, at which panels end too where the inertia nearly vanishes there: longer ones would not be
    /// resolved.
    fn corners_if_light(&self) -> &[f64];
}

/// The panels of a run, for the next one from the same angle in the same direction: what depends on the position is tabulated,
/// and the next run sets out from its profiles.
pub struct Panels<P>(pub(super) Vec<PanelTable<P>>);

impl<P> Default for Panels<P> {
    fn default() -> Panels<P> {
        Panels(Vec::new())
    }
}
