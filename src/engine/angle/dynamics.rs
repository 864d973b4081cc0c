//! Interface of the angle engine to a mechanism.

use std::cell::RefCell;

use super::Table;
use super::panel::PanelTable;
use crate::engine::energy::Profile;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Values;
use crate::numeric::enclosure::{MotionPiece, Variation};

/// State of the crank at a tabulated position.
#[derive(Clone, Copy)]
pub struct State<'a, P> {
    pub place: &'a P,
    /// Time, s.
    pub t: f64,
    pub angle: Angle,
    /// Speed, rad/s.
    pub speed: f64,
}

/// Number with which state loads vary at a point of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateVariable {
    /// Time.
    Time,
    /// Kinetic energy, for loads that depend on the speed.
    Energy,
}

/// Equation of motion over the crank angle: tables of what depends on the position alone, and state loads, which are
/// evaluated at states. As a [`Profile`] it is the equation under loads of the angle alone.
pub trait Dynamics: Profile {
    /// Data of a position that the loads need.
    type Place: Copy;

    /// Fills a table at the first `count` angles (rad), plus whole turns, on the `side`, ±1, of the switch.
    fn fill_table(
        &self,
        turns: f64,
        angles: (&Values, usize),
        side: f64,
        table: &mut Table<Self::Place>,
    );

    /// Returns the store of panels that a run leaves to the next from the same angle; none where each run stands alone.
    fn shared(&self) -> Option<&RefCell<Panels<Self::Place>>>;

    /// Returns the number of positions tabulated to date.
    fn positions(&self) -> u64;

    /// Returns the number of turns after which everything that depends on the angle repeats.
    fn cycle(&self) -> u32;

    /// True if there are state loads, in addition to the loads of the table.
    fn has_state_loads(&self) -> bool;

    /// True if there are state loads that depend on time.
    fn reads_time(&self) -> bool;

    /// Returns the number with which the state loads vary at a position; none if there are several.
    fn state_variable(&self) -> Option<StateVariable>;

    /// Returns the generalized force of the state loads, N m, in each state.
    fn state_loads<const N: usize>(&self, at: &[State<'_, Self::Place>; N]) -> [f64; N];

    /// True if the state loads may vary between the points of a panel without a trace in the decay of their series.
    fn varies_between_nodes(&self) -> bool;

    /// Returns the variation of their generalized force, N m, on a piece and in its Bernstein ellipse, ρ = `ellipse`.
    fn variation(&self, reach: &MotionPiece, ellipse: f64) -> Variation;

    /// Returns the contribution of the state loads to the switch.
    fn switch_of_state_loads(&self, at: &State<'_, Self::Place>) -> f64;

    /// Returns the angles of a cycle, rad, from zero on, in rising order, at which panels end.
    fn corners_of_cycle(&self) -> &[f64];
}

/// Panels of a run, with tables and profiles, left to the next run from the same angle in the same direction.
pub struct Panels<P>(pub(super) Vec<PanelTable<P>>);

impl<P> Default for Panels<P> {
    fn default() -> Panels<P> {
        Panels(Vec::new())
    }
}
