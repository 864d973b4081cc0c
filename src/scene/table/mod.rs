//! Tables of measured or designed values over one variable, interpolated.

mod file;
mod rows;

use std::fmt;
use std::path::{Path, PathBuf};

use super::csv::Column;
use super::{Period, Periodicity, Variable, WhyNot};
use crate::numeric::enclosure::{Enclosed, Interval};
pub use crate::numeric::interpolate::Interpolation;
use crate::numeric::interpolate::TableInterpolant;
pub use file::{LoadTable, calibration_points, load_table};
use rows::TableRows;

/// Interpolated values over one variable, SI and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    of: Variable,
    pub(super) curve: TableInterpolant,
    /// File the table was read from; none for a table from code.
    file: Option<PathBuf>,
}

impl Table {
    /// Creates a table from code. Arguments must rise strictly; with a `period` the table repeats, and a last point one
    /// period after the first must repeat its value.
    ///
    /// # Errors
    /// Text that names the point at fault, counted from 1.
    ///
    /// ```
    /// use slider_crank::scene::{Interpolation, Table, Variable};
    /// let drive = Table::new(
    ///     Variable::Omega, &[0.0, 50.0, 150.0], &[5.0, 4.0, 0.0], Interpolation::Pchip, None,
    /// ).unwrap();
    /// assert_eq!(drive.value(50.0), 4.0);
    /// ```
    pub fn new(
        of: Variable,
        arguments: &[f64],
        values: &[f64],
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<Table, String> {
        let (count, of_values) = (arguments.len(), values.len());
        if count != of_values {
            return Err(format!("{count} arguments but {of_values} values"));
        }
        let arguments = arguments.iter().copied();
        let rows = TableRows {
            of,
            points: arguments.zip(values.iter().copied()).collect(),
            columns: [Column::si(of.quantity().si()), Column::si("")],
            whole: String::new(),
            place: &|point| format!("point {}: ", point + 1),
        };
        let curve = rows.curve(interpolation, period);
        let (curve, file) = (curve.map_err(|error| error.what)?, None);
        Ok(Table { of, curve, file })
    }

    /// Returns the variable of the arguments.
    pub fn of(&self) -> Variable {
        self.of
    }

    /// Returns the file the table was read from; none for a table from code.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Returns the interpolated value, in SI; NaN outside a table without period.
    pub fn value(&self, at: f64) -> f64 {
        self.curve.value(at)
    }

    /// Encloses all values over an interval, in SI.
    pub fn enclose(&self, over: Interval) -> Enclosed {
        self.curve.enclose(over)
    }

    /// Returns the period (rad or s), if the table has one.
    pub fn period(&self) -> Option<f64> {
        self.curve.period
    }

    /// Returns the period of a table over the crank angle as a fraction of a turn, or why there is none.
    pub fn repeats(&self) -> Periodicity {
        let period = self.curve.period.ok_or(WhyNot::NoPeriod);
        period.and_then(Period::of_angle).into()
    }

    /// Returns the arguments of the rows.
    pub fn rows(&self) -> &[f64] {
        &self.curve.x
    }

    /// Returns the value farthest from zero, with its sign, SI.
    pub(super) fn farthest_from_zero(&self) -> f64 {
        let values = self.curve.y.iter().copied();
        let farther = |most: f64, y: f64| if y.abs() > most.abs() { y } else { most };
        values.fold(0.0, farther)
    }

    /// Returns the least value, SI.
    pub(super) fn least(&self) -> f64 {
        let values = self.curve.y.iter().copied();
        values.fold(f64::INFINITY, f64::min)
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.file {
            Some(file) => write!(f, "{} over {}", file.display(), self.of.name()),
            None => write!(f, "table over {}", self.of.name()),
        }
    }
}
