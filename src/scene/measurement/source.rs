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

/// A reader of the records of a data file, its header not among them.
pub(super) fn reader(text: &str, delimiter: u8, has_header: bool) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .has_headers(has_header)
        .from_reader(text.as_bytes())
}

impl Source {
    /// The byte at which the record of a sample ends.
    fn end(&self, sample: usize) -> usize {
        let mut reader = reader(&self.text, self.delimiter, self.has_header);
        let mut record = ByteRecord::new();
        for _ in 0..=sample {
            if !matches!(reader.read_byte_record(&mut record), Ok(true)) {
                break;
            }
        }
        usize::try_from(reader.position().byte()).unwrap_or(self.text.len())
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
    let end = end.min(text.len());
    let read = text.as_bytes()[..end].trim_ascii_end().len();
    let start = text[..read].rfind(['\n', '\r']).map_or(0, |at| at + 1);
    start..read
}

/// The bytes of a cell, from 0, of the line that ends at or before a byte; the whole line if there is no such
/// cell.
pub(super) fn cell(text: &str, end: usize, delimiter: u8, column: usize) -> Range<usize> {
    let line = line_at(text, end);
    let mut start = line.start;
    for (index, piece) in text[line.clone()].split(char::from(delimiter)).enumerate() {
        if index == column {
            let blank = piece.len() - piece.trim_start().len();
            let length = piece.trim().len();
            return start + blank..start + blank + length;
        }
        start += piece.len() + 1;
    }
    line
}
