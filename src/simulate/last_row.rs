//! The end of a run among its rows.

use super::row::{Row, RowSink};
use super::schedule;
use crate::error::Error;

/// A row due this much of the spacing before the end is the end, but for the rounding of its time.
const SAME_TIME: f64 = 1e-9;

/// Hands rows on. The last state is a row always: one that is due at the same time is left out, so that no time is
/// written twice.
pub(super) struct LastRow<'a> {
    rows: &'a mut dyn RowSink,
    /// The last two rows.
    held: [Option<Row>; 2],
    /// Time of the row before them, s.
    before: f64,
    handed_on: u64,
}

impl<'a> LastRow<'a> {
    pub fn new(rows: &'a mut dyn RowSink) -> LastRow<'a> {
        LastRow {
            rows,
            held: [None; 2],
            before: 0.0,
            handed_on: 0,
        }
    }

    /// After the last row.
    pub fn finish(self) -> Result<(), Error> {
        let [due, last] = self.held;
        let before = self.before;
        let is_last = |due: &Row, last: &Row| {
            last.t - due.t <= SAME_TIME * (due.t - before) + 4.0 * f64::EPSILON * last.t
        };
        let due = match (due, last) {
            (Some(due), Some(last)) if is_last(&due, &last) => None,
            (due, _) => due,
        };
        due.iter()
            .chain(&last)
            .try_for_each(|row| self.rows.row(row))
    }
}

impl RowSink for LastRow<'_> {
    fn wants_rows(&self) -> bool {
        self.rows.wants_rows()
    }

    fn row(&mut self, row: &Row) -> Result<(), Error> {
        let [due, last] = self.held;
        self.held = [last, Some(*row)];
        match due {
            Some(due) => {
                self.before = due.t;
                self.handed_on += 1;
                schedule::refuse_rows(self.handed_on as f64, due.t)?;
                self.rows.row(&due)
            }
            None => Ok(()),
        }
    }
}
