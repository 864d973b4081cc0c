//! Motion as a table of rows, from a run or a file, and its interpolation at other times.

use std::path::Path;

use crate::error::Error;
use crate::report::csv::CsvCell;
use crate::report::quantity::split;
use crate::report::rows::{cells, header};
use crate::report::table::Table;
use crate::scene::{Measured, Measurement, Reading};
use crate::simulate::Row;

/// Motion as a table of rows, with the name of its scene or file.
#[derive(Debug)]
pub struct Motion {
    pub(super) name: String,
    pub(super) table: Table,
}

impl Motion {
    /// Returns the motion of the rows of a run.
    pub fn of_rows(name: &str, rows: &[Row]) -> Motion {
        let header = rows.first().map_or(TIME.to_owned(), header);
        Motion {
            name: name.to_owned(),
            table: Table::filled(&header, rows.iter().map(cells)),
        }
    }

    /// Reads the motion of a file: rows written by this program, else a measured motion. [`Error::Read`] and
    /// [`Error::Scene`] for a file that is neither.
    pub fn of_file(file: &Path) -> Result<Motion, Error> {
        let name = file.display().to_string();
        if let Some(table) = own_rows(file) {
            return Ok(Motion { name, table });
        }
        let measured = Measurement::load(file, &Reading::default())?;
        let of = measured.measured();
        let column = of.quantity().column(of.name());
        let values = match of {
            Measured::Theta => measured.unwrapped()?.theta,
            _ => measured.values().to_vec(),
        };
        let times = (TIME.to_owned(), measured.times().to_vec());
        let table = Table::of_numbers([times, (column, values)]);
        Ok(Motion { name, table })
    }

    /// Returns the times of the rows, s.
    pub fn times(&self) -> &[f64] {
        self.table.numbers(TIME).unwrap_or_default()
    }

    /// Whether a time (s) lies within the rows.
    pub(super) fn covers(&self, t: f64) -> bool {
        let ends = self.times().first().zip(self.times().last());
        ends.is_some_and(|(first, last)| (*first..=*last).contains(&t))
    }

    /// Returns a column at other times, NaN outside its rows, and whether any value is interpolated.
    pub(super) fn at(&self, column: &str, times: &[f64]) -> (Vec<f64>, bool) {
        let own = self.times();
        let values = self.table.numbers(column).unwrap_or_default();
        let mut between = false;
        let mut value = |t: f64| {
            let after = own.partition_point(|own| *own < t);
            match own.get(after) {
                Some(own) if *own == t => values[after],
                Some(_) if after > 0 => {
                    between = true;
                    interpolated(own, values, after, t)
                }
                _ => f64::NAN,
            }
        };
        (times.iter().map(|t| value(*t)).collect(), between)
    }
}

/// Name of the column of times.
pub(super) const TIME: &str = "t_s";

/// Reads rows written by this program: numbers under names with units, time first; none for any other file.
fn own_rows(file: &Path) -> Option<Table> {
    let mut reader = ::csv::Reader::from_path(file).ok()?;
    let names: Vec<String> = reader.headers().ok()?.iter().map(str::to_owned).collect();
    let known = |name: &String| !split(name).1.is_empty() || name.starts_with("near_");
    let starts = names.first().is_some_and(|first| first == TIME);
    if !starts || names.len() < 2 || !names.iter().all(known) {
        return None;
    }
    let rows: Result<Vec<Vec<CsvCell>>, _> = reader
        .records()
        .map(|row| row.map(|row| row.iter().map(CsvCell::read).collect()))
        .collect();
    let table = Table::of_rows(&names, &rows.ok()?);
    let is_whole = names.iter().all(|name| table.numbers(name).is_some());
    is_whole.then_some(table)
}

/// Evaluates at `t` the Lagrange cubic through the four rows about it; `after` is the first row not before `t`.
fn interpolated(times: &[f64], values: &[f64], after: usize, t: f64) -> f64 {
    let first = after.saturating_sub(2).min(times.len().saturating_sub(4));
    let nodes = first..(first + 4).min(times.len());
    let basis = |k: usize| {
        let others = nodes.clone().filter(|other| *other != k);
        others
            .map(|other| (t - times[other]) / (times[k] - times[other]))
            .product::<f64>()
    };
    nodes.clone().map(|k| values[k] * basis(k)).sum()
}
