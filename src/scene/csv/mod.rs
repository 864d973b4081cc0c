//! Text of data files: takes lines, returns cells, headers with units, and the numbers of cells.

pub(super) mod cell;
pub(super) mod header;
pub(super) mod lines;

use super::number::with_unit;

/// Unit of the numbers in a column.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// SI value of one unit.
    pub factor: f64,
    pub unit: String,
}

impl Column {
    /// Creates a column whose numbers are SI values.
    pub fn si(unit: &str) -> Column {
        Column {
            factor: 1.0,
            unit: unit.to_owned(),
        }
    }

    /// Whether the numbers are counts of an encoder.
    pub fn is_counts(&self) -> bool {
        self.unit == "counts"
    }

    /// Formats an SI value in the unit of the column.
    pub fn shown(&self, value: f64) -> String {
        with_unit(value / self.factor, &self.unit)
    }
}
