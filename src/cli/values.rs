//! Parsers of option values with units, to SI units and radians.

use crate::error::Error;
use crate::kinematics::MOST_ROWS_OF_TURN;
use crate::scene::unit::{self, Quantity};

pub(super) fn quantity(text: &str, quantity: Quantity) -> Result<f64, String> {
    unit::parse(text, quantity).map_err(|error| error.to_string())
}

pub(super) fn angle(text: &str) -> Result<f64, String> {
    quantity(text, Quantity::Angle)
}

/// Parses a length of either sign, m.
pub(super) fn any_length(text: &str) -> Result<f64, String> {
    quantity(text, Quantity::Length)
}

pub(super) fn length(text: &str) -> Result<f64, String> {
    match any_length(text)? {
        length if length > 0.0 => Ok(length),
        _ => Err("the length must be positive, like \"27 mm\"".to_owned()),
    }
}

pub(super) fn positive_angle(text: &str) -> Result<f64, String> {
    match angle(text)? {
        step if step > 0.0 => Ok(step),
        _ => Err("the angle must be positive, like \"1 deg\"".to_owned()),
    }
}

/// Refuses a crank angle between rows (rad) that gives too many rows per turn.
pub(super) fn check_rows_of_turn(every: f64) -> Result<(), Error> {
    if std::f64::consts::TAU / every > MOST_ROWS_OF_TURN {
        return Err(Error::refused(
            format!("--every {every} rad gives more than {MOST_ROWS_OF_TURN} rows"),
            "give an angle like \"1 deg\"",
        ));
    }
    Ok(())
}
