//! Tables from CSV files.

use std::path::Path;

use csv::StringRecord;

use super::header;
use super::rows::{Column, Rows, columns_error};
use super::{Interpolation, Table, TableError};
use crate::error::Error;
use crate::scene::Variable;
use crate::scene::number::{self, counted};
use crate::scene::unit::Quantity;

impl Table {
    /// Reads a CSV file with a header that names both columns and their units.
    pub(in crate::scene) fn read(
        file: &Path,
        of: Variable,
        value: Quantity,
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<Table, TableError> {
        let name = file.display().to_string();
        let text = std::fs::read_to_string(file).map_err(|e| TableError {
            key: "file",
            what: format!("`{name}` cannot be read: {e}"),
            help: "give the path of a CSV file, relative to the scene file".to_owned(),
        })?;
        let wrong = |what: String| columns_error(of, what);
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter(&text))
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        // A record's own position is where the search for it begins, before comments and empty lines;
        // the byte at which it ends tells its line.
        let place = |end: u64| format!("{name} line {}", line_before(&text, end));
        let header = reader.headers().map_err(|e| wrong(e.to_string()))?.clone();
        let end = reader.position().byte();
        let columns =
            columns(&header, of, value).map_err(|what| wrong(format!("{}: {what}", place(end))))?;
        let (mut points, mut ends) = (Vec::new(), Vec::new());
        let mut record = StringRecord::new();
        while reader
            .read_record(&mut record)
            .map_err(|e| wrong(e.to_string()))?
        {
            let end = reader.position().byte();
            let (x, y) = point(&record).map_err(|what| wrong(format!("{}{what}", place(end))))?;
            points.push((x * columns[0].factor, y * columns[1].factor));
            ends.push(end);
        }
        let rows = Rows {
            of,
            points,
            columns,
            whole: format!("{name}: "),
            place: &|row| format!("{}: ", place(ends[row])),
        };
        let curve = rows.curve(interpolation, period)?;
        Ok(Table { of, curve, name })
    }
}

/// Reads a calibration: loads with a unit of force in the first column, N, readings of any kind in the
/// second. The rows may stand in any order.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, [`Error::Refused`] with line and column for what is no
/// calibration.
pub fn calibration_points(file: &Path) -> Result<Vec<(f64, f64)>, Error> {
    let name = file.display().to_string();
    let text = std::fs::read_to_string(file).map_err(|source| Error::Read {
        file: file.to_owned(),
        source,
    })?;
    let wrong = |what: String| {
        Error::refused(
            what,
            "the file has two columns, as `load [N],reading`, and a row for each load",
        )
    };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter(&text))
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let place = |end: u64| format!("{name} line {}", line_before(&text, end));
    let header = reader.headers().map_err(|e| wrong(e.to_string()))?.clone();
    let end = reader.position().byte();
    if header.len() != 2 || header.iter().any(|h| h.parse::<f64>().is_ok()) {
        let what = format!("{}: the first line must name two columns", place(end));
        return Err(wrong(what));
    }
    let load = header::split(&header[0])
        .column(Quantity::Force)
        .map_err(|what| wrong(format!("{}: {what}", place(end))))?;
    let mut points = Vec::new();
    let mut record = StringRecord::new();
    while reader
        .read_record(&mut record)
        .map_err(|e| wrong(e.to_string()))?
    {
        let end = reader.position().byte();
        let (x, y) = point(&record).map_err(|what| wrong(format!("{}{what}", place(end))))?;
        if !(x.is_finite() && y.is_finite()) {
            return Err(wrong(format!("{}: a value is not finite", place(end))));
        }
        points.push((x * load.factor, y));
    }
    Ok(points)
}

/// The number of the line that ends at or before a byte of the text, from 1.
fn line_before(text: &str, end: u64) -> usize {
    let end = usize::try_from(end).map_or(text.len(), |end| end.min(text.len()));
    let read = text.as_bytes()[..end].trim_ascii_end();
    read.iter().filter(|byte| **byte == b'\n').count() + 1
}

/// The two numbers of a row, or what follows its place in the message.
fn point(record: &StringRecord) -> Result<(f64, f64), String> {
    if record.len() != 2 {
        return Err(format!(
            ": {} where 2 are expected",
            counted(record.len(), "value")
        ));
    }
    let number = |column: usize| {
        let cell = &record[column];
        number::plain(cell).parse::<f64>().map_err(|_| {
            let what = if cell.replacen(',', ".", 1).parse::<f64>().is_ok() {
                "has a decimal comma where a point is expected"
            } else {
                "is not a number"
            };
            format!(" column {}: `{cell}` {what}", column + 1)
        })
    };
    Ok((number(0)?, number(1)?))
}

/// What separates the columns: a semicolon or a tab if the first line has one, else a comma.
pub(in crate::scene) fn delimiter(text: &str) -> u8 {
    let first = text
        .trim_start_matches('\u{feff}')
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .unwrap_or_default();
    [b';', b'\t']
        .into_iter()
        .find(|d| first.as_bytes().contains(d))
        .unwrap_or(b',')
}

/// Units of the two columns.
fn columns(headers: &StringRecord, of: Variable, value: Quantity) -> Result<[Column; 2], String> {
    if headers.len() != 2 {
        return Err(format!(
            "{} where 2 are expected: `{}` and the value",
            counted(headers.len(), "column"),
            of.name()
        ));
    }
    if headers.iter().any(|h| h.parse::<f64>().is_ok()) {
        return Err(format!(
            "the first line must name the columns with their units, as `{} [unit],value [unit]`",
            of.name()
        ));
    }
    let first = header::split(&headers[0]);
    if first.name != of.name() {
        return Err(format!(
            "the first column is `{}` where `{}` is expected",
            first.name,
            of.name()
        ));
    }
    let argument = match of {
        Variable::T => Quantity::Time,
        Variable::Theta => Quantity::Angle,
        Variable::Omega => Quantity::AngularSpeed,
        Variable::X => Quantity::Length,
        Variable::V => Quantity::Velocity,
    };
    Ok([
        first.column(argument)?,
        header::split(&headers[1]).column(value)?,
    ])
}
