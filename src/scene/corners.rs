//! Where loads are not smooth, as far as their tables say so.

use std::f64::consts::TAU;
use std::iter::successors;

use super::{Load, Repeats, Table, Variable};

impl Load {
    /// Crank angles, rad, at which the load is not smooth, as far as a table says so. Those of one that keeps step with
    /// the turns are the same in each of them, or in each second one and so on, and whole turns do not count.
    pub fn angle_corners(&self) -> Vec<f64> {
        match self.angle_table() {
            Some((table, Step::With(turns))) => {
                let first = table.rows()[0];
                let mut rows = table.rows_between(first, first + turns * TAU);
                rows.push(first);
                rows
            }
            Some((table, Step::None)) => table.rows().to_vec(),
            Some((_, Step::Without)) | None => Vec::new(),
        }
    }

    /// Angles between two others, rad, at which a table over the crank angle is not smooth.
    pub fn corners_between(&self, low: f64, high: f64) -> Vec<f64> {
        let table = self.angle_table();
        table.map_or_else(Vec::new, |(table, _)| table.rows_between(low, high))
    }

    /// Corners between two angles, rad, of a table that does not keep step with the turns.
    pub fn corners_out_of_step(&self, low: f64, high: f64) -> Vec<f64> {
        match self.angle_table() {
            Some((table, Step::Without)) => table.rows_between(low, high),
            _ => Vec::new(),
        }
    }

    /// The first of them, rad, after `from` on the way to `to`, in either direction.
    pub fn corner_out_of_step(&self, from: f64, to: f64) -> Option<f64> {
        match self.angle_table() {
            Some((_, Step::Without)) => self.row_on_way(from, to),
            _ => None,
        }
    }

    /// The first row, rad, of a table over the crank angle after `from` on the way to `to`, in either direction.
    pub fn row_on_way(&self, from: f64, to: f64) -> Option<f64> {
        let table = self.table().filter(|table| table.of() == Variable::Theta)?;
        let way = (to - from).abs();
        // Within a period there is one.
        let far = table.period().map_or(way, |period| period.min(way));
        let reach = from + far * (to - from).signum();
        let (low, high) = (from.min(reach), from.max(reach));
        let next = |row: &f64| Some(table.next_row(*row));
        let mut rows = successors(next(&low), next).take_while(|row| *row < high);
        if from < to { rows.next() } else { rows.last() }
    }

    /// A table over the crank angle, and how it keeps step with the turns.
    fn angle_table(&self) -> Option<(&Table, Step)> {
        let table = self.table()?;
        (table.of() == Variable::Theta).then(|| (table, Step::of(table)))
    }

    /// The next time after `t` (s) at which the load is not smooth in time; infinite if it is not known.
    pub fn next_corner(&self, t: f64) -> f64 {
        match self {
            Load::Table(table) if table.of() == Variable::T => table.next_row(t),
            Load::Dry(magnitude) => magnitude.next_corner(t),
            _ => f64::INFINITY,
        }
    }
}

/// How a table over the crank angle keeps step with the turns.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    /// The load does not repeat.
    None,
    /// The load repeats after so many turns.
    With(f64),
    /// The load repeats, but not after whole turns, or it has too many rows.
    Without,
}

impl Step {
    /// More rows than this in a turn are found one by one, not listed.
    const MOST_ROWS: f64 = 1e5;

    fn of(table: &Table) -> Step {
        if table.period().is_none() {
            return Step::None;
        }
        match table.repeats() {
            Repeats::After(period) => {
                let turns = f64::from(period.whole_turns());
                let periods = turns * TAU / period.radians();
                if table.rows().len() as f64 * periods <= Step::MOST_ROWS * turns {
                    Step::With(turns)
                } else {
                    Step::Without
                }
            }
            _ => Step::Without,
        }
    }
}
