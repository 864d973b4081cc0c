//! Pieces over the crank angle, by the energy engine, which computes a whole run or none, and by the angle engine.

use std::f64::consts::TAU;

use super::super::angle_model::AngleModel;
use super::super::run_setup::RunSetup;
use super::super::second_run::LEAST_TAIL;
use super::super::stop;
use super::engine_loop::{AnglePiece, Pass, PieceEnd, Reason};
use crate::engine::WorkLimit;
use crate::engine::angle::{self, AngleRun, Goal, Resolution};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::engine::time::MotionState;
use crate::error::Error;
use crate::numeric::root;
use crate::plan::{Engine, Method};
use crate::scene::Extent;

impl Pass<'_, '_> {
    /// Computes the whole run from its energy.
    pub fn run_energy_engine(&mut self, reason: Reason) -> Result<PieceEnd, Error> {
        let (task, model) = (self.settings.task, self.settings.model);
        // A tenth of the tolerance, but no more than the last digits, as the series cost little.
        let (share, most_tail) = (0.1, 1e-14);
        let tail = (share * task.scene.run.tolerance).clamp(LEAST_TAIL, most_tail);
        let (orbit, t, stopped) = match until_the_end(task, model, tail) {
            Ok(ended) => ended,
            Err(why) => return Ok(PieceEnd::NotApplicable(why)),
        };
        self.result.stopped = stopped;
        let (angle, speed) = orbit.state(t);
        let work = model.work(task.start(), angle);
        let run = AngleRun::whole(orbit, t, work);
        self.add_angle_piece(Engine::Energy, reason, run, MotionState { t, angle, speed })?;
        Ok(PieceEnd::Ended)
    }

    /// Runs a piece of the angle engine to the goal or to where the engine cannot go on.
    pub fn run_angle_engine(&mut self, reason: Reason) -> Result<PieceEnd, Error> {
        let pass = self.settings;
        let from = self.result.state;
        if pass.model.has_pole_in_cycle() {
            return Ok(PieceEnd::NotApplicable(NotApplicable::NotFinite));
        }
        let run = self.run_over_angle().and_then(|run| match run.early_end {
            // Past its limits a crank that does not turn fully is followed from the start.
            Some(end) if !pass.task.turns_fully() => Err(end.why),
            _ => Ok(run),
        });
        let run = match run {
            Ok(run) => run,
            Err(why) => {
                self.resume_rotation *= 2.0;
                return Ok(PieceEnd::NotApplicable(why));
            }
        };
        let Some(end) = run.early_end else {
            let (angle, speed) = run.orbit.state(run.end);
            let t = match pass.extent {
                Extent::Duration(duration) => duration,
                Extent::Revolutions(_) => from.t + run.end,
            };
            self.add_angle_piece(Engine::Angle, reason, run, MotionState { t, angle, speed })?;
            return Ok(PieceEnd::Ended);
        };
        let inertia = pass.task.equation().terms(end.angle.rest).m;
        let speed = from.speed.signum() * (2.0 * end.kinetic / inertia).sqrt();
        let (t, angle) = (from.t + run.end, end.angle.reduced());
        let soon = angle.minus(from.angle).abs() < 2.0 * self.resume_rotation;
        self.resume_rotation = if soon {
            2.0 * self.resume_rotation
        } else {
            pass.resume_rotation
        };
        self.add_angle_piece(Engine::Angle, reason, run, MotionState { t, angle, speed })?;
        Ok(PieceEnd::NotApplicable(end.why))
    }

    fn run_over_angle(&self) -> Result<AngleRun, NotApplicable> {
        let pass = self.settings;
        let now = self.result.state;
        let goal = match pass.extent {
            Extent::Duration(duration) => Goal::Time(duration - now.t),
            Extent::Revolutions(turns) => {
                let turned = now.angle.minus(pass.task.start());
                Goal::Turned(turns * TAU - now.speed.signum() * turned)
            }
        };
        let resolution = Resolution {
            limit: self.left(),
            ..pass.resolution
        };
        angle::run(pass.model, now, goal, resolution)
    }

