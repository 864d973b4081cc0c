//! Takes the rows of a table, checks them and returns the interpolating curve.

use super::Interpolation;
use crate::numeric::interpolate::TableInterpolant;
use crate::scene::csv::Column;
use crate::scene::number::{apart, counted, show};
use crate::scene::{Period, Problem, Variable};

/// Rows of a table before their check.
pub(super) struct TableRows<'a> {
    pub of: Variable,
    /// Argument and value, SI.
    pub points: Vec<(f64, f64)>,
    /// Units of argument and value.
    pub columns: [Column; 2],
    /// Prefix of a message about the whole table.
    pub whole: String,
    /// Prefix of a message about one row, counted from 0.
    pub place: &'a dyn Fn(usize) -> String,
}

impl TableRows<'_> {
    /// Checks the rows and returns the curve through them.
    pub fn curve(
        mut self,
        interpolation: Interpolation,
        period: Option<f64>,
    ) -> Result<TableInterpolant, Problem> {
        self.rise()?;
        if let Some(period) = period {
            self.close(period)?;
        }
        let period = period.map(|period| self.in_turns(period));
        let (x, y) = self.points.into_iter().unzip();
        Ok(TableInterpolant::new(x, y, interpolation, period))
    }

    /// Returns the period (rad or s); over the crank angle the fraction of a turn that its digits stand for, if any.
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
        let wrong =
            |place: &str, what: String| Err(columns_error(self.of, format!("{place}{what}")));
        if points.len() < 2 {
            let rows = counted(points.len(), "row");
            return wrong(&self.whole, format!("{rows} where at least 2 are needed"));
        }
        let finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        if let Some(row) = points.iter().position(|point| !finite(point)) {
            return wrong(&(self.place)(row), "a value is not finite".to_owned());
        }
        if let Some(i) = points.windows(2).position(|w| w[1].0 <= w[0].0) {
            let [before, next] = [i, i + 1].map(|i| show(points[i].0 / self.columns[0].factor));
            let what =
                format!("the first column must rise strictly, but {next} does not follow {before}");
            return wrong(&(self.place)(i + 1), what);
        }
        Ok(())
    }

    /// Checks the period, and drops the last row if it repeats the first one period later.
    fn close(&mut self, period: f64) -> Result<(), Problem> {
        let [argument, value] = &self.columns;
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        let span = last.0 - first.0;
        let shown = argument.shown(period);
        let period_error = |what: String| {
            let help = "give the whole period after which the table repeats, or leave it out";
            Err(Problem::new("period", what, help))
        };
        if !matches!(self.of, Variable::Theta | Variable::T) {
            return period_error(format!("a table over {} cannot repeat", self.of.name()));
        }
        if !(period > 0.0 && period.is_finite()) {
            return period_error(format!("the period {shown} is not positive"));
        }
        // Relative tolerance of equal arguments and values: the last digit of calculators, which show 2π as 6.283185307.
        let last_digit = 1e-9;
        if span > period * (1.0 + last_digit) {
            let span = argument.shown(span);
            return period_error(format!(
                "the period {shown} is shorter than the table, which spans {span}"
            ));
        }
        if span < period * (1.0 - last_digit) {
            return Ok(());
        }
        let whole = &self.whole;
        let largest = self.points.iter().fold(0.0f64, |m, p| m.max(p.1.abs()));
        if (last.1 - first.1).abs() > last_digit * largest {
            let (last, first) = apart(last.1 / value.factor, first.1 / value.factor);
            let what = format!(
                "{whole}it spans one period, so its last value must be its first one again, but they are {last} and {first}"
            );
            let help = "let the last row repeat the first value, or leave that row out";
            return Err(Problem::new("file", what, help));
        }
        if self.points.len() < 3 {
            let what = format!("{whole}a repeating table needs at least 2 rows within its period");
            let help = "add rows between the first and the last";
            return Err(Problem::new("file", what, help));
        }
        self.points.pop();
        Ok(())
    }
}

/// Creates the problem of the columns of a table over `of`.
pub(super) fn columns_error(of: Variable, what: String) -> Problem {
    let help = format!(
        "the file has two columns with units in the header, as `{} [unit],value [unit]`, and rising rows",
        of.name()
    );
    Problem::new("file", what, help)
}
