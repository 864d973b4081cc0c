//! Pieces in time: with the crank angle as the coordinate where it is smooth and turns fully, else along the configuration
//! curve, past the limits of a crank and where friction or a dry load may hold it.

use std::borrow::Cow;

use super::super::configuration_curve::{self, End, Follow, Observer, OnCurve, Piece};
use super::super::stick_slip::Phase;
use super::super::stop;
use super::arrived::Why;
use super::clear::Clear;
use super::engine_loop::{Course, Pass};
use super::stop_reason;
use crate::engine::WorkLimit;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::scene::Extent;

impl Pass<'_, '_> {
    /// A piece in time, to the end or until the crank has turned by `wait` (rad) in one direction.
    pub fn in_time(&mut self, wait: f64, reason: Cow<'static, str>) -> Result<Why, Error> {
        self.keep();
        let course = self.course;
        let from = self.arrived.now;
        self.sink.begins(Engine::Time, from.t, reason);
        let on = match configuration_curve::serves(course.task) {
            true => Some(course.on_curve()?),
            false => None,
        };
        let mut clear = Clear::new(course, from, wait);
        let (piece, back) = match on {
            Some(on) => self.along_curve(on, &mut clear),
            None => self.of_crank(&mut clear),
        };
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
        arrived.largest_kinetic = arrived.largest_kinetic.max(clear.largest_kinetic);
        arrived.impossible = piece.impossible;
        arrived.on_curve = on.is_some();
        arrived.last = Some(piece.last);
        arrived.end = match (piece.end, course.extent) {
            (End::Stopped, _) if back => End::Done,
            (End::Done, Extent::Revolutions(turns)) if arrived.now.t >= time::FAR => {
                End::Named(stop::Why::Turns(turns).into())
            }
            (end, _) => end,
        };
        if back {
            arrived.now.angle = arrived.now.angle.reduced();
            return Ok(Why::Clear);
        }
        Ok(Why::Ended)
    }

    /// With the crank angle as the coordinate; whether the angle may take over.
    fn of_crank(&mut self, clear: &mut Clear<'_>) -> (Piece, bool) {
        let from = self.arrived.now;
        let settings = Settings {
            limit: WorkLimit {
                evaluations: self.motion.evaluations() + self.left().evaluations,
                ..self.left()
            },
            ..self.course.settings
        };
        self.sink.begin_in_time(from, None);
        let mut until = Until {
            observer: &mut *self.sink,
            clear,
            back: false,
        };
        let (mut finish, mut last, steps) = time::run(self.motion, from, &settings, &mut |step| {
            until.step(step, None)
        });
        let back = until.back && finish == Finish::Stopped;
        if let Some(shortened) = self.sink.end_in_time(self.motion, &last, &settings) {
            (finish, last) = (Finish::AtEnd, shortened);
        }
        let impossible = self.motion.impossible();
        let piece = Piece {
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
        };
        (piece, back)
    }

    /// Along the curve; whether the angle may take over.
    fn along_curve(&mut self, on: &OnCurve, clear: &mut Clear<'_>) -> (Piece, bool) {
        let course = self.course;
        let begins = self.arrived.over_angle + self.arrived.in_time == 0;
        let follow = Follow {
            equation: &on.equation,
            settings: Settings {
                limit: self.left(),
                ..course.settings
            },
            // Only a crank that turns fully is handed over, and its angle is the coordinate.
            start: if begins { on.start } else { self.arrived.now },
            turn_limit: course.extent.angle(),
            turned_from: course.task.start(),
        };
        self.sink.begin_in_time(follow.start, Some(on));
        let mut until = Until {
            observer: &mut *self.sink,
            clear,
            back: false,
        };
        let piece = follow.run(&mut until);
        let back = until.back && matches!(piece.end, End::Stopped);
        self.beside += piece.evaluations;
        self.sink
            .end_in_time(self.motion, &piece.last, &follow.settings);
        (piece, back)
    }
}

impl Course<'_> {
    /// The curve through the start.
    fn on_curve(&self) -> Result<&OnCurve, Error> {
        if let Some(curve) = self.curve.get() {
            return Ok(curve);
        }
        let on = OnCurve::through_start(self.task);
        let on = on.ok_or_else(|| stop_reason::no_start(self.task))?;
        Ok(self.curve.get_or_init(|| on))
    }
}

/// Ends a piece when the crank turns safely again.
struct Until<'a, 'c, O: Observer + ?Sized> {
    observer: &'a mut O,
    clear: &'a mut Clear<'c>,
    back: bool,
}

impl<O: Observer + ?Sized> Observer for Until<'_, '_, O> {
    fn step(&mut self, step: &Step, phase: Option<Phase>) -> bool {
        let ends = self.observer.step(step, phase);
        self.back = !ends && self.clear.is_reached(step);
        ends || self.back
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        self.observer.event(kind, t, angle, speed);
    }
}
