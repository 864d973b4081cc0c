//! CSV writer and reader: numbers as the shortest text that reads back equal, missing values as empty cells.

use std::borrow::Cow;

use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use super::Output;
use crate::error::Error;

/// Cell of a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum CsvCell {
    Number(f64),
    Text(String),
}

impl CsvCell {
    /// Missing value.
    pub const EMPTY: CsvCell = CsvCell::Text(String::new());

    /// Parses a cell: a number if it reads as one, else a text.
    pub fn read(text: &str) -> CsvCell {
        let number = text.parse();
        number.map_or_else(|_| CsvCell::Text(text.to_owned()), CsvCell::Number)
    }

    /// Returns the number if finite.
    pub fn number(&self) -> Option<f64> {
        match self {
            CsvCell::Number(number) => Some(*number).filter(|number| number.is_finite()),
            CsvCell::Text(_) => None,
        }
    }

    /// Returns the text of the cell, unquoted.
    pub fn text(&self) -> Cow<'_, str> {
        match self {
            CsvCell::Number(value) => {
                let mut text = Vec::new();
                number(*value, &mut text);
                String::from_utf8(text).unwrap_or_default().into()
            }
            CsvCell::Text(text) => text.into(),
        }
    }
}

impl From<f64> for CsvCell {
    fn from(value: f64) -> CsvCell {
        CsvCell::Number(value)
    }
}

impl From<Option<f64>> for CsvCell {
    fn from(value: Option<f64>) -> CsvCell {
        value.map_or(CsvCell::EMPTY, CsvCell::Number)
    }
}

impl From<&str> for CsvCell {
    fn from(text: &str) -> CsvCell {
        CsvCell::Text(text.to_owned())
    }
}

/// Appends the shortest text that reads back as the same number; nothing if not finite. Minus zero becomes zero.
fn number(value: f64, text: &mut Vec<u8>) {
    if value.is_finite() {
        let mut buffer = zmij::Buffer::new();
        let shortest = buffer.format_finite(value + 0.0);
        text.extend(shortest.strip_suffix(".0").unwrap_or(shortest).as_bytes());
    }
}

/// Appends a line of numbers, at least one.
pub(super) fn line(values: impl IntoIterator<Item = f64>, text: &mut Vec<u8>) {
    for value in values {
        number(value, text);
        text.push(b',');
    }
    text.pop();
    text.push(b'\n');
}

/// Appends a line of cells, at least one, texts quoted where needed.
pub(super) fn cells<'a>(cells: impl IntoIterator<Item = &'a CsvCell>, text: &mut Vec<u8>) {
    for cell in cells {
        match cell {
            CsvCell::Number(value) => number(*value, text),
            CsvCell::Text(value) if value.contains([',', '"', '\n', '\r']) => {
                text.extend(format!("\"{}\"", value.replace('"', "\"\"")).as_bytes());
            }
            CsvCell::Text(value) => text.extend(value.as_bytes()),
        }
        text.push(b',');
    }
    text.pop();
    text.push(b'\n');
}

/// Returns a CSV text of header and rows.
pub(super) fn text(header: &str, rows: impl IntoIterator<Item = Vec<CsvCell>>) -> String {
    let mut text = format!("{header}\n").into_bytes();
    rows.into_iter().for_each(|row| cells(&row, &mut text));
    String::from_utf8(text).unwrap_or_default()
}

/// Returns the fields of an item with these names as cells; truth as 1, a missing value as an empty cell.
pub(super) fn fields(names: &str, item: &impl Serialize) -> Vec<CsvCell> {
    let item = serde_json::to_value(item).unwrap_or_default();
    let cell = |name: &str| match &item[name] {
        Value::Number(number) => number.as_f64().into(),
        Value::Bool(is) => f64::from(u8::from(*is)).into(),
        Value::String(text) => text.as_str().into(),
        _ => CsvCell::EMPTY,
    };
    names.split(',').map(cell).collect()
}

/// Writes header and columns of numbers, formatted on all cores, and completes the output.
pub(super) fn write_columns(
    mut output: Output,
    header: &str,
    columns: &[&[f64]],
) -> Result<(), Error> {
    output.write(format!("{header}\n").as_bytes())?;
    let text_of = |rows: &[usize]| {
        let mut text = Vec::new();
        for row in rows {
            line(columns.iter().map(|values| values[*row]), &mut text);
        }
        text
    };
    let rows: Vec<usize> = (0..columns.first().map_or(0, |values| values.len())).collect();
    let rows_of_task = 1 << 12;
    for rows in rows.chunks(rows_of_task * rayon::current_num_threads()) {
        let texts: Vec<Vec<u8>> = rows.par_chunks(rows_of_task).map(text_of).collect();
        for text in texts {
            output.write(&text)?;
        }
    }
    output.finish()
}

/// Parses a line of CSV into cells.
pub(super) fn read(line: &str) -> Result<Vec<CsvCell>, Error> {
    let texts = texts(line)?;
    Ok(texts.iter().map(|text| CsvCell::read(text)).collect())
}

/// Parses a line of CSV into the texts of its cells.
pub(super) fn texts(line: &str) -> Result<Vec<String>, Error> {
    let mut reader = ::csv::ReaderBuilder::new();
    let mut reader = reader.has_headers(false).from_reader(line.as_bytes());
    let record = reader.records().next().transpose();
    let record = record.map_err(std::io::Error::other);
    let record = record.map_err(Error::write("CSV"))?;
    let record = record.unwrap_or_default();
    Ok(record.iter().map(str::to_owned).collect())
}
