//! Pieces in time along the configuration curve: past the limits of a crank, and where friction or a dry load may hold it.

use std::sync::Arc;

use super::super::configuration_curve::{self, Follow};
use super::super::stop_reason;
use super::arrived::End;
use super::clear::Clear;
use super::engine_loop::Pass;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::mechanism::CurveEquation;
use crate::numeric::angle::Angle;

/// The equation on the configuration curve, and the start of the run on it.
#[derive(Clone)]
pub(super) struct OnCurve {
    pub equation: Arc<CurveEquation>,
    pub start: Start,
}

impl Pass<'_, '_> {
    /// A piece along the curve, to the end or until the crank has turned by `wait` (rad) in one direction; whether it has.
    pub fn along_curve(&mut self, wait: f64) -> Result<bool, Error> {
        let course = self.course;
        let from = self.arrived.now;
        let OnCurve { equation, start } = course.on_curve()?;
        let equation = &**equation;
        let begins = self.arrived.over_angle + self.arrived.in_time == 0;
        let follow = Follow {
            equation,
            settings: Settings {
                max_evaluations: course.max_evaluations.saturating_sub(self.spent()),
                ..course.settings
            },
            // Only a crank that turns fully is handed over, and its angle is the coordinate.
            start: if begins { *start } else { from },
            turn_limit: course.extent.angle(),
            turned_from: course.task.start(),
        };
        let mut followed = None;
        let mut clear = Clear::new(course, from, wait);
        let mut back = false;
        self.sink
            .along_curve(equation, follow.start.angle, &mut |observer| {
                let mut until = Until {
                    observer,
                    clear: &mut clear,
                    back: &mut back,
                };
                followed = Some(follow.run(&mut until));
            });
        let Some(followed) = followed else {
            return Ok(false);
        };
        self.on_curve += followed.evaluations;
        let (angle, speed) = configuration_curve::crank_state(equation.curve(), &followed.last);
        let arrived = &mut self.arrived;
        arrived.steps += followed.steps;
        arrived.in_time += 1;
        arrived.work += followed.work;
        arrived.largest_kinetic = arrived.largest_kinetic.max(clear.largest_kinetic);
        arrived.now = Start {
            t: followed.last.end.t,
            angle,
            speed,
        };
        back &= followed.end == configuration_curve::End::Stopped;
        arrived.end = match &followed.end {
            _ if back => End::AtGoal,
            configuration_curve::End::Done | configuration_curve::End::AtRest
                if course.is_at_goal(&arrived.now) =>
            {
                End::AtGoal
            }
            configuration_curve::End::Integrator(finish) => End::Integrator(*finish),
            _ => End::Elsewhere,
        };
        arrived.last = Some(followed.last);
        arrived.on_curve = Some(followed);
        Ok(back)
    }
}

impl super::engine_loop::Course<'_> {
    /// The curve through the start.
    pub fn on_curve(&self) -> Result<&OnCurve, Error> {
        if let Some(curve) = self.curve.get() {
            return Ok(curve);
        }
        let task = self.task;
        let (equation, start) = configuration_curve::through_start(task)
            .ok_or_else(|| stop_reason::no_start(task.start(), task.scene.motion.speed))?;
        let equation = Arc::new(equation);
        Ok(self.curve.get_or_init(|| OnCurve { equation, start }))
    }
}

/// Ends a piece along the curve when the crank turns again.
struct Until<'a, 'o, 'c> {
    observer: &'o mut dyn configuration_curve::Observer,
    clear: &'a mut Clear<'c>,
    back: &'a mut bool,
}

impl configuration_curve::Observer for Until<'_, '_, '_> {
    fn step(&mut self, step: &Step, phase: configuration_curve::Phase) -> bool {
        let ends = self.observer.step(step, phase);
        *self.back = !ends && self.clear.is_reached(step);
        ends || *self.back
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        self.observer.event(kind, t, angle, speed);
    }
}
