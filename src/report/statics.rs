//! Static equilibrium as CSV and text.

use std::fmt::Write;

use super::csv::{self, write_all};
use super::key_values::{Facts, fact, given};
use super::page::{Origin, Page, Table};
use super::text::{NAMES, extreme, place};
use super::{Axis, Figure, Output, panels};
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
    let mut table = Table::new(&header(result, true));
    for row in result.rows(every) {
        table.push(cells(&row, true));
    }
    Page::new(origin, &facts(result))
        .table(&table)
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

/// What is sought over the crank angle, with its friction band, and the side thrust.
pub fn statics_figure(result: &StaticAnalysis) -> Result<String, Error> {
    let rows: Vec<StaticsRow> = result.rows(1f64.to_radians()).collect();
    let of = |value: &dyn Fn(&StaticsRow) -> Option<f64>| -> Vec<(f64, f64)> {
        let point = |row: &StaticsRow| (row.theta.to_degrees(), value(row).unwrap_or(f64::NAN));
        rows.iter().map(point).collect()
    };
    let value = of(&|row| row.balance.band.map(|band| band.value));
    // Towards a dead centre the force grows without bound; what is worth seeing is around its median.
    let mut sizes: Vec<f64> = value
        .iter()
        .map(|(_, y)| y.abs())
        .filter(|y| y.is_finite())
        .collect();
    sizes.sort_by(f64::total_cmp);
    let most = 5.0
        * sizes
            .get(sizes.len() / 2)
            .copied()
            .unwrap_or(1.0)
            .max(f64::MIN_POSITIVE);
    let band = rows.iter().map(|row| {
        let edge = |edge: Option<f64>| edge.unwrap_or(f64::NAN).clamp(-most, most);
        let band = row.balance.band;
        (
            row.theta.to_degrees(),
            edge(band.and_then(|band| band.min)),
            edge(band.and_then(|band| band.max)),
        )
    });
    let angle = || Axis::degrees("crank angle θ [°]").range(0.0, 360.0);
    let inside = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        points
            .into_iter()
            .map(|(x, y)| (x, if y.abs() <= most { y } else { f64::NAN }))
            .collect()
    };
    let name = match result.sought {
        "crank-torque" => "crank torque [N m]",
        _ => "slider force [N]",
    };
    let mut sought = Figure::new("", angle(), Axis::linear(name));
    if result.friction > 0.0 {
        sought = sought.band("held by friction", band.collect());
    }
    let thrust = of(&|row| row.balance.side_thrust);
    let figures = [
        sought.line("without friction", inside(value)),
        Figure::new("", angle(), Axis::linear("side thrust [N]")).line("", thrust),
    ];
    panels(&result.scene, &figures, 1)
}
