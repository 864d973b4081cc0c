//! Rows of `inverse` as CSV, made for millions of them.

use super::plot;
use super::text::facts;
use crate::error::Error;
use crate::inverse::{AsPrinted, CycleMean, Inverse, InverseRow, Residual};
use crate::report::csv::{line, write_all};
use crate::report::curves::View;
use crate::report::page::{self, Origin};
use crate::report::rows::{REACTIONS, reactions};
use crate::report::table::Table;
use crate::report::{Look, Output};
use crate::scene::Scene;

const COLUMNS: &str = "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,slider_force_n,slider_force_se_n,crank_torque_nm,near_dead_centre,crank_torque_se_nm";

const PRINTED: &str = "spin_only_force_n,duarte_9_force_n";

/// Writes the rows, with joint forces if they were asked for, and with the forces as Duarte et al. print them.
pub fn inverse_rows(
    result: &Inverse,
    printed: Option<&AsPrinted>,
    output: Output,
) -> Result<(), Error> {
    let header = header(result, printed);
    write_all(output, &header, &result.rows, |row, text| {
        line(cells(result, printed, row), text);
    })
}

/// The rows by columns.
pub fn inverse_table(result: &Inverse, printed: Option<&AsPrinted>) -> Table {
    let mut table = Table::new(&header(result, printed));
    for row in &result.rows {
        table.push(cells(result, printed, row));
    }
    table
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

/// Most rows on a page.
const MOST: usize = 100_000;

/// The inverse as one page: rows with what was measured.
///
/// # Errors
/// [`Error::Write`].
pub fn inverse_page(result: &Inverse, scene: &Scene, origin: &Origin) -> Result<String, Error> {
    let look = Look {
        scene: Some(scene),
        ..look(result)
    };
    page::html(origin, &facts(result), &table(result), &look)
}

/// What is to be seen as SVG; by itself data and fit, residuals, force and torque, with the forces as Duarte et al. print
/// them if given.
///
/// # Errors
/// [`Error::Refused`] if a column is not there, or no room.
pub fn inverse_figure(
    result: &Inverse,
    printed: Option<&AsPrinted>,
    view: &View,
) -> Result<String, Error> {
    if view.is_default() {
        return plot::figure(result, printed, view.size);
    }
    view.svg(&table(result), look(result))
}

fn look(result: &Inverse) -> Look<'_> {
    Look {
        title: &result.summary.scene,
        show: &["slider_force", "crank_torque"],
        over: "t",
        band: result.summary.band_factor,
        has_poles: true,
        ..Look::default()
    }
}

/// Rows of a page by columns, with what was measured.
fn table(result: &Inverse) -> Table {
    let data = &result.summary.data;
    let (name, unit) = (data.column, data.unit);
    let mut table = Table::new(&format!("{COLUMNS},{name}_measured_{unit},residual_{unit}"));
    table.stride = result.rows.len().div_ceil(MOST).max(1) as u64;
    for (row, sample) in result
        .rows
        .iter()
        .zip(&result.residuals)
        .step_by(table.stride as usize)
    {
        table.push(
            values(row)
                .into_iter()
                .chain([sample.measured, sample.residual]),
        );
    }
    table
}

/// Writes what was measured, what the fit gives, and the difference.
pub fn residuals(result: &Inverse, output: Output) -> Result<(), Error> {
    let header = residual_header(result);
    write_all(output, &header, &result.residuals, |row, text| {
        line(residual_cells(row), text);
    })
}

const MEANS: &str = "theta_rad,cycles,slider_force_n,slider_force_se_n,slider_force_scatter_n,crank_torque_nm,crank_torque_se_nm,crank_torque_scatter_nm";

/// Writes the mean of the cycles.
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

/// What was measured, what the fit gives, and the difference, by columns.
pub fn residual_table(result: &Inverse) -> Table {
    let mut table = Table::new(&residual_header(result));
    let rows = result.residuals.iter().map(residual_cells);
    rows.for_each(|row| table.push(row));
    table
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
