//! Output rows: the state of the mechanism at one time.

use crate::error::Error;
use crate::mechanism::Reactions;

/// One output row, SI and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// s
    pub t: f64,
    /// rad, unwrapped
    pub theta: f64,
    /// rad/s
    pub omega: f64,
    /// rad/s²
    pub alpha: f64,
    /// Slider position, m
    pub x: f64,
    /// Slider velocity, m/s
    pub v: f64,
    /// Slider acceleration, m/s²
    pub a: f64,
    /// Rod inclination, rad
    pub phi: f64,
    /// Joint and guide forces, if asked for.
    pub reactions: Option<Reactions>,
    /// Torque that drives the crank beside the loads, N m, if asked for.
    pub driving_torque: Option<f64>,
    /// What a loose joint does, if there is one; `x`, `v`, `a` and `phi` are then those of the free rod.
    pub clearance: Option<LooseRow>,
}

/// A loose joint at one time, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LooseRow {
    /// Position (m), velocity (m/s) and acceleration (m/s²) of the slider with ideal joints, at the same
    /// crank motion
    pub ideal: [f64; 3],
    /// Centre of the journal from the centre of the bearing, m
    pub journal: [f64; 2],
    /// Normal force in the joint, N
    pub force: f64,
}

/// Takes the rows of a run as they are computed.
pub trait RowSink {
    /// Whether rows are wanted at all; if not, none are computed.
    fn wants_rows(&self) -> bool {
        true
    }

    /// Takes one row.
    ///
    /// # Errors
    /// An error ends the run.
    fn row(&mut self, row: &Row) -> Result<(), Error>;

    /// Whether states at steps of the computation are wanted too, where a joint is loose: its impacts are shorter than the
    /// time between rows.
    fn wants_steps(&self) -> bool {
        false
    }

    /// Takes the state at a step of the computation.
    ///
    /// # Errors
    /// An error ends the run.
    fn step(&mut self, _: &Row) -> Result<(), Error> {
        Ok(())
    }
}

/// No rows.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoRows;

impl RowSink for NoRows {
    fn wants_rows(&self) -> bool {
        false
    }

    fn row(&mut self, _: &Row) -> Result<(), Error> {
        Ok(())
    }
}

impl RowSink for Vec<Row> {
    fn row(&mut self, row: &Row) -> Result<(), Error> {
        self.push(*row);
        Ok(())
    }
}
