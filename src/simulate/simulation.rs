//! Finished run, with the state and the row at any time.

use std::sync::Arc;

use super::result::Summary;
use super::row::{Row, RowMaker};
use super::stick_slip::{CurveMotion, StickSlipPhase};
use crate::mechanism::CurveEquation;
use crate::trajectory::Trajectory;

/// Finished run.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Key figures, errors and events.
    pub summary: Summary,
    /// Dense motion, if it was recorded.
    pub trajectory: Option<Trajectory>,
    /// Work of friction and of the loads without potential, J, if the motion was integrated.
    pub(super) work: Option<f64>,
    /// Maker of rows; none with a loose joint.
    pub(super) maker: Option<RowMaker>,
    /// Configuration curve of the phases; its coordinate is the crank angle if engines took turns.
    pub(super) curve: Option<Arc<CurveEquation>>,
    /// Intervals of motion along a configuration curve, in order.
    pub(super) phases: Vec<PhaseInterval>,
}

impl Simulation {
    /// Returns the unwrapped crank angle (rad) and the crank speed (rad/s) at time `t` (s); none outside the run.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
        self.trajectory.as_ref()?.at(t)
    }

    /// Returns the row at time `t` (s): position, velocity and acceleration of crank and slider, and the joint forces
    /// if [`Options::reactions`](super::Options::reactions) is set. None outside the run, with a loose joint, and where
    /// a number is not finite.
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
        let maker = self.maker.as_ref()?;
        let trajectory = self.trajectory.as_ref()?;
        let (angle, speed) = trajectory.coordinate(t)?;
        let after = self.phases.partition_point(|interval| interval.until < t);
        let interval = self.phases.get(after);
        let interval = interval.filter(|interval| interval.from <= t);
        let row = match interval {
            Some(interval) => {
                let (equation, phase) = (self.curve.as_deref()?, interval.phase);
                CurveMotion { equation, phase }.row(maker, t, angle, speed)
            }
            None => {
                let alpha = trajectory.as_uniform().map(|_| 0.0);
                maker.row(t, angle, speed, alpha)
            }
        };
        [row.theta, row.omega, row.alpha, row.x, row.v, row.a]
            .iter()
            .all(|number| number.is_finite())
            .then_some(row)
    }
}

/// Interval of time in which the slider is in one phase in its guide, on the configuration curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhaseInterval {
    /// First time, s.
    pub from: f64,
    /// Last time, s.
    pub until: f64,
    pub phase: StickSlipPhase,
}
