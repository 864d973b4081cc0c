//! Tables from CSV files.

use std::path::Path;

use super::pairs::Pairs;
use super::rows::{Rows, columns_error};
use super::{Interpolation, Table};
#[cfg(feature = "cli")]
use crate::error::Error;
use crate::scene::csv::{Column, header};
use crate::scene::unit::Quantity;
use crate::scene::{Problem, Variable, text};

impl Table {
    /// Reads a CSV file with a header that names both columns and their units; problems name the key of the load that is to
    /// be changed.
    pub(in crate::scene) fn read(
        file: &Path,
        of: Variable,
        value: Quantity,
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<Table, Problem> {
        let name = file.display().to_string();
        let bytes = std::fs::read(file).map_err(|error| {
            let what = format!("`{name}` cannot be read: {error}");
            let help = "give the path of a CSV file, relative to the scene file";
            Problem::new("file", what, help)
        })?;
        let wrong = |what: String| columns_error(of, what);
        let text = text::decoded(bytes).map_err(|what| wrong(format!("{name}: {what}")))?;
        let pairs = Pairs::new(&name, &text);
        let columns = columns(&pairs, of, value).map_err(wrong)?;
        let list = pairs.numbers().map_err(wrong)?;
        let [x, y] = [columns[0].factor, columns[1].factor];
        let rows = Rows {
            of,
            points: list.iter().map(|pair| (pair.x * x, pair.y * y)).collect(),
            columns,
            whole: format!("{name}: "),
            place: &|row| pairs.at(list[row].row, ""),
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
    let Ok(cells) = Pairs::new(&name, &text).header("") else {
        return Ok(None);
    };
    let [first, second] = cells.map(header::split);
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
fn columns(pairs: &Pairs, of: Variable, value: Quantity) -> Result<[Column; 2], String> {
    let cells = pairs.header(&format!("{} [unit],value [unit]", of.name()))?;
    let [first, second] = cells.map(header::split);
    let wrong = |what: String| pairs.at(cells[0], &what);
    if first.name != of.name() {
        return Err(wrong(format!(
            "the first column is `{}` where `{}` is expected",
            first.name,
            of.name()
        )));
    }
    Ok([
        first.column(of.quantity()).map_err(wrong)?,
        second.column(value).map_err(wrong)?,
    ])
}
