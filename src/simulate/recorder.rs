//! Recorder of a run: rows, events, extreme speeds and the dense motion, whatever engine computes the pieces.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::coordinate::Coordinate;
use super::passages::OrbitPiece;
use super::result::{Event, Piece};
use super::row::{Row, RowSink};
use super::row_writer::{RowSource, RowWriter};
use super::run_setup::RunSetup;
use super::schedule::Schedule;
use super::second_run::Checkpoints;
use super::simulation::PhaseInterval;
use super::stick_slip::CurveMotion;
use crate::engine::step::Step;
use crate::engine::{PIECES, events};
use crate::error::Error;
use crate::mechanism::CurveEquation;
use crate::numeric::root;
use crate::plan::Engine;
use crate::trajectory::Trajectory;

/// Record of a run.
#[derive(Debug, Default)]
pub(super) struct Record {
    /// First events, at most `Options::events_kept`.
    pub events: Vec<Event>,
    pub events_total: u64,
    /// Least and largest crank speed, rad/s.
    pub speed_range: (f64, f64),
    /// Dense motion; none without room for all of it.
    pub trajectory: Option<Trajectory>,
    /// Configuration curve that the last piece in time followed, if it followed one.
    pub curve: Option<Arc<CurveEquation>>,
    /// Phases of the slider in its guide, where the motion was computed along a configuration curve.
    pub phases: Vec<PhaseInterval>,
    /// Engines that ran, in order, if they took turns.
    pub pieces: Vec<Piece>,
    /// States on the way, for the error estimate.
    pub checkpoints: Checkpoints,
    /// Wall time spent on rows.
    pub row_time: Duration,
}

impl Record {
    /// Returns the wall time since the run began without the time of the rows, s.
    pub fn wall_s(&self, begun: Instant) -> f64 {
        begun.elapsed().saturating_sub(self.row_time).as_secs_f64()
    }

    /// Returns the largest crank speed in either sense, rad/s.
    pub fn fastest(&self) -> f64 {
        self.speed_range.0.abs().max(self.speed_range.1.abs())
    }
}

/// Recorder of the rows, events, extreme speeds and motion of one run.
pub(super) struct Recorder<'a> {
    task: &'a RunSetup<'a>,
    writer: RowWriter<'a>,
    /// Number of steps and pieces of the motion that may still be kept.
    room: usize,
    /// Refined steps of the current piece.
    steps: Vec<Step>,
    /// Pieces of the dense motion; none without room for all.
    motion: Option<Vec<Trajectory>>,
    record: Record,
    /// First error of the row sink.
    error: Option<Error>,
}

