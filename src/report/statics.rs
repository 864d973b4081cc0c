//! Static equilibrium as CSV and text.

use std::f64::consts::PI;
use std::fmt::Write;

use super::Output;
use super::csv::{self, write_all};
use super::curves::{Shown, View};
use super::key_values::{Facts, fact, given};
use super::page::{Origin, Page};
use super::table::Table;
use super::text::{NAMES, extreme, place};
use crate::error::Error;
use crate::scene::Scene;
use crate::statics::{StaticAnalysis, StaticsRow};

const FORCE: &str = "slider_force_n,slider_force_min_n,slider_force_max_n";
const TORQUE: &str = "crank_torque_nm,crank_torque_min_nm,crank_torque_max_nm";
const REST: &str = "side_thrust_n,transmission_rad,self_locking";
const DETAILS: &str = "velocity_ratio,crank_pin_angle_rad";

/// Writes the rows of `statics`, so many radians apart; with `details` also velocity ratio and angle at the crank pin.
pub fn statics_rows(
    result: &StaticAnalysis,
    every: f64,
    details: bool,
    output: Output,
) -> Result<(), Error> {
    let rows: Vec<StaticsRow> = result.rows(every).collect();
    write_all(output, &header(result, details), &rows, |row, text| {
        csv::line(cells(row, details), text);
    })
}

fn header(result: &StaticAnalysis, details: bool) -> String {
    let sought = match result.sought {
        "crank-torque" => TORQUE,
        _ => FORCE,
    };
    let mut columns = vec!["theta_rad", sought, REST];
    columns.extend(details.then_some(DETAILS));
    columns.join(",")
}

fn cells(row: &StaticsRow, details: bool) -> Vec<f64> {
    let cell = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let band = row.balance.band;
    let mut values = vec![
        row.theta,
        cell(band.map(|band| band.value)),
        cell(band.and_then(|band| band.min)),
        cell(band.and_then(|band| band.max)),
        cell(row.balance.side_thrust),
        row.transmission,
        f64::from(u8::from(row.balance.self_locking)),
    ];
    if details {
        values.extend([row.velocity_ratio, row.crank_pin_angle]);
    }
    values
}

/// The equilibrium as one page.
///
/// # Errors
/// [`Error::Write`].
pub fn statics_page(
    result: &StaticAnalysis,
    every: f64,
    scene: &Scene,
    origin: &Origin,
) -> Result<String, Error> {
    Page::new(origin, &facts(result))
        .table(&statics_table(result, every))
        .mechanism(scene)
        .with_poles()
        .html()
}

/// What holds the equilibrium, in words and in a table of a few angles.
pub fn statics(result: &StaticAnalysis) -> String {
    let mut text = facts(result).lines(NAMES);
    let (what, unit) = sought(result);
    let header = [
        "theta [deg]".to_owned(),
        format!("{what} [{unit}]"),
        "from".to_owned(),
        "to".to_owned(),
        "side thrust [N]".to_owned(),
        "transmission [deg]".to_owned(),
    ];
    let _ = writeln!(text);
    line(&mut text, &header);
    for row in result.rows(15f64.to_radians()) {
        let cell = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.5}"));
        let band = row.balance.band;
        let finite = |value: f64| value.is_finite().then_some(value);
        let cells = [
            format!("{:.0}", row.theta.to_degrees()),
            cell(band.map(|band| band.value)),
            cell(band.and_then(|band| band.min)),
            cell(band.and_then(|band| band.max)),
            cell(row.balance.side_thrust),
            cell(finite(row.transmission.to_degrees())),
        ];
        line(&mut text, &cells);
    }
    text
}

/// What is sought, and its unit.
fn sought(result: &StaticAnalysis) -> (&'static str, &'static str) {
    match result.sought {
        "crank-torque" => ("crank torque", "N m"),
        _ => ("slider force", "N"),
    }
}

fn facts(result: &StaticAnalysis) -> Facts {
    let (what, unit) = sought(result);
    let mut facts = Facts::of(&result.scene);
    facts.add("class", result.class);
    fact!(facts, "sought", "{what} beside the other loads");
    facts.add("friction coefficient", given(result.friction));
    for found in &result.least {
        facts.add("least", extreme(found, unit));
    }
    for found in &result.least_with_friction {
        facts.add("least with friction", extreme(found, unit));
    }
    for position in &result.positions {
        facts.add(position.kind, place(position));
    }
    facts.warnings(&result.warnings);
    facts
}

fn line(text: &mut String, cells: &[String; 6]) {
    let [theta, value, from, to, thrust, transmission] = cells;
    let _ = writeln!(
        text,
        "{theta:>11} {value:>18} {from:>14} {to:>14} {thrust:>16} {transmission:>19}"
    );
}

/// Crank angle between the points of a figure, rad.
const SPACING: f64 = PI / 360.0;

/// What is to be seen over the crank angle, as SVG: by itself what is sought, with its friction band, and the side thrust.
///
/// # Errors
/// [`Error::Refused`] if a column is not there.
pub fn statics_figure(result: &StaticAnalysis, view: &View) -> Result<String, Error> {
    let shown = Shown {
        title: &result.scene,
        show: &["slider_force", "crank_torque", "side_thrust"],
        has_poles: true,
        ..Shown::default()
    };
    view.svg(&statics_table(result, SPACING), shown)
}

/// The rows with their details by columns, so many radians apart.
pub fn statics_table(result: &StaticAnalysis, every: f64) -> Table {
    let mut table = Table::new(&header(result, true));
    for row in result.rows(every) {
        table.push(cells(&row, true));
    }
    table
}
