//! Pieces in time, with the crank angle as the coordinate where it is smooth and turns fully, otherwise along the
//! configuration curve, past the limits of a crank and where friction or a dry load may hold it. Such a piece ends with
//! the run, or where a crank that was near to rest turns safely again.

use std::borrow::Cow;
use std::f64::consts::TAU;

use super::super::configuration_curve::{self, CurveRun, End, Observer, OnCurve, TimePiece};
use super::super::guide_friction::NEARBY_ANGLE;
use super::super::stick_slip::Phase;
use super::super::stop;
use super::arrived::{PieceEnd, Sink};
use super::engine_loop::{Course, Pass};
use super::stop_reason;
use crate::engine::Counted;
use crate::engine::angle::Dynamics;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::scene::Extent;

impl Pass<'_, '_> {
    /// Runs a piece in time, to the end or until the crank has turned by `wait` (rad) in one direction.
    pub fn in_time(&mut self, wait: f64, reason: Cow<'static, str>) -> Result<PieceEnd, Error> {
        self.keep();
        let course = self.course;
        let from = self.arrived.now;
        self.sink.begins(Engine::Time, from.t, reason);
        let on = match configuration_curve::is_followed(course.task) {
            true => Some(course.on_curve()?),
            false => None,
        };
        // Only a crank that turns fully changes engines, and the coordinate of its curve is the crank angle.
        let start = on.filter(|_| !self.has_begun()).map_or(from, |on| on.start);
        let settings = Settings {
            limit: match on {
                Some(_) => self.left(),
                // The evaluations of `motion` before this piece count as well.
                None => course.settings.limit.after(self.spent_beside()),
            },
            ..course.settings
        };
        self.sink.begin_in_time(start, on);
        let mut until = Until::new(course, from, wait, &mut *self.sink);
        let mut piece = match on {
            Some(on) => {
                let limit = course.extent.angle();
                let turning = limit.map(|limit| (course.task.start(), limit));
                CurveRun::new(&on.equation, settings, start, turning, &mut until).run()
            }
            None => of_crank(self.motion, from, &settings, &mut until),
        };
        let Until {
            is_clear,
            largest_kinetic,
            ..
        } = until;
        self.beside += piece.evaluations;
        if let Some(last) = self.sink.end_in_time(self.motion, &piece.last, &settings) {
            (piece.last, piece.work, piece.end) = (last, last.end.work, End::Done);
        }
        let end = &piece.last.end;
        let coordinate = Start {
            t: end.t,
            angle: piece.last.angle(end.theta),
            speed: end.omega,
        };
        let arrived = &mut self.arrived;
        arrived.now = on.map_or(coordinate, |on| {
            configuration_curve::crank_state(on.equation.curve(), coordinate)
        });
        arrived.steps += piece.steps;
        arrived.in_time += 1;
        arrived.work += piece.work;
        arrived.largest_kinetic = arrived.largest_kinetic.max(largest_kinetic);
        arrived.impossible = piece.impossible;
        arrived.on_curve = on.is_some();
        arrived.last = Some(piece.last);
        if is_clear && matches!(piece.end, End::Stopped) {
            arrived.end = End::Done;
            arrived.now.angle = arrived.now.angle.reduced();
            return Ok(PieceEnd::Clear);
        }
        arrived.end = match (piece.end, course.extent) {
            (End::Done, Extent::Revolutions(turns)) if arrived.now.t >= time::UNLIMITED_TIME => {
                End::Named(stop::Why::TurnsNeverComplete(turns).into())
            }
            (end, _) => end,
        };
        Ok(PieceEnd::Ended)
    }
}

/// Runs a piece with the crank angle as the coordinate; its evaluations are those of `motion`.
fn of_crank(
    motion: &Counted<'_>,
    from: Start,
    settings: &Settings<'_>,
    until: &mut Until<'_, '_>,
) -> TimePiece {
    let (finish, last, steps) =
        time::run(motion, from, settings, &mut |step| until.step(step, None));
    let impossible = motion.singular_state();
    TimePiece {
        last,
        work: last.end.work,
        steps,
        evaluations: 0,
        end: match finish {
            Finish::AtEnd => End::Done,
            Finish::Stopped => End::Stopped,
            finish => End::Integrator(finish),
        },
        impossible: impossible.map(|(t, angle, speed)| Start { t, angle, speed }),
    }
}

impl Course<'_> {
    /// Returns the curve through the start.
    fn on_curve(&self) -> Result<&OnCurve, Error> {
        if let Some(curve) = self.curve.get() {
            return Ok(curve);
        }
        let on = OnCurve::through_start(self.task);
        let on = on.ok_or_else(|| stop_reason::no_start(self.task))?;
        Ok(self.curve.get_or_init(|| on))
    }
}

/// Observer of a crank in time until it turns safely again.
struct Until<'a, 'o> {
    course: &'a Course<'a>,
    observer: &'o mut dyn Sink,
    wait: f64,
    /// Crank angle at the last turning point.
    turned: Angle,
    /// Largest kinetic energy since the last turning point, J.
    since: f64,
    /// Largest kinetic energy at the ends of steps, J.
    largest_kinetic: f64,
    /// Whether the angle engine may take over.
    is_clear: bool,
}

impl Observer for Until<'_, '_> {
    fn step(&mut self, step: &Step, phase: Option<Phase>) -> bool {
        let ends = self.observer.step(step, phase);
        self.is_clear = !ends && self.is_reached(step);
        ends || self.is_clear
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        self.observer.event(kind, t, angle, speed);
    }
}

impl<'a, 'o> Until<'a, 'o> {
    /// Observes from a state until the crank has turned by `wait` (rad) in one direction.
    fn new(
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
            largest_kinetic: 0.0,
            is_clear: false,
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
        self.largest_kinetic = self.largest_kinetic.max(kinetic);
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
