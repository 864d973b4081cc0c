//! Rows of a result by their columns, as pictures and pages read them.

use std::borrow::Cow;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use rayon::prelude::*;
use serde::Serialize;

use super::csv::shortest;
use crate::report::quantity::Quantity;

/// Rows of a result by their columns.
#[derive(Debug)]
pub struct Table {
    columns: Vec<Column>,
    /// Every so many rows of the result are here.
    pub(super) stride: u64,
}

#[derive(Debug)]
struct Column {
    name: String,
    cells: Cells,
}

/// A cell of a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cell {
    Number(f64),
    Text(String),
}

impl Cell {
    /// No value.
    pub const EMPTY: Cell = Cell::Text(String::new());

    /// From a CSV file.
    pub fn read(text: &str) -> Cell {
        let number = text.parse();
        number.map_or_else(|_| Cell::Text(text.to_owned()), Cell::Number)
    }

    /// The number, if there is a finite one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Cell::Number(number) => Some(*number).filter(|number| number.is_finite()),
            Cell::Text(_) => None,
        }
    }

    /// In a CSV file.
    pub fn text(&self) -> Cow<'_, str> {
        match self {
            Cell::Number(number) => shortest(*number).into(),
            Cell::Text(text) => text.into(),
        }
    }
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

    /// Rows of the cells of a CSV file: numbers where all cells of a column are, in one unit.
    pub(super) fn of_cells(header: &[String], rows: &[Vec<String>]) -> Table {
        let column = |(i, name): (usize, &String)| Column {
            name: name.clone(),
            cells: Cells::of(rows.iter().map(|row| row.get(i).map_or("", String::as_str))),
        };
        Table {
            columns: header.iter().enumerate().map(column).collect(),
            stride: 1,
        }
    }

    /// Rows of cells: numbers where all cells of a column are.
    pub(super) fn of_rows(header: &[String], rows: &[Vec<Cell>]) -> Table {
        static NONE: Cell = Cell::EMPTY;
        let column = |(i, name): (usize, &String)| Column {
            name: name.clone(),
            cells: Cells::of_column(rows.iter().map(|row| row.get(i).unwrap_or(&NONE))),
        };
        Table {
            columns: header.par_iter().enumerate().map(column).collect(),
            stride: 1,
        }
    }

    /// Values of a column in SI, or in the unit that people wrote; none of words.
    pub(super) fn numbers(&self, name: &str) -> Option<&[f64]> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        match &column.cells {
            Cells::Numbers(values, _) => Some(values),
            Cells::Words(_) => None,
        }
    }

    /// Names of the columns.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    /// The columns for the page.
    pub(super) fn shown(&self) -> Vec<Shown<'_>> {
        self.columns.iter().map(Column::shown).collect()
    }
}

impl Cells {
    fn of_column<'a>(cells: impl Iterator<Item = &'a Cell> + Clone) -> Cells {
        let known = |cell: &Cell| matches!(cell, Cell::Number(_)) || *cell == Cell::EMPTY;
        if cells.clone().all(known) {
            let numbers = cells.map(|cell| cell.number().unwrap_or(f64::NAN));
            return Cells::Numbers(numbers.collect(), None);
        }
        let texts: Vec<Cow<'_, str>> = cells.map(Cell::text).collect();
        Cells::of(texts.iter().map(AsRef::as_ref))
    }

    fn of<'a>(cells: impl Iterator<Item = &'a str> + Clone) -> Cells {
        let mut units = cells
            .clone()
            .filter_map(|cell| number_and_unit(cell).map(|(_, unit)| unit));
        let unit = units.next().unwrap_or_default();
        let all = cells
            .clone()
            .all(|cell| cell.is_empty() || number_and_unit(cell).is_some());
        if !all || !units.all(|other| other == unit) {
            return Cells::Words(cells.map(str::to_owned).collect());
        }
        let number = |cell: &str| number_and_unit(cell).map_or(f64::NAN, |(number, _)| number);
        let given = (!unit.is_empty()).then(|| unit.to_owned());
        Cells::Numbers(cells.map(number).collect(), given)
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
                (Some(encoded(values)), None)
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

fn encoded(values: &[f64]) -> String {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    BASE64_STANDARD.encode(bytes)
}
