//! CSV: shortest numbers that read back the same, empty cells for what does not exist.

use rayon::prelude::*;

use super::Output;
use crate::error::Error;

/// Rows whose text one core makes at a time.
const PIECE: usize = 1 << 12;

/// Appends the shortest text that reads back as the same number; nothing for what is not finite.
pub(super) fn number(value: f64, text: &mut Vec<u8>) {
    if value.is_finite() {
        let mut buffer = zmij::Buffer::new();
        let shortest = buffer.format_finite(value + 0.0);
        text.extend(shortest.strip_suffix(".0").unwrap_or(shortest).as_bytes());
    }
}

/// A number as a cell.
pub(super) fn shortest(value: f64) -> String {
    let mut text = Vec::new();
    number(value, &mut text);
    String::from_utf8(text).unwrap_or_default()
}

/// Appends a text, in quotes where a cell needs them.
pub(super) fn word(value: &str, text: &mut Vec<u8>) {
    if value.contains([',', '"', '\n', '\r']) {
        text.push(b'"');
        text.extend(value.replace('"', "\"\"").as_bytes());
        text.push(b'"');
    } else {
        text.extend(value.as_bytes());
    }
}

/// Appends a line of numbers.
pub(super) fn line(values: impl IntoIterator<Item = f64>, text: &mut Vec<u8>) {
    for (i, value) in values.into_iter().enumerate() {
        if i > 0 {
            text.push(b',');
        }
        number(value, text);
    }
    text.push(b'\n');
}

/// Writes a header and the lines of all rows, their texts made on all cores, and completes the output.
pub(super) fn write_all<Row: Sync>(
    mut output: Output,
    header: &str,
    rows: &[Row],
    line: impl Fn(&Row, &mut Vec<u8>) + Sync,
) -> Result<(), Error> {
    output.write(format!("{header}\n").as_bytes())?;
    let text_of = |rows: &[Row]| {
        let mut text = Vec::new();
        rows.iter().for_each(|row| line(row, &mut text));
        text
    };
    for rows in rows.chunks(PIECE * rayon::current_num_threads()) {
        let texts: Vec<Vec<u8>> = rows.par_chunks(PIECE).map(text_of).collect();
        for text in texts {
            output.write(&text)?;
        }
    }
    output.finish()
}

pub(super) fn failed(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Error {
    Error::Write {
        target: "CSV".to_owned(),
        source: std::io::Error::other(error),
    }
}

/// Rows of words and numbers, with quotes where a cell needs them.
pub(super) fn quoted<'a, Row: IntoIterator<Item = String>>(
    header: impl IntoIterator<Item = &'a str>,
    rows: impl IntoIterator<Item = Row>,
) -> Result<String, Error> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    let mut header = header.into_iter().peekable();
    if header.peek().is_some() {
        writer.write_record(header).map_err(failed)?;
    }
    for row in rows {
        writer.write_record(row).map_err(failed)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| failed(error.to_string()))?;
    String::from_utf8(bytes).map_err(failed)
}
