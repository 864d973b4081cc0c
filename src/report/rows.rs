//! Sinks for the rows of a run: CSV writer, table of columns, and a preview of few rows.

use super::Output;
use super::csv::line;
use super::decimate::Decimated;
use super::table::Table;
use crate::error::Error;
use crate::simulate::{Reactions, Row, RowSink};

const MOTION: &str =
    "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,x_m,v_m_per_s,a_m_per_s2,phi_rad";
pub(super) const REACTIONS: &str = "crank_bearing_x_n,crank_bearing_y_n,crank_pin_x_n,crank_pin_y_n,wrist_pin_x_n,wrist_pin_y_n,guide_n,shaking_x_n,shaking_y_n,shaking_moment_nm";
const CLEARANCE: &str =
    "x_ideal_m,v_ideal_m_per_s,a_ideal_m_per_s2,journal_x_m,journal_y_m,contact_force_n";

/// Maximum number of rows kept for pictures and pages; a page of so many holds about 20 megabytes.
pub(super) const MOST_PLOT_ROWS: usize = 100_000;

/// Returns the cells of the columns [`REACTIONS`], N and N m.
pub(super) fn reactions(forces: &Reactions) -> impl Iterator<Item = f64> {
    let joints = [forces.crank_bearing, forces.crank_pin, forces.wrist_pin];
    let rest = [forces.guide].into_iter().chain(forces.shaking);
    let joints = joints.into_iter().flatten();
    joints.chain(rest).chain([forces.shaking_moment])
}

/// Writer of the rows of `simulate` as CSV.
#[derive(Debug)]
pub struct RowWriter {
    output: Output,
    header: bool,
}

impl RowWriter {
    /// Starts a writer to an output.
    pub fn new(output: Output) -> RowWriter {
        RowWriter {
            output,
            header: false,
        }
    }

    /// Completes the output.
    pub fn finish(self) -> Result<(), Error> {
        self.output.finish()
    }
}

/// Returns the CSV header of rows with the optional parts of `row`.
pub(super) fn header(row: &Row) -> String {
    let mut columns = vec![MOTION];
    columns.extend(row.reactions.map(|_| REACTIONS));
    columns.extend(row.driving_torque.map(|_| "crank_torque_nm"));
    columns.extend(row.clearance.map(|_| CLEARANCE));
    columns.join(",")
}

/// Returns the cells of a row.
pub(super) fn cells(row: &Row) -> Vec<f64> {
    let mut values = vec![
        row.t, row.theta, row.omega, row.alpha, row.x, row.v, row.a, row.phi,
    ];
    if let Some(forces) = &row.reactions {
        values.extend(reactions(forces));
    }
    values.extend(row.driving_torque);
    if let Some(joint) = &row.clearance {
        values.extend(joint.ideal);
        values.extend(joint.journal);
        values.push(joint.force);
    }
    values
}

impl RowSink for RowWriter {
    fn row(&mut self, row: &Row) -> Result<(), Error> {
        if !self.header {
            self.output.write(format!("{}\n", header(row)).as_bytes())?;
            self.header = true;
        }
        let mut text = Vec::with_capacity(256);
        line(cells(row), &mut text);
        self.output.write(&text)
    }
}

/// Table of all rows of `simulate`; none without rows.
impl RowSink for Option<Table> {
    fn row(&mut self, row: &Row) -> Result<(), Error> {
        let table = self.get_or_insert_with(|| Table::new(&header(row)));
        table.push(cells(row));
        Ok(())
    }
}

/// Few rows, evenly spread over a run of unknown length, for a table on the terminal.
#[derive(Debug)]
pub struct Preview {
    few: Decimated<Row>,
    last: Option<Row>,
}

impl Default for Preview {
    fn default() -> Preview {
        // Thinning leaves at least half of them.
        let most_rows = 24;
        Preview {
            few: Decimated::new(most_rows),
            last: None,
        }
    }
}

impl Preview {
    /// Takes a row, and keeps it if its index is a multiple of the stride.
    pub fn take(&mut self, row: &Row) {
        self.few.take(*row);
        self.last = Some(*row);
    }

    /// Returns the rows kept, and the last row of the run.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = self.few.kept.clone();
        let end = rows.last().map_or(f64::NEG_INFINITY, |row| row.t);
        rows.extend(self.last.filter(|last| last.t > end));
        rows
    }
}
