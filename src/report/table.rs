//! Rows of a result by their columns, as CSV files, pictures and pages read them.

use std::borrow::Cow;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use rayon::prelude::*;
use serde::Serialize;

use super::Output;
use super::csv::{self, CsvCell};
use super::quantity::Quantity;
use crate::error::Error;

/// Rows of a result by their columns.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Column>,
    /// Every so many rows of the result are here.
    pub(super) stride: u64,
    /// Columns at the end that are for pictures and pages only.
    pub(super) beside: usize,
}

#[derive(Clone, Debug)]
struct Column {
    name: String,
    cells: Cells,
}

/// What stands in a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// In SI, or in a unit as people wrote it; not a number where there is none.
    Numbers(Vec<f64>, Option<String>),
    /// What is no number.
    Words(Vec<String>),
}

impl Table {
    /// No rows yet, under the header of a CSV file.
    pub fn new(header: &str) -> Table {
        let column = |name: &str| Column {
            name: name.to_owned(),
            cells: Cells::Numbers(Vec::new(), None),
        };
        Table {
            columns: header.split(',').map(column).collect(),
            stride: 1,
            beside: 0,
        }
    }

    /// Takes a row of numbers; what is not finite has no value.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        for (column, value) in self.columns.iter_mut().zip(row) {
            if let Cells::Numbers(values, _) = &mut column.cells {
                values.push(value);
            }
        }
    }

    /// The columns with their names.
    pub fn into_columns(self) -> impl Iterator<Item = (String, Cells)> {
        let columns = self.columns.into_iter();
        columns.map(|column| (column.name, column.cells))
    }

    /// Rows of cells: numbers where all cells of a column are, in one unit.
    pub(super) fn of_rows<N: AsRef<str> + Sync>(header: &[N], rows: &[Vec<CsvCell>]) -> Table {
        static NONE: CsvCell = CsvCell::EMPTY;
        let column = |(i, name): (usize, &N)| Column {
            name: name.as_ref().to_owned(),
            cells: Cells::of(rows.iter().map(|row| row.get(i).unwrap_or(&NONE))),
        };
        Table {
            columns: header.par_iter().enumerate().map(column).collect(),
            stride: 1,
            beside: 0,
        }
    }

    /// Values of a column in SI, or in the unit that people wrote; none of words.
    pub(super) fn numbers(&self, name: &str) -> Option<&[f64]> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        column.cells.numbers()
    }

    /// Names of the columns.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    /// Writes the columns of numbers as CSV, without those for pictures only.
    pub(super) fn csv(&self, output: Output) -> Result<(), Error> {
        let columns = &self.columns[..self.columns.len() - self.beside];
        let header: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        let columns = columns.iter().filter_map(|column| column.cells.numbers());
        let columns: Vec<&[f64]> = columns.collect();
        let rows: Vec<usize> = (0..columns.first().map_or(0, |values| values.len())).collect();
        csv::write_all(output, &header.join(","), &rows, |row, text| {
            csv::line(columns.iter().map(|values| values[*row]), text);
        })
    }

    /// The columns for the page.
    pub(super) fn shown(&self) -> Vec<Shown<'_>> {
        self.columns.iter().map(Column::shown).collect()
    }
}

impl Cells {
    fn numbers(&self) -> Option<&[f64]> {
        match self {
            Cells::Numbers(values, _) => Some(values),
            Cells::Words(_) => None,
        }
    }

    fn of<'a>(cells: impl Iterator<Item = &'a CsvCell> + Clone) -> Cells {
        let known = |cell: &CsvCell| matches!(cell, CsvCell::Number(_)) || *cell == CsvCell::EMPTY;
        if cells.clone().all(known) {
            let numbers = cells.map(|cell| cell.number().unwrap_or(f64::NAN));
            return Cells::Numbers(numbers.collect(), None);
        }
        let texts: Vec<Cow<'_, str>> = cells.map(CsvCell::text).collect();
        let given = || texts.iter().filter(|text| !text.is_empty());
        let mut units = given().map(|text| number_and_unit(text).map(|(_, unit)| unit));
        let unit = units.next().flatten();
        if unit.is_none() || !units.all(|other| other == unit) {
            return Cells::Words(texts.into_iter().map(Cow::into_owned).collect());
        }
        let number = |text: &Cow<str>| number_and_unit(text).map_or(f64::NAN, |(number, _)| number);
        let unit = unit.filter(|unit| !unit.is_empty()).map(str::to_owned);
        Cells::Numbers(texts.iter().map(number).collect(), unit)
    }
}

/// A number and what follows it.
fn number_and_unit(cell: &str) -> Option<(f64, &str)> {
    let end = cell.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c)));
    let (number, unit) = cell.split_at(end.unwrap_or(cell.len()));
    Some((number.parse().ok()?, unit.trim()))
}

impl Column {
    fn shown(&self) -> Shown<'_> {
        let mut quantity = Quantity::of(&self.name);
        let (data, words) = match &self.cells {
            Cells::Numbers(values, given) => {
                if let Some(given) = given {
                    quantity.unit.to_mut().clone_from(given);
                }
                let bytes = values.iter().flat_map(|value| value.to_le_bytes());
                (
                    Some(BASE64_STANDARD.encode(bytes.collect::<Vec<u8>>())),
                    None,
                )
            }
            Cells::Words(words) => (None, Some(&words[..])),
        };
        Shown {
            name: &self.name,
            quantity,
            data,
            words,
        }
    }
}

/// A column on the page.
#[derive(Serialize)]
pub(super) struct Shown<'a> {
    name: &'a str,
    #[serde(flatten)]
    quantity: Quantity,
    /// Numbers of 64 bits, little end first, in base 64: each as it is in the CSV file.
    #[serde(skip_serializing_if = "Option::is_none")]
    data: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    words: Option<&'a [String]>,
}
