//! Report of inverse dynamics: rows, residuals and mean cycle as CSV and tables, for millions of rows.

use super::{plot, text};
use crate::error::Error;
use crate::inverse::{AsPrinted, CycleMean, DataSummary, Inverse, InverseRow};
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

    /// Returns thinned rows.
    fn table(&self) -> Table {
        let stride = self.result.rows.len().div_ceil(MOST_PLOT_ROWS).max(1);
        rows(self.result, self.printed, stride)
    }

    /// Returns the plot of force and torque; the force has a pole at each dead centre between the rows.
    fn default_view(&self) -> DefaultView<'_> {
        let outward = |row: &InverseRow| self.result.lever_arm(row) > 0.0;
        let mut pairs = self.result.rows.windows(2);
        DefaultView {
            title: &self.result.summary.scene,
            show: "slider_force,spin_only_force,duarte_9_force,crank_torque",
            over: "t",
            band: self.result.summary.band_factor,
            has_poles: pairs.any(|pair| outward(&pair[0]) != outward(&pair[1])),
            scene: Some(self.scene),
            ..DefaultView::default()
        }
    }

    /// Writes all rows.
    fn csv(&self, output: Output) -> Result<(), Error> {
        rows(self.result, self.printed, 1).csv(output)
    }

    /// Returns the chosen columns as SVG; by default data, fit, residuals, force and torque, with the printed forces.
    fn figure(&self, view: &View) -> Result<String, Error> {
        match view.is_default() {
            true => plot::figure(self, view),
            false => view.svg(&self.table(), self.default_view()),
        }
    }
}

/// Returns every `stride`-th row, with measured values and residuals for pictures and pages.
fn rows(result: &Inverse, printed: Option<&AsPrinted>, stride: usize) -> Table {
    let data = &result.summary.data;
    let unit = unit_in_names(data);
    let measured = format!("{}_measured_{unit},residual_{unit}", data.column);
    let mut columns = vec![COLUMNS];
    columns.extend(result.with_reactions().then_some(REACTIONS));
    columns.extend(printed.map(|_| PRINTED));
    columns.push(&measured);
    let rows = result.rows.iter().zip(&result.residuals).step_by(stride);
    let rows = rows.map(|(row, sample)| {
        let mut cells = values(row).to_vec();
        if result.with_reactions() {
            match result.reactions(row) {
                Some(forces) => cells.extend(reactions(&forces)),
                None => cells.extend([f64::NAN; 10]),
            }
        }
        if let Some(printed) = printed {
            cells.extend(printed.forces(row).unwrap_or([f64::NAN; 2]));
        }
        cells.extend([sample.measured, sample.residual]);
        cells
    });
    let mut table = Table::filled(&columns.join(","), rows);
    table.stride = stride as u64;
    table.plot_only_columns = 2;
    table
}
/// Returns all rows as a table.
pub fn inverse_table(result: &Inverse) -> Table {
    rows(result, None, 1).without_plot_columns()
}

const MEANS: &str = "theta_rad,cycles,slider_force_n,slider_force_se_n,slider_force_scatter_n,crank_torque_nm,crank_torque_se_nm,crank_torque_scatter_nm";

/// Returns the mean over the cycles, by crank angle, as a table.
pub fn mean_cycle_table(result: &Inverse) -> Table {
    let cells = |mean: Option<CycleMean>| {
        let cells = |m: CycleMean| [m.value, m.standard_error, m.scatter.unwrap_or(f64::NAN)];
        mean.map_or([f64::NAN; 3], cells)
    };
    let rows = result.mean_cycle().into_iter().map(|row| {
        let cycles = row.crank_torque.map_or(0.0, |mean| mean.cycles as f64);
        let values = [row.theta, cycles].into_iter();
        let values = values.chain(cells(row.slider_force));
        values.chain(cells(row.crank_torque))
    });
    Table::filled(MEANS, rows)
}

/// Returns the unit of the measured values as the names of columns have it.
pub(super) fn unit_in_names(data: &DataSummary) -> String {
    data.unit.replace('/', "_per_")
}

/// Returns measured values, fitted values and residuals as a table.
pub fn residual_table(result: &Inverse) -> Table {
    let data = &result.summary.data;
    let (name, unit) = (data.column, unit_in_names(data));
    let rows = result.residuals.iter().map(|row| {
        let fitted = row.measured - row.residual;
        [row.t, row.measured, fitted, row.residual]
    });
    let header = format!("t_s,{name}_{unit},fitted_{name}_{unit},residual_{unit}");
    Table::filled(&header, rows)
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
