//! Corners of loads: arguments at which a load is not smooth, known from the rows of tables.

use std::f64::consts::TAU;
use std::iter::successors;

use super::{Load, Periodicity, Table, Variable};

impl Load {
    /// Returns the crank angles, rad, at which the load is not smooth, from its table: all rows if the table has no
    /// period; the rows of one cycle if it is in step with the turns; none otherwise ([`Load::out_of_step`]).
    pub fn angle_corners(&self) -> Vec<f64> {
        let Some(table) = self.angle_table() else {
            return Vec::new();
        };
        match (table.period(), turns_in_step(table)) {
            (None, _) => table.rows().to_vec(),
            (_, Some(turns)) => {
                let first = table.rows()[0];
                let mut rows = table.curve.points_between(first, first + turns * TAU);
                rows.push(first);
                rows
            }
            (_, None) => Vec::new(),
        }
    }

    /// Returns the crank angles between two others, rad, at which a table over the crank angle is not smooth.
    pub fn corners_between(&self, low: f64, high: f64) -> Vec<f64> {
        let table = self.angle_table();
        table.map_or_else(Vec::new, |table| table.curve.points_between(low, high))
    }

    /// Returns the first row, rad, of a table over the crank angle after `from` towards `to`, in either direction.
    pub fn row_on_way(&self, from: f64, to: f64) -> Option<f64> {
        let table = self.angle_table()?;
        let way = (to - from).abs();
        // Each period has a row: one period is far enough.
        let far = table.period().map_or(way, |period| period.min(way));
        let reach = from + far * (to - from).signum();
        let (low, high) = (from.min(reach), from.max(reach));
        let next = |row: &f64| Some(table.curve.next_point(*row));
        let mut rows = successors(next(&low), next).take_while(|row| *row < high);
        if from < to { rows.next() } else { rows.last() }
    }

    /// Returns the next time after `t` (s) at which the load is not smooth in time; infinite if none is known.
    pub fn next_corner(&self, t: f64) -> f64 {
        match self {
            Load::Table(table) if table.of() == Variable::T => table.curve.next_point(t),
            Load::Dry(magnitude) => magnitude.next_corner(t),
            _ => f64::INFINITY,
        }
    }

    fn angle_table(&self) -> Option<&Table> {
        self.table().filter(|table| table.of() == Variable::Theta)
    }

    /// Returns the load if its table over the crank angle is periodic, but not in step with the turns.
    pub fn out_of_step(&self) -> Option<&Load> {
        let table = self.angle_table()?;
        (table.period().is_some() && turns_in_step(table).is_none()).then_some(self)
    }
}

/// Returns the whole turns after which a table over the crank angle repeats, if it has few enough rows in a turn for
/// their corners to be listed; with more, corners are looked up row by row.
fn turns_in_step(table: &Table) -> Option<f64> {
    let Periodicity::After(period) = table.repeats() else {
        return None;
    };
    let turns = f64::from(period.whole_turns());
    let periods = turns * TAU / period.radians();
    let most_rows_of_turn = 1e5;
    (table.rows().len() as f64 * periods <= most_rows_of_turn * turns).then_some(turns)
}
