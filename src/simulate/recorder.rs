//! The recorder of a run: rows, events, extreme speeds and the dense motion, whatever engine computes the pieces.

use std::borrow::Cow;
use std::time::Instant;

use super::configuration_curve::Phase;
use super::dense_rows::lengthen;
use super::passages::{self, Stretch};
use super::record::Record;
use super::result::{Event, Piece};
use super::row::{Row, RowSink};
use super::run_setup::RunSetup;
use super::schedule::{Schedule, passed};
use crate::engine::Motion;
use crate::engine::step::Step;
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::trajectory::Trajectory;

/// A coordinate along which steps are computed, as rows see it.
pub(super) trait Coordinate {
    /// The equation of motion, by which steps are refined.
    fn motion(&self) -> &dyn Motion;

    /// How far the crank has turned from the start of the run at a time (s) of a step, rad.
    fn turned(&self, step: &Step, t: f64) -> f64;

    /// When (s) it has turned so far (rad), between two times.
    fn time_of(&self, step: &Step, turned: f64, between: [f64; 2]) -> Option<f64>;

    /// When the crank turns back inside a step, s, in order.
    fn turning_times(&self, step: &Step) -> Vec<f64>;

    /// The row of a time (s), an angle of the coordinate and its rate (rad/s).
    fn row(&self, t: f64, angle: Angle, speed: f64) -> Row;
}

/// Records a run.
pub(super) struct Recorder<'a> {
    task: &'a RunSetup<'a>,
    rows: &'a mut dyn RowSink,
    schedule: Schedule,
    /// Index of the next row at a time; 0 before the first row of all.
    next_row: u64,
    /// Steps and pieces of the motion that may still be kept.
    room: usize,
    /// Refined steps of the piece under way.
    steps: Vec<Step>,
    record: Record,
    /// What the sink of the rows said.
    error: Option<Error>,
}

impl<'a> Recorder<'a> {
    pub fn new(task: &'a RunSetup<'a>, rows: &'a mut dyn RowSink) -> Recorder<'a> {
        let speed = task.scene.motion.speed;
        Recorder {
            task,
            rows,
            schedule: task.schedule(),
            next_row: 0,
            room: task.kept,
            steps: Vec::new(),
            record: Record {
                pieces: (task.kept > 0).then(Vec::new),
                ..Record::new(speed)
            },
            error: None,
        }
    }

    pub fn task(&self) -> &'a RunSetup<'a> {
        self.task
    }

    /// Least and largest crank speed so far, rad/s.
    pub fn speed(&mut self) -> &mut (f64, f64) {
        &mut self.record.speed
    }

    /// Whether there is room for another event.
    pub fn keeps_events(&self) -> bool {
        self.record.events.len() < self.task.options.events_kept
    }

    /// Counts an event, and keeps it if there is room.
    pub fn event(&mut self, event: impl FnOnce() -> Event) {
        self.record.events_total += 1;
        if self.keeps_events() {
            self.record.events.push(event());
        }
    }

    /// Notes that an engine takes over at a time, s.
    pub fn begins(&mut self, engine: Engine, from_s: f64, why: Cow<'static, str>) {
        let engines = &mut self.record.engines;
        if let Some(last) = engines.last_mut() {
            last.to_s = last.to_s.min(from_s);
        }
        if engines.len() < self.task.options.events_kept {
            engines.push(Piece {
                engine: engine.name(),
                from_s,
                to_s: f64::INFINITY,
                why,
            });
        }
    }

    /// Records a piece over the crank angle: its events, its rows, its speeds.
    pub fn stretch(&mut self, stretch: &Stretch<'_>) -> Result<(), Error> {
        let begun = Instant::now();
        let result = self.rows_and_events(stretch);
        self.record.row_time += begun.elapsed();
        result
    }

    fn rows_and_events(&mut self, stretch: &Stretch<'_>) -> Result<(), Error> {
        let task = self.task;
        let left = task.options.events_kept - self.record.events.len();
        let (events, total) = passages::events(task, stretch, left);
        self.record.events.extend(events);
        self.record.events_total += total;
        let (low, high) = stretch.orbit.speed_range(stretch.end);
        let speed = &mut self.record.speed;
        *speed = (speed.0.min(low), speed.1.max(high));
        if !self.rows.wants_rows() {
            return Ok(());
        }
        let rows = &mut *self.rows;
        let mut write =
            |t: f64, angle: Angle, omega: f64| rows.row(&task.maker.row(t, angle, omega, None));
        passages::write_rows(task, stretch, &mut self.next_row, &mut write)
    }

    /// Keeps the motion of a piece over the crank angle, if there is room.
    pub fn keep(&mut self, piece: impl FnOnce() -> Trajectory) {
        if self.takes_room()
            && let Some(pieces) = &mut self.record.pieces
        {
            pieces.push(piece());
        }
    }

    /// Records a step until a time (s) in it: its rows and its motion, in a phase of the configuration curve or none. True
    /// if that failed, which ends the run.
    pub fn step(
        &mut self,
        step: &mut Step,
        until: f64,
        along: &dyn Coordinate,
        phase: Option<Phase>,
    ) -> bool {
        self.record.checkpoints.pass(step);
        if self.rows.wants_rows() {
            let begun = Instant::now();
            let result = self.write_rows(step, until, along);
            self.record.row_time += begun.elapsed();
            if let Err(error) = result {
                self.error = Some(error);
                return true;
            }
        }
        if self.record.pieces.is_some() && self.takes_room() {
            step.refine(along.motion());
            self.steps.push(*step);
            if let Some(phase) = phase {
                let times = [step.start.t, step.end.t];
                lengthen(&mut self.record.spells, times, phase);
            }
        }
        false
    }

    /// Keeps the steps since the last piece as one that ends at a time (s), or with its last step.
    pub fn end_piece(&mut self, end: f64) {
        let steps = std::mem::take(&mut self.steps);
        if let (Some(last), Some(pieces)) = (steps.last(), &mut self.record.pieces) {
            let end = end.min(last.end.t);
            pieces.push(Trajectory::from_steps(steps, end));
        }
    }

    /// Ends the record with the row of the last state, which is a row always.
    pub fn finish(mut self, last: impl FnOnce() -> Row) -> Result<Record, Error> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        if self.rows.wants_rows() {
            self.rows.row(&last())?;
        }
        Ok(self.record)
    }

