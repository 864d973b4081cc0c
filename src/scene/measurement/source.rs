//! The file that samples came from: finds the line and the cells of a sample for messages.

use std::ops::Range;
use std::path::PathBuf;

use csv::ByteRecord;

use super::super::table::rows::Column;

/// The text of a data file and what is known of its columns.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub file: PathBuf,
    pub text: String,
    pub delimiter: u8,
    pub has_header: bool,
    /// Positions of the time and of the measured value, from 0.
    pub columns: [usize; 2],
    pub time: Column,
    pub value: Column,
}

/// The records of a data file: lines that are neither blank nor comments.
#[derive(Debug)]
pub(super) struct Records<'a> {
    reader: csv::Reader<&'a [u8]>,
    /// The last record that was read.
    pub record: ByteRecord,
}

impl<'a> Records<'a> {
    /// Those of a text.
    pub fn new(text: &'a str, delimiter: u8) -> Records<'a> {
        let reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .has_headers(false)
            .from_reader(text.as_bytes());
        let record = ByteRecord::new();
        Records { reader, record }
    }

    /// Reads the next record; false after the last one.
    pub fn next(&mut self) -> bool {
        while matches!(self.reader.read_byte_record(&mut self.record), Ok(true)) {
            if self.record.len() > 1 || self.record.iter().any(|cell| !cell.is_empty()) {
                return true;
            }
        }
        false
    }

    /// The byte at which the last record ends.
    pub fn end(&self) -> usize {
        usize::try_from(self.reader.position().byte()).unwrap_or(usize::MAX)
    }
}

impl Source {
    /// The byte at which the record of a sample ends.
    fn end(&self, sample: usize) -> usize {
        let mut records = Records::new(&self.text, self.delimiter);
        for _ in 0..sample + 1 + usize::from(self.has_header) {
            records.next();
        }
        records.end()
    }

    /// The line of a sample, from 1.
    pub fn line(&self, sample: usize) -> usize {
        let line = line_at(&self.text, self.end(sample));
        self.text[..line.start].matches('\n').count() + 1
    }

    /// The bytes of the measured value of a sample.
    pub fn value_span(&self, sample: usize) -> Range<usize> {
        cell(
            &self.text,
            self.end(sample),
            self.delimiter,
            self.columns[1],
        )
    }

    /// The bytes of the time of a sample.
    pub fn time_span(&self, sample: usize) -> Range<usize> {
        cell(
            &self.text,
            self.end(sample),
            self.delimiter,
            self.columns[0],
        )
    }
}

/// The line that ends at or before a byte.
pub(super) fn line_at(text: &str, end: usize) -> Range<usize> {
    let read = text[..end.min(text.len())]
        .trim_end_matches(['\n', '\r'])
        .len();
    let start = text[..read].rfind('\n').map_or(0, |at| at + 1);
    start..read
}

/// The bytes of a cell, from 0, of the line that ends at or before a byte; the whole line if there is no such
/// cell.
pub(super) fn cell(text: &str, end: usize, delimiter: u8, column: usize) -> Range<usize> {
    let line = line_at(text, end);
    let mut quoted = false;
    let separates = |c: char| {
        quoted ^= c == '"';
        !quoted && c == char::from(delimiter)
    };
    let mut start = line.start;
    for (index, piece) in text[line.clone()].split(separates).enumerate() {
        if index == column {
            let blank = piece.len() - piece.trim_start().len();
            let length = piece.trim().len();
            return start + blank..start + blank + length;
        }
        start += piece.len() + 1;
    }
    line
}

/// What spreadsheets write where a formula has no value. At the beginning of a line it looks like a comment.
const NO_VALUE: [&str; 7] = [
    "#N/A", "#REF!", "#VALUE!", "#DIV/0!", "#NAME?", "#NUM!", "#NULL!",
];

/// What stands in the place of a value where a row begins, if it is such a mark.
pub(super) fn no_value(line: &str, delimiter: u8) -> Option<&'static str> {
    let begins = |mark: &&str| {
        let rest = line.strip_prefix(mark).map(str::trim_start);
        rest.is_some_and(|rest| rest.as_bytes().first() == Some(&delimiter))
    };
    NO_VALUE.into_iter().find(begins)
}
