//! Pieces over the crank angle: of the energy engine, which computes a whole run or none, and of the angle engine.

use std::borrow::Cow;
use std::f64::consts::TAU;

use super::super::by_energy;
use super::super::configuration_curve::End;
use super::arrived::{Driven, Why};
use super::engine_loop::Pass;
use crate::engine::angle::{self, Driving, Goal, Resolution};
use crate::engine::energy::NotApplicable;
use crate::engine::time::Start;
use crate::error::Error;
use crate::plan::Engine;
use crate::scene::Extent;

impl Pass<'_, '_> {
    /// The whole run from its energy.
    pub fn by_energy(&mut self, reason: Cow<'static, str>) -> Result<Why, Error> {
        let solved = match by_energy::solve(self.course.task, self.course.position) {
            Ok(solved) => solved,
            Err(why) => return Ok(Why::NotApplicable(why)),
        };
        if let Some(why) = solved.stopped {
            self.arrived.end = End::Named(why.into());
        }
        let (angle, speed) = solved.driving.orbit.state(solved.driving.end);
        let to = Start {
            t: solved.driving.end,
            angle,
            speed,
        };
        self.drove(Engine::Energy, reason, solved.driving, to)?;
        Ok(Why::Ended)
    }

    /// A piece of the angle engine from here, to the goal or to where it cannot go on.
    pub fn by_angle(&mut self, reason: Cow<'static, str>) -> Result<Why, Error> {
        let course = self.course;
        let from = self.arrived.now;
        let driving = match self.drive() {
            // Past its limits a crank that does not turn fully is followed from the start.
            Ok(Driving {
                short: Some(short), ..
            }) if !course.task.turns_fully() => Err(short.why),
            driving => driving,
        };
        let driving = match driving {
            Ok(driving) => driving,
            Err(why) => {
                self.wait *= 2.0;
                return Ok(Why::NotApplicable(why));
            }
        };
        let short = driving.short;
        let t = match (course.extent, short) {
            (Extent::Duration(duration), None) => duration,
            _ => from.t + driving.end,
        };
        let (angle, speed) = match short {
            None => driving.orbit.state(driving.end),
            Some(short) => {
                let inertia = course.task.equation().terms(short.angle.rest).inertia.m;
                let speed = (2.0 * short.kinetic / inertia).sqrt();
                (short.angle.reduced(), from.speed.signum() * speed)
            }
        };
        if short.is_some() {
            let way = angle.minus(from.angle).abs();
            let soon = way < 2.0 * self.wait;
            self.wait = if soon { 2.0 * self.wait } else { course.wait };
        }
        self.drove(Engine::Angle, reason, driving, Start { t, angle, speed })?;
        Ok(short.map_or(Why::Ended, |short| Why::NotApplicable(short.why)))
    }

    fn drive(&self) -> Result<Driving, NotApplicable> {
        let course = self.course;
        let now = self.arrived.now;
        let goal = match course.extent {
            Extent::Duration(duration) => Goal::Time(duration - now.t),
            Extent::Revolutions(turns) => {
                let turned = now.angle.minus(course.task.start());
                Goal::Turned(turns * TAU - now.speed.signum() * turned)
            }
        };
        let resolution = Resolution {
            most_evaluations: self.left(),
            ..course.resolution
        };
        angle::run(course.position, now, goal, resolution)
    }

    /// Takes a piece.
    fn drove(
        &mut self,
        engine: Engine,
        reason: Cow<'static, str>,
        driving: Driving,
        to: Start,
    ) -> Result<(), Error> {
        self.keep();
        let arrived = &mut self.arrived;
        let from = arrived.now;
        self.beside += driving.evaluations;
        arrived.work += driving.work;
        arrived.steps += driving.orbit.panels() as u64;
        arrived.over_angle += 1;
        let largest = driving.orbit.largest_kinetic(driving.end);
        arrived.largest_kinetic = arrived.largest_kinetic.max(largest);
        (arrived.last, arrived.on_curve) = (None, false);
        arrived.now = to;
        let driven = Driven {
            driving,
            engine,
            from,
            to,
        };
        self.sink.begins(engine, from.t, reason);
        self.sink.over_angle(&driven)?;
        arrived.driven = Some(driven);
        Ok(())
    }

    /// Hands the motion of the last piece over the angle on, which another one follows.
    pub fn keep(&mut self) {
        if let Some(driven) = self.arrived.driven.take() {
            self.sink.keep(driven);
        }
    }
}
