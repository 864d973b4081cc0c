//! Pieces in time, with the crank angle as the coordinate where it is smooth and turns fully, otherwise along the
//! configuration curve, past the limits of a crank and where friction or a dry load may hold it. Such a piece ends with
//! the run, or where a crank that was near to rest turns safely again.

use super::super::configuration_curve::{
    self, CurveProblem, CurveRun, EndReason, StepObserver, TimePiece,
};
use super::super::coordinate::{Coordinate, crank_state};
use super::super::guide_friction::NEARBY_ANGLE;
use super::engine_loop::{Pass, PassObserver, PassSettings, PieceEnd, Reason};
use super::stop_reason;
use crate::engine::Counted;
use crate::engine::step::{Node, Step};
use crate::engine::time::{self, Finish, MotionState, Settings};
use crate::error::Error;
use crate::numeric::angle::{Angle, circular_distance};

impl Pass<'_, '_> {
    /// Runs a piece in time, to the end or until the crank has turned by `rotation` (rad) in one direction.
    pub fn run_time_engine(&mut self, rotation: f64, reason: Reason) -> Result<PieceEnd, Error> {
        self.keep();
        let pass = self.settings;
        let from = self.result.state;
        let no_start = || stop_reason::no_start(pass.task);
        let curve = configuration_curve::is_followed(pass.task)
            .then(|| CurveProblem::through_start(pass.task).ok_or_else(no_start));
        let curve = curve.transpose()?;
        let curve = curve.as_ref();
        // Only a crank that turns fully changes engines, and the coordinate of its curve is the crank angle.
        let start = match curve {
            Some(curve) if !self.has_begun() => curve.start,
            _ => from,
        };
        let settings = Settings {
            limit: match curve {
                Some(_) => self.left(),
                // The evaluations of `motion` before this piece count as well.
                None => pass.time_settings.limit.after(self.spent_beside_motion()),
            },
            ..pass.time_settings
        };
        self.observer.begin_in_time(start, curve, reason);
        let mut resume = ResumeCondition {
            pass,
            observer: &mut *self.observer,
            rotation,
            turning_point: from.angle,
            kinetic_since_turning: 0.0,
            largest_kinetic: 0.0,
            is_met: false,
        };
        let mut piece = match curve {
            Some(curve) => {
                let limit = pass.extent.angle();
                let turn_limit = limit.map(|limit| (pass.task.start(), limit));
                CurveRun::run(&curve.equation, settings, start, turn_limit, &mut resume)
            }
            None => {
                let along = Coordinate::Crank(pass.task.equation());
                let mut sink = |step: &Step| resume.step(step, &along);
                of_crank(self.motion, from, &settings, &mut sink)
            }
        };
        let (is_met, largest_kinetic) = (resume.is_met, resume.largest_kinetic);
        self.other_evaluations += piece.evaluations;
        if let Some(last) = self
            .observer
            .end_in_time(self.motion, &piece.last, &settings)
        {
            (piece.last, piece.work, piece.end) = (last, last.end.work, EndReason::Done);
        }
        let Node {
            t, theta, omega, ..
        } = piece.last.end;
        let (angle, speed) = (piece.last.angle(theta), omega);
        let coordinate = MotionState { t, angle, speed };
        let result = &mut self.result;
        let crank = |curve: &CurveProblem| crank_state(&curve.equation, coordinate);
        result.state = curve.map_or(coordinate, crank);
        result.steps += piece.steps;
        result.pieces_in_time += 1;
        result.work += piece.work;
        result.largest_kinetic = result.largest_kinetic.max(largest_kinetic);
        result.curve = curve.cloned();
        result.last_step = Some(piece.last);
        if is_met && matches!(piece.end, EndReason::Stopped) {
            result.state.angle = result.state.angle.reduced();
            return Ok(PieceEnd::ClearOfRest);
        }
        let is_start = result.pieces_over_angle == 0;
        if is_start && matches!(piece.end, EndReason::Integrator(Finish::NoStart)) {
            return Err(no_start());
        }
        result.stopped = stop_reason::reason(pass, &piece, result.state, curve);
        Ok(PieceEnd::Ended)
    }
}

/// Runs a piece with the crank angle as the coordinate; its evaluations are those of `motion`.
fn of_crank(
    motion: &Counted<'_>,
    from: MotionState,
    settings: &Settings<'_>,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> TimePiece {
    let (finish, last, steps) = time::run(motion, from, settings, sink);
    let singular_state = motion.singular_state();
    TimePiece {
        last,
        work: last.end.work,
        steps,
        evaluations: 0,
        end: match finish {
            Finish::AtEnd => EndReason::Done,
            Finish::Stopped => EndReason::Stopped,
            finish => EndReason::Integrator(finish),
        },
        singular_state: singular_state.map(|(t, angle, speed)| MotionState { t, angle, speed }),
    }
}

/// Observer of a crank in time until it turns safely again and the angle engine may take over.
struct ResumeCondition<'a, 'o> {
    pass: &'a PassSettings<'a>,
    observer: &'o mut dyn PassObserver,
    /// Rotation in one direction, rad, after which the angle engine may resume.
    rotation: f64,
    /// Crank angle at the last turning point.
    turning_point: Angle,
    /// Largest kinetic energy since the last turning point, J.
    kinetic_since_turning: f64,
    /// Largest kinetic energy at the ends of steps, J.
    largest_kinetic: f64,
    is_met: bool,
}

impl StepObserver for ResumeCondition<'_, '_> {
    fn step(&mut self, step: &Step, along: &Coordinate<'_>) -> bool {
        let ends = self.observer.step(step, along);
        self.is_met = !ends && self.is_met_at_end(step);
        ends || self.is_met
    }

    fn event(&mut self, kind: &'static str, at: MotionState) {
        self.observer.event(kind, at);
    }
}

impl ResumeCondition<'_, '_> {
    /// Whether the angle engine may take over at the end of a step.
    fn is_met_at_end(&mut self, step: &Step) -> bool {
        if self.rotation == f64::INFINITY {
            return false;
        }
        let end = &step.end;
        let angle = step.angle(end.theta);
        let equation = self.pass.task.equation();
        let kinetic = equation.kinetic_energy(angle.rest, end.omega);
        self.largest_kinetic = self.largest_kinetic.max(kinetic);
        if step.start.omega * end.omega <= 0.0 {
            (self.turning_point, self.kinetic_since_turning) = (angle, 0.0);
        }
        self.kinetic_since_turning = self.kinetic_since_turning.max(kinetic);
        // Part of the largest energy since then: a slower crank may be near to rest, where the angle does not serve.
        let fast = 0.25;
        // Apart from all places of events.
        let is_apart = |corner: &f64| circular_distance(angle.rest, *corner) > NEARBY_ANGLE;
        angle.minus(self.turning_point).abs() >= self.rotation
            && kinetic >= fast * self.kinetic_since_turning
            && self.pass.model.cycle_corners.iter().all(is_apart)
    }
}
