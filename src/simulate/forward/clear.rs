//! When a crank that was near to rest turns safely again.

use std::f64::consts::TAU;

use super::engine_loop::Course;
use crate::engine::angle::Driven;
use crate::engine::step::Step;
use crate::engine::time::Start;
use crate::numeric::angle::Angle;
use crate::scene::Extent;

/// With less than this part of the largest kinetic energy since it turned the crank is not handed over.
const FAST: f64 = 0.25;
/// A hand-over keeps this far from corners, rad: they may be events.
const APART: f64 = 1e-6;
/// Fewer turns than this before the end do not pay.
const FEW_TURNS: f64 = 2.0;

/// Follows a crank in time.
pub(super) struct Clear<'a> {
    course: &'a Course<'a>,
    wait: f64,
    /// Where it turned last.
    turned: Angle,
    /// Largest kinetic energy since then, J.
    since: f64,
    /// Largest kinetic energy of all, J.
    pub largest_kinetic: f64,
}

impl<'a> Clear<'a> {
    pub fn new(course: &'a Course<'a>, from: Start, wait: f64) -> Clear<'a> {
        Clear {
            course,
            wait,
            turned: from.angle,
            since: 0.0,
            largest_kinetic: 0.0,
        }
    }

    /// Whether the angle may take over at the end of a step.
    pub fn is_reached(&mut self, step: &Step) -> bool {
        if self.wait == f64::INFINITY {
            return false;
        }
        let end = &step.end;
        let angle = step.angle(end.theta);
        let kinetic = self
            .course
            .task
            .equation()
            .kinetic_energy(angle.rest, end.omega);
        self.largest_kinetic = self.largest_kinetic.max(kinetic);
        if step.start.omega * end.omega <= 0.0 {
            (self.turned, self.since) = (angle, 0.0);
        }
        self.since = self.since.max(kinetic);
        angle.minus(self.turned).abs() >= self.wait
            && kinetic >= FAST * self.since
            && self.is_apart(angle)
            && self.pays(end.t, angle, end.omega)
    }

    fn is_apart(&self, angle: Angle) -> bool {
        let corners = self.course.position.corners_if_light().iter();
        corners
            .map(|corner| (angle.rest - corner).rem_euclid(TAU))
            .all(|ahead| ahead.min(TAU - ahead) > APART)
    }

    fn pays(&self, t: f64, angle: Angle, speed: f64) -> bool {
        let turns = match self.course.extent {
            Extent::Duration(duration) => speed.abs() * (duration - t) / TAU,
            Extent::Revolutions(turns) => {
                let turned = angle.minus(self.course.task.start());
                turns - speed.signum() * turned / TAU
            }
        };
        turns >= FEW_TURNS
    }
}
