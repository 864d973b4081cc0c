//! Tables from CSV files.

use std::path::Path;

use csv::StringRecord;

use super::header;
use super::pairs::Pairs;
use super::rows::{Column, Rows, columns_error};
use super::{Interpolation, Table, TableError};
use crate::scene::number::counted;
use crate::scene::unit::Quantity;
use crate::scene::{Variable, text};

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
        let bytes = std::fs::read(file).map_err(|e| TableError {
            key: "file",
            what: format!("`{name}` cannot be read: {e}"),
            help: "give the path of a CSV file, relative to the scene file".to_owned(),
        })?;
        let wrong = |what: String| columns_error(of, what);
        let text = text::decoded(bytes).map_err(|what| wrong(format!("{name}: {what}")))?;
        let mut pairs = Pairs::new(&name, &text).map_err(wrong)?;
        let place = pairs.place(pairs.end());
        let columns =
            columns(pairs.header(), of, value).map_err(|what| wrong(format!("{place}: {what}")))?;
        let (mut points, mut ends) = (Vec::new(), Vec::new());
        while let Some((x, y)) = pairs.next().map_err(wrong)? {
            points.push((x * columns[0].factor, y * columns[1].factor));
            ends.push(pairs.end());
        }
        let rows = Rows {
            of,
            points,
            columns,
            whole: format!("{name}: "),
            place: &|row| format!("{}: ", pairs.place(ends[row])),
        };
        let curve = rows.curve(interpolation, period)?;
        let file = Some(file.to_owned());
        Ok(Table { of, curve, file })
    }
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
