//! Rows of a table, checked before a curve is laid through them.

use super::Interpolation;
use crate::numeric::interpolate::Curve;
use crate::scene::csv::Column;
use crate::scene::number::{apart, counted, show};
use crate::scene::{Period, Problem, Variable};

/// Arguments or values that differ by less than this part of the whole count as equal: the last digit of calculators, which
/// show 2π as 6.283185307.
const SAME: f64 = 1e-9;

/// The rows of a table that is not checked yet.
pub(super) struct Rows<'a> {
    pub of: Variable,
    /// Argument and value, SI.
    pub points: Vec<(f64, f64)>,
    /// Units of argument and value.
    pub columns: [Column; 2],
    /// What begins a message about the whole table.
    pub whole: String,
    /// What begins a message about one row, counted from 0.
    pub place: &'a dyn Fn(usize) -> String,
}

impl Rows<'_> {
    /// The curve through the rows.
    pub fn curve(
        mut self,
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<Curve, Problem> {
        self.rise()?;
        if let Some(period) = period {
            self.close(period)?;
        }
        let period = period.map(|period| self.in_turns(period));
        let (x, y) = self.points.into_iter().unzip();
        Ok(Curve::new(x, y, interpolation, period))
    }

    /// The period (rad or s), which for a table over the crank angle is the fraction of a turn that its digits tell.
    fn in_turns(&self, period: f64) -> f64 {
        if self.of != Variable::Theta || Period::of_angle(period).is_ok() {
            return period;
        }
        let span = self.points[self.points.len() - 1].0 - self.points[0].0;
        let meant = Period::as_written(period).map(Period::radians);
        meant.ok().filter(|meant| span < *meant).unwrap_or(period)
    }

    fn rise(&self) -> Result<(), Problem> {
        let points = &self.points;
        if points.len() < 2 {
            let rows = counted(points.len(), "row");
            let what = format!("{}{rows} where at least 2 are needed", self.whole);
            return Err(columns_error(self.of, what));
        }
        let finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        if let Some(row) = points.iter().position(|point| !finite(point)) {
            let what = format!("{}a value is not finite", (self.place)(row));
            return Err(columns_error(self.of, what));
        }
        if let Some(i) = points.windows(2).position(|w| w[1].0 <= w[0].0) {
            let factor = self.columns[0].factor;
            let what = format!(
                "{}the first column must rise strictly, but {} does not follow {}",
                (self.place)(i + 1),
                show(points[i + 1].0 / factor),
                show(points[i].0 / factor)
            );
            return Err(columns_error(self.of, what));
        }
        Ok(())
    }

    /// Takes off the last row of a table that repeats if it is the first one again.
    fn close(&mut self, period: f64) -> Result<(), Problem> {
        let [argument, value] = &self.columns;
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        let span = last.0 - first.0;
        let period_error = |what: String| {
            let help = "give the whole period after which the table repeats, or leave it out";
            Problem::new("period", what, help)
        };
        if !matches!(self.of, Variable::Theta | Variable::T) {
            let what = format!("a table over {} cannot repeat", self.of.name());
            return Err(period_error(what));
        }
        if !(period > 0.0 && period.is_finite()) {
            let what = format!("the period {} is not positive", argument.shown(period));
            return Err(period_error(what));
        }
        if span > period * (1.0 + SAME) {
            return Err(period_error(format!(
                "the period {} is shorter than the table, which spans {}",
                argument.shown(period),
                argument.shown(span)
            )));
        }
        if span < period * (1.0 - SAME) {
            return Ok(());
        }
        let largest = self.points.iter().fold(0.0f64, |m, p| m.max(p.1.abs()));
        if (last.1 - first.1).abs() > SAME * largest {
            let (last, first) = apart(last.1 / value.factor, first.1 / value.factor);
            let what = format!(
                "{}it spans one period, so its last value must be its first one again, but they are {last} and {first}",
                self.whole
            );
            return Err(Problem::new(
                "file",
                what,
                "let the last row repeat the first value, or leave that row out",
            ));
        }
        if self.points.len() < 3 {
            let what = format!(
                "{}a repeating table needs at least 2 rows within its period",
                self.whole
            );
            return Err(Problem::new(
                "file",
                what,
                "add rows between the first and the last",
            ));
        }
        self.points.pop();
        Ok(())
    }
}

/// A problem with the columns of a table over `of`.
pub(super) fn columns_error(of: Variable, what: String) -> Problem {
    let help = format!(
        "the file has two columns with units in the header, as `{} [unit],value [unit]`, and rising rows",
        of.name()
    );
    Problem::new("file", what, help)
}
