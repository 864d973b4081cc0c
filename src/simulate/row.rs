//! Output rows: the state of the mechanism at one time.

use crate::error::Error;
use crate::mechanism::Reactions;

/// Output row: state of the mechanism at one time, in SI units and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time, s.
    pub t: f64,
    /// Crank angle, rad, unwrapped.
    pub theta: f64,
    /// Crank speed, rad/s.
    pub omega: f64,
    /// Crank acceleration, rad/s².
    pub alpha: f64,
    /// Slider position, m
    pub x: f64,
    /// Slider velocity, m/s
    pub v: f64,
    /// Slider acceleration, m/s²
    pub a: f64,
    /// Rod inclination, rad
    pub phi: f64,
    /// Joint and guide forces, N, if asked for.
    pub reactions: Option<Reactions>,
    /// Torque that drives the crank in addition to the loads, N m, if asked for.
    pub driving_torque: Option<f64>,
    /// State of the loose joint, if there is one; `x`, `v`, `a` and `phi` then belong to the free rod.
    pub clearance: Option<LooseRow>,
}

/// Loose joint at one time, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LooseRow {
    /// Position (m), velocity (m/s) and acceleration (m/s²) of a slider with ideal joints at this crank motion.
    pub ideal: [f64; 3],
    /// Position of the journal centre relative to the bearing centre, m.
    pub journal: [f64; 2],
    /// Normal force in the joint, N.
    pub force: f64,
}

/// Receiver of the rows of a run, as they are computed.
pub trait RowSink {
    /// Whether rows are wanted; if not, none are computed.
    fn wants_rows(&self) -> bool {
        true
    }

    /// Takes one row.
    ///
    /// # Errors
    /// An error ends the run.
    fn row(&mut self, row: &Row) -> Result<(), Error>;

    /// Whether states at steps of the computation are wanted in addition: impacts in a loose joint are shorter than the
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

/// Receiver that wants no rows.
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