    /// Takes room for a step or a piece of the motion; where there is none, nothing of it is kept.
    fn takes_room(&mut self) -> bool {
        let room = self.room.checked_sub(1);
        self.room = room.unwrap_or(0);
        if room.is_none() {
            self.record.pieces = None;
            self.steps = Vec::new();
        }
        room.is_some()
    }

    fn write_rows(
        &mut self,
        step: &mut Step,
        until: f64,
        along: &dyn Coordinate,
    ) -> Result<(), Error> {
        if let Some(spacing) = self.schedule.angle_step() {
            return self.write_rows_at_angles(step, until, along, spacing);
        }
        while let Some(t) = self.schedule.time(self.next_row) {
            if t > until {
                break;
            }
            if t > step.start.t && t < step.end.t {
                step.refine(along.motion());
            }
            self.write_row(step, t, along)?;
            self.next_row += 1;
        }
        Ok(())
    }

    fn write_rows_at_angles(
        &mut self,
        step: &mut Step,
        until: f64,
        along: &dyn Coordinate,
        spacing: f64,
    ) -> Result<(), Error> {
        if self.next_row == 0 {
            self.write_row(step, step.start.t, along)?;
            self.next_row = 1;
        }
        // Between the times at which the crank turns back its angle is monotone.
        let mut cuts = along.turning_times(step);
        cuts.retain(|t| *t < until);
        cuts.push(until);
        let mut from = step.start.t;
        for to in cuts {
            let way = |t: f64| along.turned(step, t) / spacing;
            for k in passed(way(from), way(to)) {
                step.refine(along.motion());
                // A turning point may fall short of its angle by rounding.
                let t = along.time_of(step, k * spacing, [from, to]).unwrap_or(to);
                self.write_row(step, t, along)?;
            }
            from = to;
        }
        Ok(())
    }

    fn write_row(&mut self, step: &Step, t: f64, along: &dyn Coordinate) -> Result<(), Error> {
        let (theta, speed) = step.at(t);
        self.rows.row(&along.row(t, step.angle(theta), speed))
    }
}
