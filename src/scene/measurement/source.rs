//! The file that samples came from: finds the line and the cells of a sample for messages.

use std::ops::Range;
use std::path::PathBuf;

use super::Measurement;
use super::clock::Decimal;
use super::lines::{Dialect, line_number, span};
use crate::scene::table::rows::Column;

/// The text of a data file and what is known of its columns.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub file: PathBuf,
    pub text: String,
    pub dialect: Dialect,
    /// Positions of the time and of the measured value, from 0.
    pub columns: [usize; 2],
    pub time: Column,
    pub value: Column,
    /// What was subtracted from a value in SI.
    pub zero: f64,
}

impl Source {
    fn row(&self, sample: usize) -> &str {
        self.dialect
            .rows(&self.text)
            .nth(sample)
            .unwrap_or_default()
    }

    /// The line of a sample, from 1.
    pub fn line(&self, sample: usize) -> usize {
        line_number(&self.text, self.row(sample))
    }

    fn cell(&self, sample: usize, column: usize) -> Range<usize> {
        let row = self.row(sample);
        span(
            &self.text,
            self.dialect.cells(row).nth(column).unwrap_or(row),
        )
    }

    /// The bytes of the measured value of a sample.
    pub fn value_span(&self, sample: usize) -> Range<usize> {
        self.cell(sample, self.columns[1])
    }

    /// The bytes of the time of a sample.
    pub fn time_span(&self, sample: usize) -> Range<usize> {
        self.cell(sample, self.columns[0])
    }
}

/// Part of the usual step to which times have to be known.
const COARSE: f64 = 1e-6;

impl Measurement {
    /// How far doubles as large as the times know them, s, if that is too little for steps as short as these.
    pub(super) fn lost(&self) -> Option<f64> {
        let times = &self.times;
        let (first, last) = (*times.first()?, *times.last()?);
        let step = (last - first) / times.len() as f64;
        let known = f64::EPSILON * first.abs().max(last.abs());
        (known > COARSE * step).then_some(known)
    }

    /// Counts times from the first row where doubles lose digits of the time stamps in the file.
    pub(super) fn count_from_first_row(&mut self) {
        if self.lost().is_some() {
            self.elapsed = self.since_first_row();
            self.origin = self.elapsed.as_ref().map_or(0.0, |_| self.times[0]);
        }
    }

    /// Times since the first row, s, from the texts of both; none for what is not of digits alone.
    pub(super) fn since_first_row(&self) -> Option<Vec<f64>> {
        let source = self.source.as_ref()?;
        let mut first = None;
        let mut since = |row: &str| {
            let time = Decimal::of(source.dialect.cells(row).nth(source.columns[0])?)?;
            let first = *first.get_or_insert(time);
            Some(time.since(first)? * source.time.factor)
        };
        source.dialect.rows(&source.text).map(&mut since).collect()
    }
}
