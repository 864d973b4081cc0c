//! A finished run and its motion at any time.

use super::dense_rows::DenseRows;
use super::result::Summary;
use super::row::Row;
use crate::trajectory::Trajectory;

/// A finished run.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Key figures, error and events.
    pub summary: Summary,
    /// Dense motion, if it was recorded.
    pub trajectory: Option<Trajectory>,
    pub(super) dense: DenseRows,
}

impl Simulation {
    /// Unwrapped crank angle (rad) and speed (rad/s) at time `t` (s); none outside the run.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
        self.trajectory.as_ref()?.at(t)
    }

    /// The whole row at time `t` (s): crank and slider, their velocities and accelerations, and with
    /// [`Options::reactions`](super::Options::reactions) the joint forces. None outside the run, with a loose joint, and where a number is not
    /// finite.
    ///
    /// ```
    /// use slider_crank::scene::Scene;
    /// use slider_crank::simulate::{Options, simulate};
    /// let options = Options { reactions: true, ..Options::default() };
    /// let run = simulate(&Scene::duarte(), &options).unwrap();
    /// let row = run.row(0.5).unwrap();
    /// assert_eq!(run.at(0.5), Some((row.theta, row.omega)));
    /// println!("x = {} m, {:?} N at the wrist pin", row.x, row.reactions.unwrap().wrist_pin);
    /// ```
    pub fn row(&self, t: f64) -> Option<Row> {
        self.dense.row(self.trajectory.as_ref()?, t)
    }
}
