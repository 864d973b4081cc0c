//! Which columns of a data file hold the time and the measured value.

use std::borrow::Cow;

use csv::ByteRecord;

use super::{Measured, Reading};
use crate::scene::table::header::{self, Header};
use crate::scene::table::rows::Column;
use crate::scene::unit::Quantity;

/// The columns of a data file.
#[derive(Debug)]
pub(super) struct Columns {
    pub measured: Measured,
    /// Positions of time and value.
    pub at: [usize; 2],
    pub time: Column,
    pub value: Column,
    /// Whether numbers have decimal commas.
    pub decimal_comma: bool,
    /// How many columns the header has.
    pub count: usize,
    /// What the reader should know.
    pub note: Option<String>,
}

/// A problem with a column, or with the header as a whole.
#[derive(Debug)]
pub(super) struct ColumnProblem {
    pub column: Option<usize>,
    pub what: String,
    pub help: String,
}

const HELP: &str = "the header names the columns with their units, as `t [s],theta [deg]`; the motion is theta, gamma or x";

/// Finds the columns in a header.
pub(super) fn columns(header: &ByteRecord, reading: &Reading) -> Result<Columns, ColumnProblem> {
    let cells: Vec<String> = header
        .iter()
        .map(|cell| String::from_utf8_lossy(cell).into_owned())
        .collect();
    let wrong = |column: Option<usize>, what: String| ColumnProblem {
        column,
        what,
        help: HELP.to_owned(),
    };
    if let Some(at) = cells.iter().position(|cell| cell.parse::<f64>().is_ok()) {
        return Err(ColumnProblem {
            help: "put a header above the numbers, as `t [s],theta [deg]`, or say what the columns are: --columns \"t [s],theta [deg]\"".to_owned(),
            ..wrong(Some(at), format!("there is no header: `{}` is a number", cells[at]))
        });
    }
    let headers: Vec<Header> = cells.iter().map(|cell| header::split(cell)).collect();
    let find = |names: &[&str]| -> Result<Option<usize>, ColumnProblem> {
        let mut found = (0..headers.len()).filter(|i| names.contains(&headers[*i].name.as_str()));
        let (first, second) = (found.next(), found.next());
        match second {
            Some(again) => Err(wrong(
                Some(again),
                format!("there are two columns `{}`", headers[again].name),
            )),
            None => Ok(first),
        }
    };
    let Some(time) = find(&["t", "time"])? else {
        let what = "no column holds the time: none is called t or time".to_owned();
        return Err(wrong(None, only(&cells, what)));
    };
    let mut found = Vec::new();
    for measured in Measured::ALL {
        if let Some(at) = find(&[measured.name()])? {
            found.push((measured, at));
        }
    }
    let chosen = match reading.column {
        Some(wanted) => found.iter().find(|(measured, _)| *measured == wanted),
        None => found.first(),
    };
    let Some(&(measured, value)) = chosen else {
        let what = match reading.column {
            Some(wanted) => format!("no column is called `{}`", wanted.name()),
            None => only(&cells, "no column is called theta, gamma or x".to_owned()),
        };
        return Err(wrong(None, what));
    };
    let others: Vec<&str> = found
        .iter()
        .filter(|(other, _)| *other != measured)
        .map(|(other, _)| other.name())
        .collect();
    let unit = |at: usize, quantity: Quantity| {
        let column = headers[at].clone().column(quantity);
        column.map_err(|what| wrong(Some(at), what))
    };
    Ok(Columns {
        measured,
        at: [time, value],
        time: unit(time, Quantity::Time)?,
        value: unit(value, measured.quantity())?,
        decimal_comma: reading.decimal_comma,
        count: cells.len(),
        note: (reading.column.is_none() && !others.is_empty()).then(|| {
            format!(
                "the motion is taken from the column {}; {} is not used",
                measured.name(),
                others.join(" and ")
            )
        }),
    })
}

/// The message for a header of one column, which is most often one that is not split.
fn only(cells: &[String], what: String) -> String {
    match cells {
        [one] => format!(
            "{what}; the header has one column, `{one}`; columns are separated by comma, semicolon or tab"
        ),
        _ => what,
    }
}

/// A number with a decimal point, whatever the file has; none if that has the other one.
pub(super) fn with_point<'a>(cell: &'a str, columns: &Columns) -> Option<Cow<'a, str>> {
    match columns.decimal_comma {
        false => Some(Cow::Borrowed(cell)),
        true if cell.contains('.') => None,
        true => Some(Cow::Owned(cell.replacen(',', ".", 1))),
    }
}
