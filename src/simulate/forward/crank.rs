//! The crank angle as the coordinate of a step.

use super::super::recorder::Coordinate;
use super::super::row::{Row, RowMaker};
use crate::engine::events::Crossing;
use crate::engine::step::Step;
use crate::engine::{Counted, Motion};
use crate::numeric::angle::Angle;

/// The crank angle as the coordinate of a step.
pub(super) struct Crank<'a> {
    pub maker: &'a RowMaker,
    pub motion: &'a Counted<'a>,
    pub start: Angle,
    pub crossings: &'a [(f64, Crossing)],
}

impl Coordinate for Crank<'_> {
    fn motion(&self) -> &dyn Motion {
        self.motion
    }

    fn turned(&self, step: &Step, t: f64) -> f64 {
        step.angle(step.at(t).0).minus(self.start)
    }

    fn time_of(&self, step: &Step, turned: f64, [from, to]: [f64; 2]) -> Option<f64> {
        let at_start = step.angle(step.start.theta).minus(self.start);
        let theta = step.start.theta + (turned - at_start);
        step.time_of_angle(theta, from, to)
    }

    fn turning_times(&self, _: &Step) -> Vec<f64> {
        let crossings = self.crossings.iter();
        let turning = crossings.filter(|(_, what)| *what == Crossing::Turning);
        turning.map(|(t, _)| *t).collect()
    }

    fn row(&self, t: f64, angle: Angle, speed: f64) -> Row {
        self.maker.row(t, angle, speed, None)
    }
}
