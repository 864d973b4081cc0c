//! Headers of measured columns: what their words and units say.

use super::Measured;
use super::clock::is_clock;
use super::columns::{ColumnProblem, HELP, wrong};
use crate::scene::table::header::{self, Header};
use crate::scene::table::rows::Column;
use crate::scene::unit::{self, Quantity};

/// A column as it stands in a file.
#[derive(Clone, Debug)]
pub(super) struct Named {
    /// Its header as written, or its number.
    pub raw: String,
    /// Name in lower case; empty if there is no header.
    pub name: String,
    /// Its unit as written, empty if there is none.
    pub unit: String,
    /// Whether its values are dates or hours of the day.
    pub is_clock: bool,
}

/// Words of headers for the time.
pub(super) const TIME: [&str; 6] = ["t", "time", "zeit", "temps", "tiempo", "elapsed time"];

/// Words of headers for what is measured, beside its name.
const WORDS: [(&str, Measured); 8] = [
    ("crank angle", Measured::Theta),
    ("crankangle", Measured::Theta),
    ("angle", Measured::Theta),
    ("kurbelwinkel", Measured::Theta),
    ("winkel", Measured::Theta),
    ("crank pin angle", Measured::Gamma),
    ("slider position", Measured::X),
    ("position", Measured::X),
];

/// Units, and names without a unit, of a column that counts the steps of an encoder.
pub(super) const COUNTS: [&str; 5] = ["count", "counts", "pulses", "ticks", "increments"];

/// The columns below a header, with a row of units or none, above a first row of values.
pub(super) fn named(names: &[&str], units: &[&str], first: &[&str]) -> Vec<Named> {
    let column = |at: usize| {
        let raw = names
            .get(at)
            .map_or_else(|| (at + 1).to_string(), |name| (*name).to_owned());
        let Header { name, unit } = header::split(names.get(at).unwrap_or(&""));
        let below = units
            .get(at)
            .map(|unit| header::bare(unit))
            .unwrap_or_default();
        let unit = if unit.is_empty() {
            below.to_owned()
        } else {
            unit
        };
        let is_clock = first.get(at).is_some_and(|cell| is_clock(cell));
        Named {
            raw,
            name,
            unit,
            is_clock,
        }
    };
    let count = if names.is_empty() {
        first.len()
    } else {
        names.len()
    };
    (0..count).map(column).collect()
}

impl Named {
    /// Whether it holds counts of an encoder.
    pub fn is_count(&self) -> bool {
        is_count(if self.unit.is_empty() {
            &self.name
        } else {
            &self.unit
        })
    }

    /// What its header says that it holds.
    pub fn measured(&self) -> Option<Measured> {
        let own = Measured::ALL
            .into_iter()
            .find(|measured| measured.name() == self.name);
        let word = || WORDS.iter().find(|(word, _)| *word == self.name);
        own.or_else(|| Some(word()?.1))
            .or_else(|| self.is_count().then_some(Measured::Theta))
    }

    /// What its unit says that it holds: an angle may be two of them, and is that of the crank.
    pub fn measured_by_unit(&self) -> Option<Measured> {
        let has = |quantity| unit::factor(&self.unit, quantity).is_ok();
        if has(Quantity::Angle) {
            Some(Measured::Theta)
        } else {
            has(Quantity::Length).then_some(Measured::X)
        }
    }

    /// Its unit, which must be one of a quantity.
    pub fn column(
        &self,
        at: usize,
        quantity: Quantity,
        option: &str,
    ) -> Result<Column, ColumnProblem> {
        let name = if self.name.is_empty() {
            self.raw.clone()
        } else {
            self.name.clone()
        };
        let column = Header {
            name,
            unit: self.unit.clone(),
        }
        .column(quantity);
        column.map_err(|what| {
            let help = format!(
                "{HELP}; or here: {option} \"{}[{}]\"",
                at + 1,
                header::example(quantity)
            );
            ColumnProblem {
                help,
                ..wrong(Some(at), what)
            }
        })
    }
}

/// Whether a word says that a column counts the steps of an encoder.
pub(super) fn is_count(word: &str) -> bool {
    COUNTS.contains(&word.to_lowercase().as_str())
}
