//! Writer of the rows that are due, whatever engine computes the motion.

use std::time::{Duration, Instant};

use super::row::{Row, RowSink};
use super::schedule::{SAME_ROW, Schedule, check_row_count, integers_passed};
use crate::error::Error;
use crate::numeric::root;

/// Part of a motion between two times, as rows see it.
pub(super) trait RowSource {
    /// Returns the first and the last time, s.
    fn times(&self) -> [f64; 2];

    /// Returns the rotation of the crank since the start of the run at a time (s), rad.
    fn turned(&mut self, t: f64) -> f64;

    /// Finds the time (s) between two times at which the crank has turned by `turned` (rad) since the start of the run.
    fn time_of(&mut self, turned: f64, [from, to]: [f64; 2]) -> Option<f64> {
        root::bracketed(|t| self.turned(t) - turned, from, to)
    }

    /// Lists the times at which the crank turns back, s, in order.
    fn turning_times(&mut self) -> Vec<f64> {
        Vec::new()
    }

    /// Makes the row at a time, s.
    fn row(&mut self, t: f64) -> Row;
}

pub(super) struct RowWriter<'a> {
    rows: &'a mut dyn RowSink,
    schedule: Schedule,
    /// Index of the next row at a time; 0 before the very first row.
    next: u64,
    /// Wall time spent on rows.
    pub spent: Duration,
    /// Last row that was due; dropped if the row of the last state, which is always written, has the same time.
    held: Option<Row>,
    /// Time of the row before the held one, s.
    before: f64,
    /// Number of rows handed to the sink.
    taken: u64,
}

impl<'a> RowWriter<'a> {
    pub fn new(rows: &'a mut dyn RowSink, schedule: Schedule) -> RowWriter<'a> {
        RowWriter {
            rows,
            schedule,
            next: 0,
            spent: Duration::ZERO,
            held: None,
            before: 0.0,
            taken: 0,
        }
    }

    /// Writes the rows that are due in a part of the motion, which follows the part before.
    pub fn write(&mut self, part: &mut dyn RowSource) -> Result<(), Error> {
        if !self.rows.wants_rows() {
            return Ok(());
        }
        let begun = Instant::now();
        let mut result = match self.schedule {
            Schedule::Angles { step } if step > 0.0 => self.at_angles(part, step),
            _ => self.at_times(part),
        };
        if self.rows.wants_steps() {
            result = result.and_then(|()| self.inside(part));
        }
        self.spent += begun.elapsed();
        result
    }

    /// Writes the last row that is due, then the row of the last state.
    pub fn finish(mut self, last: impl FnOnce() -> Option<Row>) -> Result<(), Error> {
        let last = self.rows.wants_rows().then(last).flatten();
        let before = self.before;
        let is_last = |due: &Row| {
            last.is_some_and(|Row { t, .. }| {
                t - due.t <= SAME_ROW * (due.t - before) + 4.0 * f64::EPSILON * t
            })
        };
        let due = self.held.take().filter(|due| !is_last(due));
        due.iter()
            .chain(&last)
            .try_for_each(|row| self.rows.row(row))
    }

    /// Holds a row and hands the row before it to the sink.
    fn put(&mut self, row: Row) -> Result<(), Error> {
        let Some(due) = self.held.replace(row) else {
            return Ok(());
        };
        self.before = due.t;
        self.taken += 1;
        check_row_count(self.taken as f64, due.t)?;
        self.rows.row(&due)
    }

    fn at_times(&mut self, part: &mut dyn RowSource) -> Result<(), Error> {
        let [_, until] = part.times();
        while let Some(t) = self.schedule.time(self.next).filter(|t| *t <= until) {
            self.put(part.row(t))?;
            self.next += 1;
        }
        Ok(())
    }

    /// Hands states inside a part and at its end to the sink.
    fn inside(&mut self, part: &mut dyn RowSource) -> Result<(), Error> {
        let [from, until] = part.times();
        // Enough to show the shape of the motion in a step.
        let states = 4u32;
        (1..=states).try_for_each(|k| {
            let t = from + (until - from) * f64::from(k) / f64::from(states);
            self.rows.step(&part.row(t))
        })
    }

    fn at_angles(&mut self, part: &mut dyn RowSource, spacing: f64) -> Result<(), Error> {
        let [mut from, until] = part.times();
        check_row_count((part.turned(until) / spacing).abs(), until)?;
        if self.next == 0 {
            self.put(part.row(from))?;
            self.next = 1;
        }
        // Between turning times the crank angle is monotone.
        let mut cuts = part.turning_times();
        cuts.retain(|t| *t < until);
        cuts.push(until);
        for to in cuts {
            let [before, after] = [from, to].map(|t| part.turned(t) / spacing);
            for k in integers_passed(before, after) {
                // Rounding may leave a turning point short of the angle of its row.
                let t = part.time_of(k * spacing, [from, to]).unwrap_or(to);
                self.put(part.row(t))?;
            }
            from = to;
        }
        Ok(())
    }
}
