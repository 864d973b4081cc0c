//! File of a measured motion: its text, and where the samples stand in it.

use std::path::PathBuf;

use super::Reading;
use crate::scene::csv::lines::Dialect;

/// File of the samples, in which messages find lines and cells.
#[derive(Clone, Debug)]
pub(super) struct SampleFile {
    pub file: PathBuf,
    pub text: String,
    /// Beginning of the rows of numbers, and their delimiter.
    pub dialect: Dialect,
    /// Positions of time and value in a row, from 0.
    pub at: [usize; 2],
    pub reading: Reading,
}

impl SampleFile {
    /// Returns the row of a sample, from 0; empty for none.
    pub fn row(&self, sample: usize) -> &str {
        let mut rows = self.dialect.rows(&self.text).filter(|row| self.has(row));
        rows.nth(sample).unwrap_or_default()
    }

    /// Whether a row has time and value.
    fn has(&self, row: &str) -> bool {
        let lacks = |at: usize| {
            let cell = self.dialect.cells(row).nth(at);
            cell.is_some_and(|cell| self.reading.is_missing(cell))
        };
        self.reading.missing.is_empty() || !self.at.into_iter().any(lacks)
    }
}