impl<'a> Recorder<'a> {
    pub fn new(
        task: &'a RunSetup<'a>,
        rows: &'a mut dyn RowSink,
        schedule: Schedule,
    ) -> Recorder<'a> {
        Recorder {
            task,
            writer: RowWriter::new(rows, schedule),
            room: task.steps_kept,
            steps: Vec::new(),
            motion: (task.steps_kept > 0).then(Vec::new),
            record: Record {
                speed_range: (task.speed, task.speed),
                ..Record::default()
            },
            error: None,
        }
    }

    /// Borrows the least and largest crank speed up to now, rad/s.
    pub fn speed(&mut self) -> &mut (f64, f64) {
        &mut self.record.speed_range
    }

    /// True if there is room for another event.
    pub fn keeps_events(&self) -> bool {
        self.record.events.len() < self.task.options.events_kept
    }

    /// Counts an event and keeps it if there is room.
    pub fn event(&mut self, event: Event) {
        self.record.events_total += 1;
        if self.keeps_events() {
            self.record.events.push(event);
        }
    }

    /// Records that an engine takes over at a time, s.
    pub fn begins(&mut self, engine: Engine, from_s: f64, why: Cow<'static, str>) {
        let pieces = &mut self.record.pieces;
        if let Some(last) = pieces.last_mut() {
            last.to_s = last.to_s.min(from_s);
        }
        if pieces.len() < self.task.options.events_kept {
            pieces.push(Piece {
                engine: engine.name(),
                from_s,
                to_s: f64::INFINITY,
                why,
            });
        }
    }

    /// Records a piece over the crank angle: events, rows and speeds.
    pub fn orbit_piece(&mut self, piece: &mut OrbitPiece<'_>) -> Result<(), Error> {
        let left = self.task.options.events_kept - self.record.events.len();
        let (events, total) = piece.events(left);
        self.record.events.extend(events);
        self.record.events_total += total;
        let (low, high) = piece.orbit.speed_range(piece.end);
        let speed = &mut self.record.speed_range;
        *speed = (speed.0.min(low), speed.1.max(high));
        self.writer.write(piece)
    }

    /// Writes the rows of a part of the motion. True if that failed, which ends the run.
    pub fn rows(&mut self, part: &mut dyn RowSource) -> bool {
        let failed = self.writer.write(part).err();
        self.error = self.error.take().or(failed);
        self.error.is_some()
    }

    /// Keeps the motion of a piece over the crank angle, if there is room.
    pub fn keep(&mut self, piece: impl FnOnce() -> Trajectory) {
        if self.takes_room()
            && let Some(pieces) = &mut self.motion
        {
            pieces.push(piece());
        }
    }

    /// Records a step until a time (s) inside it; true if a row failed, which ends the run.
    pub fn step(&mut self, step: &mut Step, until: f64, along: &Coordinate<'_>) -> bool {
        self.record.checkpoints.add(step);
        let mut part = StepRows {
            step,
            until,
            along,
            task: self.task,
        };
        if self.rows(&mut part) {
            return true;
        }
        if self.motion.is_some() && self.takes_room() {
            step.refine(along.motion());
            self.steps.push(*step);
            if let Coordinate::Curve(CurveMotion { phase, .. }) = *along {
                let (phases, from, until) = (&mut self.record.phases, step.start.t, step.end.t);
                match phases.last_mut() {
                    Some(last) if last.until == from && last.phase == phase => last.until = until,
                    _ => phases.push(PhaseInterval { from, until, phase }),
                }
            }
        }
        false
    }

    /// Keeps a step of the motion as it stands, if there is room.
    pub fn keep_step(&mut self, step: Step) {
        if self.motion.is_some() && self.takes_room() {
            self.steps.push(step);
        }
    }

    /// Joins the steps since the last piece into one that ends at a time (s), or at the end of the last step.
    pub fn end_piece(&mut self, end: f64) {
        let steps = std::mem::take(&mut self.steps);
        if let (Some(last), Some(pieces)) = (steps.last(), &mut self.motion) {
            let end = end.min(last.end.t);
            pieces.push(Trajectory::from_steps(steps, end));
        }
    }

    /// Ends the record with the row of the last state, if `last` gives one.
    pub fn finish(mut self, last: impl FnOnce() -> Option<Row>) -> Result<Record, Error> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        self.record.row_time = self.writer.spent;
        self.record.trajectory = self.motion.map(Trajectory::joined);
        self.writer.finish(last)?;
        Ok(self.record)
    }

    /// Takes room for a step or a piece of the motion; without room, no motion is kept at all.
    fn takes_room(&mut self) -> bool {
        let room = self.room.checked_sub(1);
        self.room = room.unwrap_or(0);
        if room.is_none() {
            self.motion = None;
            self.steps = Vec::new();
        }
        room.is_some()
    }
}

/// Step until a time inside it, refined where it is read between its ends.
struct StepRows<'a> {
    step: &'a mut Step,
    /// Last time, s.
    until: f64,
    along: &'a Coordinate<'a>,
    task: &'a RunSetup<'a>,
}

impl RowSource for StepRows<'_> {
    fn times(&self) -> [f64; 2] {
        [self.step.start.t, self.until]
    }

    fn turned(&mut self, t: f64) -> f64 {
        self.along.crank(self.step, t).0.minus(self.task.start())
    }

    fn time_of(&mut self, turned: f64, [from, to]: [f64; 2]) -> Option<f64> {
        self.step.refine(self.along.motion());
        root::bracketed(|t| self.turned(t) - turned, from, to)
    }

    fn turning_times(&mut self) -> Vec<f64> {
        let step = &*self.step;
        let speed = |t: f64| self.along.crank(step, t).1;
        let turns = |i: usize| {
            let [from, to] = [i, i + 1].map(|piece| events::part(step, piece, PIECES));
            let turns = speed(from) * speed(to) < 0.0;
            turns.then(|| root::bracketed(speed, from, to))?
        };
        (0..PIECES).filter_map(turns).collect()
    }

    fn row(&mut self, t: f64) -> Row {
        if t > self.step.start.t && t < self.step.end.t {
            self.step.refine(self.along.motion());
        }
        let (theta, speed) = self.step.at(t);
        let angle = self.step.angle(theta);
        self.along.row(&self.task.maker, t, angle, speed)
    }
}
