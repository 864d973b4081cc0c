//! Pieces in time, of a crank that is smooth and turns fully; others follow the configuration curve.

use std::borrow::Cow;

use super::super::configuration_curve;
use super::arrived::{End, Why};
use super::clear::Clear;
use super::engine_loop::Pass;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::plan::Engine;

impl Pass<'_, '_> {
    /// A piece in time, to the end or until the crank has turned by `wait` (rad) in one direction.
    pub fn in_time(&mut self, wait: f64, reason: Cow<'static, str>) -> Result<Why, Error> {
        self.keep();
        let from = self.arrived.now;
        self.sink.begins(Engine::Time, from.t, reason);
        let back = match configuration_curve::serves(self.course.task) {
            true => self.along_curve(wait)?,
            false => self.of_crank(wait),
        };
        if back {
            self.arrived.now.angle = self.arrived.now.angle.reduced();
            return Ok(Why::Clear);
        }
        Ok(Why::Ended)
    }

    /// With the crank angle as the coordinate; whether the angle may take over.
    fn of_crank(&mut self, wait: f64) -> bool {
        let course = self.course;
        let from = self.arrived.now;
        let evaluations = course.max_evaluations.saturating_sub(self.spent());
        let settings = Settings {
            max_evaluations: self.motion.evaluations() + evaluations,
            ..course.settings
        };
        let mut clear = Clear::new(course, from, wait);
        self.sink.begin_in_time(from);
        let sink = &mut *self.sink;
        let mut back = false;
        let (mut finish, mut last, steps) = time::run(self.motion, from, &settings, &mut |step| {
            let ends = sink.step(step);
            back = !ends && clear.is_reached(step);
            ends || back
        });
        if let Some(shortened) = self.sink.end_in_time(self.motion, &last, &settings) {
            (finish, last) = (Finish::AtEnd, shortened);
        }
        let arrived = &mut self.arrived;
        arrived.steps += steps;
        arrived.in_time += 1;
        arrived.work += last.end.work;
        arrived.largest_kinetic = arrived.largest_kinetic.max(clear.largest_kinetic);
        arrived.now = Start {
            t: last.end.t,
            angle: last.angle(last.end.theta),
            speed: last.end.omega,
        };
        arrived.last = Some(last);
        back &= finish == Finish::Stopped;
        arrived.end = match finish {
            _ if back => End::AtGoal,
            Finish::AtEnd if course.is_at_goal(&arrived.now) => End::AtGoal,
            finish => End::Integrator(finish),
        };
        back
    }
}
