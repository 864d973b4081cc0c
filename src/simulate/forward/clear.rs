//! Hand-over from time to angle: detects that a crank that was near to rest turns safely again.

use std::f64::consts::TAU;

use super::super::configuration_curve::Observer;
use super::super::guide_friction::NEARBY_ANGLE;
use super::super::stick_slip::Phase;
use super::arrived::Sink;
use super::engine_loop::Course;
use crate::engine::angle::Driven;
use crate::engine::step::Step;
use crate::engine::time::Start;
use crate::numeric::angle::Angle;

/// Observer of a crank in time until it turns safely again.
pub(super) struct Until<'a, 'o> {
    course: &'a Course<'a>,
    observer: &'o mut dyn Sink,
    wait: f64,
    /// Crank angle at the last turning point.
    turned: Angle,
    /// Largest kinetic energy since the last turning point, J.
    since: f64,
    pub clear: Clear,
}

/// State of the hand-over.
#[derive(Clone, Copy, Default)]
pub(super) struct Clear {
    /// Whether the angle engine may take over.
    pub is_reached: bool,
    /// Largest kinetic energy at the ends of steps, J.
    pub largest_kinetic: f64,
}

impl Observer for Until<'_, '_> {
    fn step(&mut self, step: &Step, phase: Option<Phase>) -> bool {
        let ends = self.observer.step(step, phase);
        self.clear.is_reached = !ends && self.is_reached(step);
        ends || self.clear.is_reached
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        self.observer.event(kind, t, angle, speed);
    }
}

impl<'a, 'o> Until<'a, 'o> {
    /// Observes from a state until the crank has turned by `wait` (rad) in one direction.
    pub fn new(
        course: &'a Course<'a>,
        from: Start,
        wait: f64,
        observer: &'o mut dyn Sink,
    ) -> Until<'a, 'o> {
        Until {
            course,
            observer,
            wait,
            turned: from.angle,
            since: 0.0,
            clear: Clear::default(),
        }
    }

    /// Whether the angle engine may take over at the end of a step.
    fn is_reached(&mut self, step: &Step) -> bool {
        if self.wait == f64::INFINITY {
            return false;
        }
        let end = &step.end;
        let angle = step.angle(end.theta);
        let equation = self.course.task.equation();
        let kinetic = equation.kinetic_energy(angle.rest, end.omega);
        self.clear.largest_kinetic = self.clear.largest_kinetic.max(kinetic);
        if step.start.omega * end.omega <= 0.0 {
            (self.turned, self.since) = (angle, 0.0);
        }
        self.since = self.since.max(kinetic);
        // Part of the largest energy since then: a slower crank may be near to rest, where the angle does not serve.
        let fast = 0.25;
        angle.minus(self.turned).abs() >= self.wait
            && kinetic >= fast * self.since
            && self.is_apart(angle)
    }

    /// Whether an angle is apart from all corners, as they may be events.
    fn is_apart(&self, angle: Angle) -> bool {
        let corners = self.course.model.corners_if_light().iter();
        corners
            .map(|corner| (angle.rest - corner).rem_euclid(TAU))
            .all(|ahead| ahead.min(TAU - ahead) > NEARBY_ANGLE)
    }
}
