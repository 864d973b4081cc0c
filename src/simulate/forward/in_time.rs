//! Pieces in time, with the crank angle as the coordinate where it is smooth and turns fully, otherwise along the
//! configuration curve, past the limits of a crank and where friction or a dry load may hold it.

use std::borrow::Cow;

use super::super::configuration_curve::{self, CurveRun, End, Observer, OnCurve, Piece};
use super::super::stop;
use super::arrived::PieceEnd;
use super::clear::Until;
use super::engine_loop::{Course, Pass};
use super::stop_reason;
use crate::engine::Counted;
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
        let clear = until.clear;
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
        arrived.largest_kinetic = arrived.largest_kinetic.max(clear.largest_kinetic);
        arrived.impossible = piece.impossible;
        arrived.on_curve = on.is_some();
        arrived.last = Some(piece.last);
        if clear.is_reached && matches!(piece.end, End::Stopped) {
            arrived.end = End::Done;
            arrived.now.angle = arrived.now.angle.reduced();
            return Ok(PieceEnd::Clear);
        }
        arrived.end = match (piece.end, course.extent) {
            (End::Done, Extent::Revolutions(turns)) if arrived.now.t >= time::FAR => {
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
) -> Piece {
    let (finish, last, steps) =
        time::run(motion, from, settings, &mut |step| until.step(step, None));
    let impossible = motion.impossible();
    Piece {
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
