//! Reads CSV files of two columns: tables of loads, calibrations of instruments.

use std::path::Path;

use super::rows::{TableRows, columns_error};
use super::{Interpolation, Table};
use crate::error::Error;
use crate::scene::csv::Column;
use crate::scene::csv::lines::{Dialect, OPEN_QUOTE, line_number};
use crate::scene::csv::{cell, header};
use crate::scene::number::counted;
use crate::scene::text;
use crate::scene::unit::Quantity;
use crate::scene::{Problem, Variable};

/// Text of two columns of numbers under a header; `name` is that of the file.
struct Pairs {
    name: String,
    text: String,
    dialect: Dialect,
}

impl Pairs {
    /// Decodes the bytes of a file.
    fn decoded(file: &Path, bytes: Vec<u8>) -> Result<Pairs, String> {
        let name = file.display().to_string();
        let text = text::decoded(bytes).map_err(|what| format!("{name}: {what}"))?;
        Ok(Pairs {
            name,
            dialect: Dialect::of(&text, 0),
            text,
        })
    }

    /// Puts the place of a row before a fault in it.
    fn at(&self, row: &str, what: &str) -> String {
        let line = line_number(&self.text, row);
        format!("{} line {line}: {what}", self.name)
    }

    /// Returns the two cells of the header; `expected` is an example of one.
    fn header(&self, expected: &str) -> Result<[&str; 2], String> {
        let row = self.dialect.rows(&self.text).next().unwrap_or_default();
        let what = match self.dialect.list(row)[..] {
            _ if Dialect::open_quote(row).is_some() => OPEN_QUOTE.to_owned(),
            [x, y] if [x, y].iter().all(|cell| cell.parse::<f64>().is_err()) => return Ok([x, y]),
            [_, _] => {
                format!("the first line must name the columns with their units, as `{expected}`")
            }
            [""] => "the file is empty".to_owned(),
            ref cells => {
                let columns = counted(cells.len(), "column");
                format!("{columns} where 2 are expected, as `{expected}`")
            }
        };
        Err(self.at(row, &what))
    }

    /// Returns the rows below the header, each with its two numbers.
    fn numbers(&self) -> Result<Vec<(&str, [f64; 2])>, String> {
        let rows = self.dialect.rows(&self.text).skip(1);
        rows.map(|row| Ok((row, self.pair(row)?))).collect()
    }

    fn pair(&self, row: &str) -> Result<[f64; 2], String> {
        if Dialect::open_quote(row).is_some() {
            return Err(self.at(row, OPEN_QUOTE));
        }
        let cells = self.dialect.list(row);
        let [x, y] = cells[..] else {
            let what = format!("{} where 2 are expected", counted(cells.len(), "value"));
            return Err(self.at(row, &what));
        };
        let number = |column: usize, text: &str| {
            cell::parse(text, false).map_err(|wrong| {
                let line = line_number(&self.text, row);
                format!("{} line {line} column {column}: {}", self.name, wrong.what)
            })
        };
        Ok([number(1, x)?, number(2, y)?])
    }
}

impl Table {
    /// Reads a CSV file with a header that names both columns and their units; problems name the key of the load that
    /// must change.
    pub(in crate::scene) fn read(
        file: &Path,
        of: Variable,
        value: Quantity,
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<Table, Problem> {
        let bytes = std::fs::read(file).map_err(|error| {
            let what = format!("`{}` cannot be read: {error}", file.display());
            let help = "give the path of a CSV file, relative to the scene file";
            Problem::new("file", what, help)
        })?;
        let wrong = |what: String| columns_error(of, what);
        let pairs = Pairs::decoded(file, bytes).map_err(wrong)?;
        let columns = columns(&pairs, of, value).map_err(wrong)?;
        let list = pairs.numbers().map_err(wrong)?;
        let [x, y] = [columns[0].factor, columns[1].factor];
        let rows = TableRows {
            of,
            points: list
                .iter()
                .map(|(_, pair)| (pair[0] * x, pair[1] * y))
                .collect(),
            columns,
            whole: format!("{}: ", pairs.name),
            place: &|row| pairs.at(list[row].0, ""),
        };
        let curve = rows.curve(interpolation, period)?;
        let file = Some(file.to_owned());
        Ok(Table { of, curve, file })
    }
}

/// Returns the units of the two columns.
fn columns(pairs: &Pairs, of: Variable, value: Quantity) -> Result<[Column; 2], String> {
    let of_name = of.name();
    let cells = pairs.header(&format!("{of_name} [unit],value [unit]"))?;
    let [first, second] = cells.map(header::split);
    let columns = match first.name == of_name {
        true => first.into_column(of.quantity()),
        false => Err(format!(
            "the first column is `{}` where `{of_name}` is expected",
            first.name
        )),
    };
    let columns = columns.and_then(|first| Ok([first, second.into_column(value)?]));
    columns.map_err(|what| pairs.at(cells[0], &what))
}

/// Table of a load in a file of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadTable {
    /// Variable of the first column.
    pub of: Variable,
    /// Quantity of the second column, in words with its article.
    pub gives: &'static str,
    /// Number of rows.
    pub rows: usize,
}

/// Reads the table of a load from a CSV file; none if its two columns do not identify one: a variable, and a torque, a
/// force or a pressure by its unit.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, [`Error::Refused`] with the fault of the table.
pub fn load_table(file: &Path) -> Result<Option<LoadTable>, Error> {
    let Ok(pairs) = Pairs::decoded(file, text::bytes(file)?) else {
        return Ok(None);
    };
    let Ok(cells) = pairs.header("") else {
        return Ok(None);
    };
    let [first, second] = cells.map(header::split);
    let mut loads = [Quantity::Torque, Quantity::Force, Quantity::Pressure].into_iter();
    let load = loads.find(|load| second.clone().into_column(*load).is_ok());
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

/// Reads a calibration: loads with a unit of force in the first column, N, readings of any kind in the
/// second. The rows may stand in any order.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, [`Error::Refused`] with line and column if it is no calibration.
pub fn calibration_points(file: &Path) -> Result<Vec<(f64, f64)>, Error> {
    let wrong = |what: String| {
        let help = "the file has two columns, as `load [N],reading`, and a row for each load";
        Error::refused(what, help)
    };
    let pairs = Pairs::decoded(file, text::bytes(file)?).map_err(wrong)?;
    let [load, _] = pairs.header("load [N],reading").map_err(wrong)?;
    let unit = header::split(load).into_column(Quantity::Force);
    let unit = unit.map_err(|what| wrong(pairs.at(load, &what)))?;
    let points = pairs.numbers().map_err(wrong)?;
    let point = |(_, [load, reading]): (&str, [f64; 2])| (load * unit.factor, reading);
    Ok(points.into_iter().map(point).collect())
}
