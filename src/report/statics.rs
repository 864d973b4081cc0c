//! Static equilibrium as CSV and text.

use std::fmt::Write;

use super::Output;
use super::rows::write;
use super::text::place;
use crate::error::Error;
use crate::study::{Located, StaticAnalysis, StaticsRow};

const FORCE: &str = "slider_force_n,slider_force_min_n,slider_force_max_n";
const TORQUE: &str = "crank_torque_nm,crank_torque_min_nm,crank_torque_max_nm";
const REST: &str = "side_thrust_n,transmission_rad,self_locking";
const DETAILS: &str = "velocity_ratio,crank_pin_angle_rad";

/// Rows of `statics`.
#[derive(Debug)]
pub struct StaticsWriter {
    output: Output,
    details: bool,
}

impl StaticsWriter {
    /// Writes the header to an output; with `details` also velocity ratio and angle at the crank pin.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn new(
        mut output: Output,
        result: &StaticAnalysis,
        details: bool,
    ) -> Result<StaticsWriter, Error> {
        let sought = match result.sought {
            "crank-torque" => TORQUE,
            _ => FORCE,
        };
        let more = if details { "," } else { "" };
        let details_header = if details { DETAILS } else { "" };
        let header = format!("theta_rad,{sought},{REST}{more}{details_header}\n");
        output.write(header.as_bytes())?;
        Ok(StaticsWriter { output, details })
    }

    /// Writes a row.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn row(&mut self, row: &StaticsRow) -> Result<(), Error> {
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
        if self.details {
            values.extend([row.velocity_ratio, row.crank_pin_angle]);
        }
        write(&mut self.output, &values)
    }

    /// Completes the output.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(self) -> Result<(), Error> {
        self.output.finish()
    }
}

/// What holds the equilibrium, in words and in a table of a few angles.
pub fn statics(result: &StaticAnalysis) -> String {
    let mut text = String::new();
    let mut put = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<24} {value}");
    };
    if !result.scene.is_empty() {
        put("scene", result.scene.clone());
    }
    let (what, unit) = match result.sought {
        "crank-torque" => ("crank torque", "N m"),
        _ => ("slider force", "N"),
    };
    put("class", result.class.to_owned());
    put("sought", format!("{what} beside the other loads"));
    put("friction coefficient", format!("{}", result.friction));
    let least = |found: &Located| {
        let angle = found.theta_rad.to_degrees();
        format!("{} {unit} at {angle} deg", found.value)
    };
    for found in &result.least {
        put("least", least(found));
    }
    for found in &result.least_with_friction {
        put("least with friction", least(found));
    }
    for position in &result.positions {
        put(position.kind, place(position));
    }
    for warning in &result.warnings {
        put("warning", warning.clone());
    }
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

fn line(text: &mut String, cells: &[String; 6]) {
    let [theta, value, from, to, thrust, transmission] = cells;
    let _ = writeln!(
        text,
        "{theta:>11} {value:>18} {from:>14} {to:>14} {thrust:>16} {transmission:>19}"
    );
}
