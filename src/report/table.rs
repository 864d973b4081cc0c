//! Column-wise table of the rows of a result, source of CSV files, pictures and pages.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use rayon::prelude::*;
use serde::Serialize;

use super::Output;
use super::csv::{self, CsvCell};
use super::quantity::Quantity;
use crate::error::Error;

/// Rows of a result, stored by column.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Column>,
    /// Sampling interval: the table holds every `stride`-th row of the result.
    pub(super) stride: u64,
    /// Number of columns at the end that only pictures and pages use.
    pub(super) plot_only_columns: usize,
}

#[derive(Clone, Debug)]
struct Column {
    name: String,
    cells: Cells,
}

/// Content of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Numbers in SI units; NaN for a missing value.
    Numbers(Vec<f64>),
    /// Texts.
    Words(Vec<String>),
}

impl Table {
    /// Returns an empty table with the columns of a CSV header.
    pub(super) fn new(header: &str) -> Table {
        let names = header.split(',');
        Table::of_numbers(names.map(|name| (name.to_owned(), Vec::new())))
    }

    /// Returns a table of rows of numbers under a CSV header.
    pub(super) fn filled<R: IntoIterator<Item = f64>>(
        header: &str,
        rows: impl IntoIterator<Item = R>,
    ) -> Table {
        let mut table = Table::new(header);
        rows.into_iter().for_each(|row| table.push(row));
        table
    }

    /// Returns a table of columns of numbers, one value for each row, with their names.
    pub(super) fn of_numbers(columns: impl IntoIterator<Item = (String, Vec<f64>)>) -> Table {
        let column = |(name, values)| Column {
            name,
            cells: Cells::Numbers(values),
        };
        Table::of_columns(columns.into_iter().map(column).collect())
    }

    fn of_columns(columns: Vec<Column>) -> Table {
        Table {
            columns,
            stride: 1,
            plot_only_columns: 0,
        }
    }

    /// Appends a row of numbers; a number that is not finite counts as missing.
    pub(super) fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        for (column, value) in self.columns.iter_mut().zip(row) {
            if let Cells::Numbers(values) = &mut column.cells {
                values.push(value);
            }
        }
    }

    /// Returns the columns with their names.
    pub fn into_columns(self) -> impl Iterator<Item = (String, Cells)> {
        let columns = self.columns.into_iter();
        columns.map(|column| (column.name, column.cells))
    }

    /// Returns a table of rows of cells; a column holds numbers if all its cells are numbers or empty.
    pub(super) fn of_rows<N: AsRef<str> + Sync>(header: &[N], rows: &[Vec<CsvCell>]) -> Table {
        static NONE: CsvCell = CsvCell::EMPTY;
        let column = |(i, name): (usize, &N)| Column {
            name: name.as_ref().to_owned(),
            cells: Cells::of(rows.iter().map(|row| row.get(i).unwrap_or(&NONE))),
        };
        Table::of_columns(header.par_iter().enumerate().map(column).collect())
    }

    /// Returns the numbers of a column, in SI units; none for texts or an unknown column.
    pub(super) fn numbers(&self, name: &str) -> Option<&[f64]> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        column.cells.numbers()
    }

    /// Returns the names of the columns.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    /// Drops the columns that only pictures and pages use.
    pub(super) fn without_plot_columns(mut self) -> Table {
        let kept = self.columns.len() - self.plot_only_columns;
        self.columns.truncate(kept);
        self
    }

    /// Writes the columns of numbers as CSV, without those that only pictures and pages use.
    pub fn csv(self, output: Output) -> Result<(), Error> {
        let table = self.without_plot_columns();
        let header: Vec<&str> = table.names().collect();
        let columns = table.columns.iter();
        let columns: Vec<&[f64]> = columns.filter_map(|one| one.cells.numbers()).collect();
        csv::write_columns(output, &header.join(","), &columns)
    }

    /// Returns the columns, encoded for the page.
    pub(super) fn shown(&self) -> Vec<Shown<'_>> {
        self.columns.iter().map(Column::shown).collect()
    }
}

impl Cells {
    fn numbers(&self) -> Option<&[f64]> {
        match self {
            Cells::Numbers(values) => Some(values),
            Cells::Words(_) => None,
        }
    }

    fn of<'a>(cells: impl Iterator<Item = &'a CsvCell> + Clone) -> Cells {
        let is_number = |cell: &CsvCell| !matches!(cell, CsvCell::Text(text) if !text.is_empty());
        match cells.clone().all(is_number) {
            true => Cells::Numbers(
                cells
                    .map(|cell| cell.number().unwrap_or(f64::NAN))
                    .collect(),
            ),
            false => Cells::Words(cells.map(|cell| cell.text().into_owned()).collect()),
        }
    }
}

impl Column {
    fn shown(&self) -> Shown<'_> {
        let (data, words) = match &self.cells {
            Cells::Numbers(values) => {
                let bytes = values.iter().flat_map(|value| value.to_le_bytes());
                let bytes: Vec<u8> = bytes.collect();
                (Some(BASE64_STANDARD.encode(bytes)), None)
            }
            Cells::Words(words) => (None, Some(&words[..])),
        };
        Shown {
            quantity: Quantity::of(&self.name),
            data,
            words,
        }
    }
}

/// Column encoded for the page.
#[derive(Serialize)]
pub(super) struct Shown<'a> {
    #[serde(flatten)]
    quantity: Quantity,
    /// Numbers as little-endian 64-bit floats in base 64, equal to those of the CSV file.
    #[serde(skip_serializing_if = "Option::is_none")]
    data: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    words: Option<&'a [String]>,
}
