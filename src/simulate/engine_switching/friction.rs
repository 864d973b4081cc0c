//! Pieces in time with friction at the guide.

use super::super::configuration_curve;
use super::super::configuration_curve::Follow;
use super::super::guide_friction::Sliding;
use super::arrived::End;
use super::clear::Clear;
use super::course::Pass;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Settings, Start};
use crate::numeric::angle::Angle;

impl Pass<'_, '_> {
    /// A piece in time with friction, where the crank may stick and come to rest, until it has turned by `wait` (rad) in
    /// one direction; whether it has.
    pub fn with_friction(&mut self, sliding: &Sliding, wait: f64) -> bool {
        let course = self.course;
        let from = self.arrived.now;
        let follow = Follow {
            equation: sliding.equation(),
            settings: Settings {
                max_evaluations: course.max_evaluations.saturating_sub(self.spent()),
                ..course.settings
            },
            start: from,
            turn_limit: course.extent.angle(),
            turned_from: course.start.angle,
        };
        let mut rubbed = None;
        let mut clear = Clear::new(course, from, wait);
        let mut back = false;
        self.observer.with_friction(&mut |observer| {
            let mut until = Until {
                observer,
                clear: &mut clear,
                back: &mut back,
            };
            rubbed = Some(follow.run(&mut until));
        });
        let Some(rubbed) = rubbed else {
            return false;
        };
        self.rubbing += rubbed.evaluations;
        let last = rubbed.last;
        let arrived = &mut self.arrived;
        arrived.steps += rubbed.steps;
        arrived.in_time += 1;
        arrived.work += rubbed.work;
        arrived.largest_kinetic = arrived.largest_kinetic.max(clear.largest_kinetic);
        arrived.now = Start {
            t: last.end.t,
            angle: last.angle(last.end.theta).reduced(),
            speed: last.end.omega,
        };
        back &= rubbed.end == configuration_curve::End::Stopped;
        if !back {
            arrived.end = match &rubbed.end {
                configuration_curve::End::Done | configuration_curve::End::AtRest
                    if course.is_at_goal(&arrived.now) =>
                {
                    End::AtGoal
                }
                configuration_curve::End::Integrator(finish) => End::Integrator(*finish),
                _ => End::Integrator(Finish::Stopped),
            };
        }
        arrived.last = Some(last);
        arrived.rubbed = Some(rubbed);
        back
    }
}

/// Ends a piece in time with friction when the crank turns again.
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
