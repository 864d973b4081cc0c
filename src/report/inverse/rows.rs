//! Report of inverse dynamics: rows, residuals and mean cycle as CSV and tables, for millions of rows.

use super::{plot, text};
use crate::error::Error;
use crate::inverse::{AsPrinted, CycleMean, Inverse, InverseRow, Residual};
use crate::report::csv::{line, write_all};
use crate::report::curves::View;
use crate::report::rows::{MOST_PLOT_ROWS, REACTIONS, reactions};
use crate::report::{DefaultView, Facts, Output, Report, Table};
use crate::scene::Scene;

const COLUMNS: &str = "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,slider_force_n,slider_force_se_n,crank_torque_nm,near_dead_centre,crank_torque_se_nm";

const PRINTED: &str = "spin_only_force_n,duarte_9_force_n";

/// Report of slider force and crank torque of a measured motion.
#[derive(Clone, Copy)]
pub struct InverseReport<'a> {
    /// Result of the inverse.
    pub result: &'a Inverse,
    /// Scene of the inverse.
    pub scene: &'a Scene,
    /// Forces by the printed equations of Duarte et al., for rows, text and figure.
    pub printed: Option<&'a AsPrinted>,
}

impl Report for InverseReport<'_> {
    fn facts(&self) -> Facts {
        text::facts(self.result)
    }

    /// Returns the facts and some rows.
    fn text(&self) -> String {
        text::text(self.result, self.printed)
    }

    /// Returns thinned rows, with measured values and residuals.
    fn table(&self) -> Table {
        let result = self.result;
        let data = &result.summary.data;
        let (name, unit) = (data.column, data.unit);
        let stride = result.rows.len().div_ceil(MOST_PLOT_ROWS).max(1);
        let rows = result.rows.iter().zip(&result.residuals).step_by(stride);
        let rows = rows.map(|(row, sample)| {
            let measured = [sample.measured, sample.residual];
            values(row).into_iter().chain(measured)
        });
        let header = format!("{COLUMNS},{name}_measured_{unit},residual_{unit}");
        let mut table = Table::filled(&header, rows);
        table.stride = stride as u64;
        table
    }

    fn default_view(&self) -> DefaultView<'_> {
        DefaultView {
            title: &self.result.summary.scene,
            show: &["slider_force", "crank_torque"],
            over: "t",
            band: self.result.summary.band_factor,
            has_poles: true,
            scene: Some(self.scene),
            ..DefaultView::default()
        }
    }

    /// Writes all rows, with joint forces if asked for, and with the printed forces if given.
    fn csv(&self, output: Output) -> Result<(), Error> {
        let (result, printed) = (self.result, self.printed);
        let header = header(result, printed);
        write_all(output, &header, &result.rows, |row, text| {
            line(cells(result, printed, row), text);
        })
    }

    /// Returns the chosen columns as SVG; by default data, fit, residuals, force and torque, with the printed forces.
    fn figure(&self, view: &View) -> Result<String, Error> {
        if view.is_default() {
            return plot::figure(self.result, self.printed, view.size);
        }
        view.svg(&self.table(), self.default_view())
    }
}

/// Returns all rows as a table.
pub fn inverse_table(result: &Inverse, printed: Option<&AsPrinted>) -> Table {
    let rows = result.rows.iter().map(|row| cells(result, printed, row));
    Table::filled(&header(result, printed), rows)
}

fn header(result: &Inverse, printed: Option<&AsPrinted>) -> String {
    let mut columns = vec![COLUMNS];
    columns.extend(result.with_reactions().then_some(REACTIONS));
    columns.extend(printed.map(|_| PRINTED));
    columns.join(",")
}

fn cells(result: &Inverse, printed: Option<&AsPrinted>, row: &InverseRow) -> Vec<f64> {
    let mut values = values(row).to_vec();
    if result.with_reactions() {
        match result.reactions(row) {
            Some(forces) => values.extend(reactions(&forces)),
            None => values.extend([f64::NAN; 10]),
        }
    }
    if let Some(printed) = printed {
        values.extend(printed.forces(row).unwrap_or([f64::NAN; 2]));
    }
    values
}

/// Writes measured values, fitted values and residuals as CSV.
pub fn residuals(result: &Inverse, output: Output) -> Result<(), Error> {
    let header = residual_header(result);
    write_all(output, &header, &result.residuals, |row, text| {
        line(residual_cells(row), text);
    })
}

const MEANS: &str = "theta_rad,cycles,slider_force_n,slider_force_se_n,slider_force_scatter_n,crank_torque_nm,crank_torque_se_nm,crank_torque_scatter_nm";

/// Writes the mean over the cycles, by crank angle, as CSV.
///
/// # Errors
/// [`Error::Write`].
pub fn mean_cycle(result: &Inverse, output: Output) -> Result<(), Error> {
    write_all(output, MEANS, &result.mean_cycle(), |row, text| {
        let cells = |mean: Option<CycleMean>| {
            let cells = |m: CycleMean| [m.value, m.standard_error, m.scatter.unwrap_or(f64::NAN)];
            mean.map_or([f64::NAN; 3], cells)
        };
        let cycles = row.crank_torque.map_or(0.0, |mean| mean.cycles as f64);
        let values = [row.theta, cycles].into_iter();
        let values = values.chain(cells(row.slider_force));
        line(values.chain(cells(row.crank_torque)), text);
    })
}

/// Returns measured values, fitted values and residuals as a table.
pub fn residual_table(result: &Inverse) -> Table {
    let rows = result.residuals.iter().map(residual_cells);
    Table::filled(&residual_header(result), rows)
}

fn residual_header(result: &Inverse) -> String {
    let data = &result.summary.data;
    let (name, unit) = (data.column, data.unit);
    format!("t_s,{name}_{unit},fitted_{name}_{unit},residual_{unit}")
}

fn residual_cells(row: &Residual) -> [f64; 4] {
    [
        row.t,
        row.measured,
        row.measured - row.residual,
        row.residual,
    ]
}

fn values(row: &InverseRow) -> [f64; 9] {
    let cell = |value: Option<f64>| value.unwrap_or(f64::NAN);
    [
        row.t,
        row.theta,
        row.omega,
        row.alpha,
        cell(row.slider_force),
        cell(row.slider_force_se),
        cell(row.crank_torque),
        f64::from(u8::from(row.near_dead_centre)),
        cell(row.crank_torque_se),
    ]
}