    /// Adds a piece over the angle to the pass.
    fn add_angle_piece(
        &mut self,
        engine: Engine,
        reason: Reason,
        run: AngleRun,
        to: MotionState,
    ) -> Result<(), Error> {
        self.keep();
        let result = &mut self.result;
        let from = result.state;
        self.other_evaluations += run.evaluations;
        result.work += run.work;
        result.steps += run.orbit.panels() as u64;
        result.pieces_over_angle += 1;
        let largest = run.orbit.largest_kinetic(run.end);
        result.largest_kinetic = result.largest_kinetic.max(largest);
        (result.last_step, result.curve) = (None, None);
        result.state = to;
        let piece = AnglePiece {
            run,
            engine,
            from,
            to,
        };
        self.observer.over_angle(&piece, reason)?;
        result.angle_piece = Some(piece);
        Ok(())
    }

    /// Hands the motion of the last piece over the angle to the observer, as another piece follows.
    pub fn keep(&mut self) {
        if let Some(piece) = self.result.angle_piece.take() {
            self.observer.keep(piece);
        }
    }
}

/// Returns the resolution for the tolerance of a run.
pub(super) fn run_resolution<'a>(task: &RunSetup<'a>) -> Resolution<'a> {
    // Tail of the series as part of the tolerance; friction may cut a series inside a panel.
    let share = match &task.maker.guide {
        Some(_) => 0.03 * 1e-2,
        None => 1e-2,
    };
    Resolution {
        tail: (share * task.scene.run.tolerance).max(LEAST_TAIL),
        is_second: false,
        may_decline: task.options.method == Method::Auto,
        guide: None,
        limit: task.options.limit(),
    }
}

/// Returns the resolution of a second run, finer by far: its panels have higher degrees than those of the guide, or end
/// elsewhere, as two runs on the same panels would have the same error.
pub(super) fn second_run_resolution<'a>(
    first: Resolution<'a>,
    guide: Option<&'a AngleRun>,
) -> Resolution<'a> {
    // The series decay further than to the tail, as the degrees are few.
    let ratio = 1e4;
    Resolution {
        tail: (first.tail / ratio).max(LEAST_TAIL),
        is_second: true,
        guide,
        limit: WorkLimit::NONE,
        ..first
    }
}

/// Computes the motion until its goal, its last time (s), and the reason why the goal is not reached, if any.
fn until_the_end(
    task: &RunSetup<'_>,
    model: &AngleModel<'_>,
    tail: f64,
) -> Result<(Orbit, f64, Option<stop::Why>), NotApplicable> {
    let orbit_until = |until: f64| Orbit::new(model, task.start(), task.speed, until, tail);
    let turns = match task.extent {
        Extent::Duration(duration) => {
            let orbit = orbit_until(duration)?;
            let (end, why) = cut_short(task, &orbit, duration).unzip();
            return Ok((orbit, end.unwrap_or(duration), why));
        }
        Extent::Revolutions(turns) => turns,
    };
    let radians = turns * TAU;
    // The span doubles until it covers the turns or the motion repeats.
    let mut until = match task.speed {
        0.0 => 1.0,
        speed => radians / speed.abs(),
    };
    for _ in 0..60 {
        let orbit = orbit_until(until)?;
        let period = orbit.period().map(|period| period.0);
        let known = period.unwrap_or(until.min(orbit.length()));
        let reached = if orbit.turns_back() {
            time_of_way(task, &orbit, radians, known)
        } else {
            orbit.time_of_turn(radians)
        };
        match (reached, period) {
            (Some(end), _) => return Ok((orbit, end, None)),
            (None, Some(period)) => {
                let why = stop::Why::Period { turns, period };
                return Ok((orbit, period, Some(why)));
            }
            (None, None) => match cut_short(task, &orbit, until) {
                Some((end, why)) => return Ok((orbit, end, Some(why))),
                None => until *= 2.0,
            },
        }
    }
    Err(NotApplicable::TooLong)
}

/// Returns the time (s) and the reason if the work limit ends a motion before a time (s).
fn cut_short(task: &RunSetup<'_>, orbit: &Orbit, until: f64) -> Option<(f64, stop::Why)> {
    let end = orbit.length();
    (end < until).then(|| (end, task.limited()))
}

/// Finds the first time (s) at which a motion that turns back is at a distance (rad) from its start, on either side.
fn time_of_way(task: &RunSetup<'_>, orbit: &Orbit, radians: f64, until: f64) -> Option<f64> {
    let beyond = |t: f64| orbit.state(t).0.minus(task.start()).abs() - radians;
    let mut from = 0.0;
    let mut ends = orbit.turning_times(until);
    ends.push(until);
    for to in ends {
        if beyond(to) >= 0.0 {
            return root::bracketed(beyond, from, to);
        }
        from = to;
    }
    None
}
