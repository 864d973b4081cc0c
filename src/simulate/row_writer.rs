//! Writes the rows that are due, whatever engine computes the motion.

use std::time::{Duration, Instant};

use super::row::{Row, RowSink};
use super::schedule::{Schedule, passed, refuse_rows};
use crate::error::Error;

/// A part of a motion that is known between two times, as rows see it.
pub(super) trait Part {
    /// First and last time, s.
    fn times(&self) -> [f64; 2];

    /// How far the crank has turned from the start of the run at a time (s), rad.
    fn turned(&mut self, t: f64) -> f64;

    /// When (s) it has turned so far (rad), between two times.
    fn time_of(&mut self, turned: f64, between: [f64; 2]) -> Option<f64>;

    /// When the crank turns back, s, in order.
    fn turning_times(&mut self) -> Vec<f64> {
        Vec::new()
    }

    /// The row of a time, s.
    fn row(&mut self, t: f64) -> Row;
}

/// Writes rows.
pub(super) struct RowWriter<'a> {
    rows: &'a mut dyn RowSink,
    schedule: Schedule,
    /// Index of the next row at a time; 0 before the first row of all.
    next: u64,
    /// Time spent on rows.
    pub spent: Duration,
}

impl<'a> RowWriter<'a> {
    pub fn new(rows: &'a mut dyn RowSink, schedule: Schedule) -> RowWriter<'a> {
        RowWriter {
            rows,
            schedule,
            next: 0,
            spent: Duration::ZERO,
        }
    }

    /// The rows that are due in a part of the motion, which follows the one before.
    pub fn write(&mut self, part: &mut dyn Part) -> Result<(), Error> {
        if !self.rows.wants_rows() {
            return Ok(());
        }
        let begun = Instant::now();
        let result = match self.schedule.angle_step() {
            Some(spacing) => self.at_angles(part, spacing),
            None => self.at_times(part),
        };
        self.spent += begun.elapsed();
        result
    }

    /// The last row.
    pub fn finish(self, row: impl FnOnce() -> Option<Row>) -> Result<(), Error> {
        let row = self.rows.wants_rows().then(row).flatten();
        row.map_or(Ok(()), |row| self.rows.row(&row))
    }

    fn at_times(&mut self, part: &mut dyn Part) -> Result<(), Error> {
        let [_, until] = part.times();
        while let Some(t) = self.schedule.time(self.next).filter(|t| *t <= until) {
            self.rows.row(&part.row(t))?;
            self.next += 1;
        }
        Ok(())
    }

    fn at_angles(&mut self, part: &mut dyn Part, spacing: f64) -> Result<(), Error> {
        let [mut from, until] = part.times();
        refuse_rows((part.turned(until) / spacing).abs(), until)?;
        if self.next == 0 {
            self.rows.row(&part.row(from))?;
            self.next = 1;
        }
        // Between the times at which the crank turns back its angle is monotone.
        let mut cuts = part.turning_times();
        cuts.retain(|t| *t < until);
        cuts.push(until);
        for to in cuts {
            let [before, after] = [from, to].map(|t| part.turned(t) / spacing);
            for k in passed(before, after) {
                // A turning point may fall short of its angle by rounding.
                let t = part.time_of(k * spacing, [from, to]).unwrap_or(to);
                self.rows.row(&part.row(t))?;
            }
            from = to;
        }
        Ok(())
    }
}
