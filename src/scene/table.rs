//! Loads given by measured or designed values: two columns, interpolated.

use std::fmt;
use std::path::Path;

use super::header;
use super::load::Variable;
use super::unit::Quantity;
use crate::numeric::interpolate::Curve;
pub use crate::numeric::interpolate::Interpolation;

/// Values over one variable, SI and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    of: Variable,
    curve: Curve,
    name: String,
}

impl Table {
    /// A table of code. Arguments must rise strictly; with a `period` the table repeats, and a last
    /// point one period after the first must repeat its value.
    ///
    /// # Errors
    /// A text that says which point is wrong, counted from 1.
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
        let mut points: Vec<(f64, f64)> = arguments
            .iter()
            .copied()
            .zip(values.iter().copied())
            .collect();
        if arguments.len() != values.len() {
            return Err(format!(
                "{} arguments but {} values",
                arguments.len(),
                values.len()
            ));
        }
        check(&points, |point| format!("point {}", point + 1))?;
        close(&mut points, of, period)?;
        let (x, y) = points.into_iter().unzip();
        Ok(Table {
            of,
            curve: Curve::new(x, y, interpolation, period),
            name: "table".to_owned(),
        })
    }

    /// Reads a CSV file with a header that names both columns and their units.
    pub(super) fn read(
        file: &Path,
        of: Variable,
        value: Quantity,
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<Table, String> {
        let text = std::fs::read_to_string(file)
            .map_err(|e| format!("`{}` cannot be read: {e}", file.display()))?;
        let place = |line: u64| format!("{} line {line}", file.display());
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter(&text))
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| e.to_string())?.clone();
        let header_line = header.position().map_or(1, csv::Position::line);
        let factors = columns(&header, of, value)
            .map_err(|what| format!("{}: {what}", place(header_line)))?;
        let mut points = Vec::new();
        let mut lines = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| e.to_string())?;
            let line = record.position().map_or(0, csv::Position::line);
            if record.len() != 2 {
                return Err(format!(
                    "{}: {} values where 2 are expected",
                    place(line),
                    record.len()
                ));
            }
            let number = |column: usize| {
                record[column].parse::<f64>().map_err(|_| {
                    format!(
                        "{} column {}: `{}` is not a number",
                        place(line),
                        column + 1,
                        &record[column]
                    )
                })
            };
            points.push((number(0)? * factors.0, number(1)? * factors.1));
            lines.push(line);
        }
        check(&points, |point| place(lines[point]))
            .and_then(|()| close(&mut points, of, period))
            .map_err(|what| {
                if what.starts_with(&file.display().to_string()) {
                    what
                } else {
                    format!("{}: {what}", file.display())
                }
            })?;
        let (x, y) = points.into_iter().unzip();
        Ok(Table {
            of,
            curve: Curve::new(x, y, interpolation, period),
            name: file.display().to_string(),
        })
    }

    /// The variable it is a table of.
    pub fn of(&self) -> Variable {
        self.of
    }

    /// The interpolated value; NaN outside a table that does not repeat.
    pub fn value(&self, at: f64) -> f64 {
        self.curve.value(at)
    }

    /// First and last argument of a table that does not repeat.
    pub fn range(&self) -> Option<(f64, f64)> {
        self.curve.period().is_none().then(|| self.curve.range())
    }

    /// The period of a table that repeats.
    pub fn period(&self) -> Option<f64> {
        self.curve.period()
    }

    /// The first row after `at`, periods counted; infinite if there is none.
    pub fn next_row(&self, at: f64) -> f64 {
        self.curve.next_point(at)
    }

    pub(super) fn is_zero(&self) -> bool {
        self.curve.values().iter().all(|y| *y == 0.0)
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} over {}", self.name, self.of.name())
    }
}

fn delimiter(text: &str) -> u8 {
    let first = text
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .unwrap_or_default();
    [b';', b'\t']
        .into_iter()
        .find(|d| first.as_bytes().contains(d))
        .unwrap_or(b',')
}

/// The variable's quantity.
fn quantity(of: Variable) -> Quantity {
    match of {
        Variable::T => Quantity::Time,
        Variable::Theta => Quantity::Angle,
        Variable::Omega => Quantity::AngularSpeed,
        Variable::X => Quantity::Length,
        Variable::V => Quantity::Velocity,
    }
}

/// SI factors of the two columns.
fn columns(
    headers: &csv::StringRecord,
    of: Variable,
    value: Quantity,
) -> Result<(f64, f64), String> {
    if headers.len() != 2 {
        return Err(format!(
            "{} columns where 2 are expected: `{}` and the value",
            headers.len(),
            of.name()
        ));
    }
    if headers.iter().any(|h| h.parse::<f64>().is_ok()) {
        return Err(format!(
            "the first line must name the columns with their units, as `{} [unit],value [unit]`",
            of.name()
        ));
    }
    let first = header::split(&headers[0]);
    if first.name != of.name() {
        return Err(format!(
            "the first column is `{}` where `{}` is expected",
            first.name,
            of.name()
        ));
    }
    let second = header::split(&headers[1]);
    Ok((first.factor(quantity(of))?, second.factor(value)?))
}

fn check(points: &[(f64, f64)], place: impl Fn(usize) -> String) -> Result<(), String> {
    if points.len() < 2 {
        return Err(format!("{} rows where at least 2 are needed", points.len()));
    }
    if let Some(i) = points
        .iter()
        .position(|(x, y)| !x.is_finite() || !y.is_finite())
    {
        return Err(format!("{}: a value is not finite", place(i)));
    }
    if let Some(i) = points.windows(2).position(|w| w[1].0 <= w[0].0) {
        return Err(format!(
            "{}: the first column must rise strictly, but {} does not follow {}",
            place(i + 1),
            points[i + 1].0,
            points[i].0
        ));
    }
    Ok(())
}

/// Takes off the last point of a table that repeats if it is the first one again.
fn close(points: &mut Vec<(f64, f64)>, of: Variable, period: Option<f64>) -> Result<(), String> {
    let Some(period) = period else { return Ok(()) };
    if !matches!(of, Variable::Theta | Variable::T) {
        return Err(format!("a table over {} cannot repeat", of.name()));
    }
    let (first, last) = (points[0], points[points.len() - 1]);
    let span = last.0 - first.0;
    if !(period > 0.0 && period.is_finite()) || span > period * (1.0 + 1e-9) {
        return Err(format!(
            "the period {period} is shorter than the table, which spans {span}"
        ));
    }
    if span >= period * (1.0 - 1e-9) {
        let largest = points.iter().fold(0.0f64, |m, p| m.max(p.1.abs()));
        if (last.1 - first.1).abs() > 1e-9 * largest {
            return Err(format!(
                "it spans one period, so its last value must be its first one again, but they are {} and {}",
                last.1, first.1
            ));
        }
        if points.len() < 3 {
            return Err("a repeating table needs at least 2 rows within its period".to_owned());
        }
        points.pop();
    }
    Ok(())
}
