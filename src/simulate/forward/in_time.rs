//! Pieces in time, with the crank angle as the coordinate where it is smooth and turns fully, otherwise along the
//! configuration curve, past the limits of a crank and where friction or a dry load may hold it.

use std::borrow::Cow;

use super::super::configuration_curve::{self, CurveRun, End, Observer, OnCurve, Piece};
use super::super::stop;
use super::arrived::PieceEnd;
use super::clear::{Clear, Until};
use super::engine_loop::{Course, Pass};
use super::stop_reason;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::plan::Engine;
use crate::scene::Extent;

impl Pass<'_, '_> {
    /// Runs a piece in time, to the end or until the crank has turned by `wait` (rad) in one direction.
    pub fn in_time(&mut self, wait: f64, reason: Cow<'static, str>) -> Result<PieceEnd, Error> {
        self.keep();
        let course = self.course;
        let from = self.arrived.now;
        self.sink.begins(Engine::Time, from.t, reason);
        let on = match configuration_curve::serves(course.task) {
            true => Some(course.on_curve()?),
            false => None,
        };
        let (piece, clear) = match on {
            Some(on) => self.along_curve(on, wait),
            None => self.of_crank(wait),
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
        let back = clear.is_reached && matches!(piece.end, End::Stopped);
        arrived.end = match (piece.end, course.extent) {
            (End::Stopped, _) if back => End::Done,
            (End::Done, Extent::Revolutions(turns)) if arrived.now.t >= time::UNLIMITED_TIME => {
                End::Named(stop::Why::TurnsNeverComplete(turns).into())
            }
            (end, _) => end,
        };
        if back {
            arrived.now.angle = arrived.now.angle.reduced();
            return Ok(PieceEnd::Clear);
        }
        Ok(PieceEnd::Ended)
    }

    /// Runs a piece with the crank angle as the coordinate.
    fn of_crank(&mut self, wait: f64) -> (Piece, Clear) {
        let from = self.arrived.now;
        let settings = Settings {
            // The evaluations of `motion` before this piece count as well.
            limit: self.course.settings.limit.after(self.spent_beside()),
            ..self.course.settings
        };
        self.sink.begin_in_time(from, None);
        let mut until = Until::new(self.course, from, wait, &mut *self.sink);
        let (finish, last, steps) = time::run(self.motion, from, &settings, &mut |step| {
            until.step(step, None)
        });
        let clear = until.clear;
        let shortened = self.sink.end_in_time(self.motion, &last, &settings);
        let end = match finish {
            _ if shortened.is_some() => End::Done,
            Finish::AtEnd => End::Done,
            Finish::Stopped => End::Stopped,
            finish => End::Integrator(finish),
        };
        let last = shortened.unwrap_or(last);
        let impossible = self.motion.singular_state();
        let piece = Piece {
            last,
            work: last.end.work,
            steps,
            evaluations: 0,
            end,
            impossible: impossible.map(|(t, angle, speed)| Start { t, angle, speed }),
        };
        (piece, clear)
    }

    /// Runs a piece along the configuration curve.
    fn along_curve(&mut self, on: &OnCurve, wait: f64) -> (Piece, Clear) {
        let course = self.course;
        let begins = self.arrived.over_angle + self.arrived.in_time == 0;
        let settings = Settings {
            limit: self.left(),
            ..course.settings
        };
        // Only a crank that turns fully changes engines, and the coordinate of its curve is the crank angle.
        let start = if begins { on.start } else { self.arrived.now };
        let limit = course.extent.angle();
        let turning = limit.map(|limit| (course.task.start(), limit));
        self.sink.begin_in_time(start, Some(on));
        let mut until = Until::new(course, self.arrived.now, wait, &mut *self.sink);
        let piece = CurveRun::new(&on.equation, settings, start, turning, &mut until).run();
        let clear = until.clear;
        self.beside += piece.evaluations;
        self.sink.end_in_time(self.motion, &piece.last, &settings);
        (piece, clear)
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
