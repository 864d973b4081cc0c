//! Where loads are not smooth, as far as their tables say so.

use std::f64::consts::TAU;
use std::iter::successors;

use super::{Load, Repeats, Table, Variable};

/// Tables with more rows than this in a turn are not listed but looked up row by row.
const MOST_ROWS: f64 = 1e5;

impl Load {
    /// Crank angles, rad, at which the load is not smooth, as far as a table says so. Those of one that keeps step with
    /// the turns are the same in each of them, or in each second one and so on, and whole turns do not count.
    pub fn angle_corners(&self) -> Vec<f64> {
        let Some(table) = self.angle_table() else {
            return Vec::new();
        };
        match (table.period(), turns_in_step(table)) {
            (None, _) => table.rows().to_vec(),
            (_, Some(turns)) => {
                let first = table.rows()[0];
                let mut rows = table.rows_between(first, first + turns * TAU);
                rows.push(first);
                rows
            }
            (_, None) => Vec::new(),
        }
    }

    /// Angles between two others, rad, at which a table over the crank angle is not smooth.
    pub fn corners_between(&self, low: f64, high: f64) -> Vec<f64> {
        let table = self.angle_table();
        table.map_or_else(Vec::new, |table| table.rows_between(low, high))
    }

    /// Corners between two angles, rad, of a table that does not keep step with the turns.
    pub fn corners_out_of_step(&self, low: f64, high: f64) -> Vec<f64> {
        match self.is_out_of_step() {
            true => self.corners_between(low, high),
            false => Vec::new(),
        }
    }

    /// The first of them, rad, after `from` on the way to `to`, in either direction.
    pub fn corner_out_of_step(&self, from: f64, to: f64) -> Option<f64> {
        let is_asked = self.is_out_of_step();
        is_asked.then(|| self.row_on_way(from, to)).flatten()
    }

    /// The first row, rad, of a table over the crank angle after `from` on the way to `to`, in either direction.
    pub fn row_on_way(&self, from: f64, to: f64) -> Option<f64> {
        let table = self.angle_table()?;
        let way = (to - from).abs();
        // Within a period there is one.
        let far = table.period().map_or(way, |period| period.min(way));
        let reach = from + far * (to - from).signum();
        let (low, high) = (from.min(reach), from.max(reach));
        let next = |row: &f64| Some(table.next_row(*row));
        let mut rows = successors(next(&low), next).take_while(|row| *row < high);
        if from < to { rows.next() } else { rows.last() }
    }

    /// The next time after `t` (s) at which the load is not smooth in time; infinite if it is not known.
    pub fn next_corner(&self, t: f64) -> f64 {
        match self {
            Load::Table(table) if table.of() == Variable::T => table.next_row(t),
            Load::Dry(magnitude) => magnitude.next_corner(t),
            _ => f64::INFINITY,
        }
    }

    fn angle_table(&self) -> Option<&Table> {
        self.table().filter(|table| table.of() == Variable::Theta)
    }

    /// Whether a table over the crank angle repeats, but not in step with the turns.
    fn is_out_of_step(&self) -> bool {
        let out = |table: &Table| table.period().is_some() && turns_in_step(table).is_none();
        self.angle_table().is_some_and(out)
    }
}

/// Whole turns after which a table over the crank angle repeats, if it has few enough rows in a turn.
fn turns_in_step(table: &Table) -> Option<f64> {
    let Repeats::After(period) = table.repeats() else {
        return None;
    };
    let turns = f64::from(period.whole_turns());
    let periods = turns * TAU / period.radians();
    (table.rows().len() as f64 * periods <= MOST_ROWS * turns).then_some(turns)
}
