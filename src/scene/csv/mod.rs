//! Text of data files: how lines divide into cells, what headers say, and the numbers of cells.

pub(super) mod cell;
pub(super) mod header;
pub(super) mod lines;

use super::number::with_unit;

/// The unit in which the numbers of a column stand.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// SI value of one unit.
    pub factor: f64,
    pub unit: String,
}

impl Column {
    /// A column whose numbers are SI values.
    pub fn si(unit: &str) -> Column {
        Column {
            factor: 1.0,
            unit: unit.to_owned(),
        }
    }

    /// A value in SI as it stands in the column.
    pub fn shown(&self, value: f64) -> String {
        with_unit(value / self.factor, &self.unit)
    }
}
