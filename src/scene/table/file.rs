//! Tables from CSV files.

use std::path::Path;

use csv::StringRecord;

use super::header;
use super::pairs::Pairs;
use super::rows::{Column, Rows, columns_error};
use super::{Interpolation, Table, TableError};
#[cfg(feature = "cli")]
use crate::error::Error;
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

/// A load as a table in a file of its own.
#[cfg(feature = "cli")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadTable {
    /// What it is a table of.
    pub of: Variable,
    /// What it gives, with its article.
    pub gives: &'static str,
    /// How many rows it has.
    pub rows: usize,
}

/// The table of a load in a CSV file; none if its two columns do not say that it is one: a variable, and a torque, a
/// force or a pressure by its unit.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, [`Error::Refused`] with what is wrong with the table.
#[cfg(feature = "cli")]
pub fn load_table(file: &Path) -> Result<Option<LoadTable>, Error> {
    let name = file.display().to_string();
    let Ok(text) = text::decoded(text::bytes(file)?) else {
        return Ok(None);
    };
    let Ok(pairs) = Pairs::new(&name, &text) else {
        return Ok(None);
    };
    let [first, second] = [0, 1].map(|at| pairs.header().get(at).map(header::split));
    let (Some(first), Some(second), 2) = (first, second, pairs.header().len()) else {
        return Ok(None);
    };
    let loads = [Quantity::Torque, Quantity::Force, Quantity::Pressure];
    let load = loads
        .into_iter()
        .find(|load| second.clone().column(*load).is_ok());
    let (Some(of), Some(load)) = (Variable::named(&first.name), load) else {
        return Ok(None);
    };
    let table = Table::read(file, of, load, Interpolation::Pchip, None)
        .map_err(|error| Error::refused(error.what, error.help))?;
    Ok(Some(LoadTable {
        of,
        gives: load.name(),
        rows: table.rows().len(),
    }))
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
