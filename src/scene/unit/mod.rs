//! Quantities as people type them: a number and a unit, exact factors, checked dimension.

mod quantity;
mod symbol;

use std::fmt;

#[cfg(feature = "cli")]
use super::Every;
use super::number;
pub use quantity::Quantity;
use symbol::Factor;

/// Why a text is not the quantity that was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub help: String,
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.what, self.help)
    }
}

/// Reads `text` as `quantity` and returns it in SI units and radians.
///
/// Powers of ten are applied to the decimal digits before they are rounded, so `"155.83 mm"` is the
/// double nearest to 0.15583.
///
/// # Errors
/// What is wrong with number or unit, and examples of what would be right.
///
/// ```
/// use slider_crank::scene::unit::{parse, Quantity};
/// assert_eq!(parse("155.83 mm", Quantity::Length), Ok(0.15583));
/// assert_eq!(parse("5807.55 kg·mm²", Quantity::Inertia), Ok(5807.55e-6));
/// assert!(parse("47 kg", Quantity::Length).is_err());
/// ```
pub fn parse(text: &str, quantity: Quantity) -> Result<f64, UnitError> {
    let measured = measure(text).map_err(|what| match split(text) {
        Ok((_, unit)) if !unit.is_empty() => wrong_unit(what, quantity),
        _ => wrong(what, quantity),
    })?;
    if measured.is(quantity) {
        return Ok(measured.value);
    }
    let unit = measured.unit;
    let what = if unit.is_empty() {
        format!("`{text}` has no unit")
    } else if let Some(force) = of_pounds_force(unit, quantity) {
        format!("in `{unit}` the pound is a mass: write `{force}` for the force")
    } else {
        format!("`{unit}` is not the unit of {}", quantity.name())
    };
    Err(wrong_unit(what, quantity))
}

/// The unit with the pound as a force, if that makes it one of the quantity.
fn of_pounds_force(unit: &str, quantity: Quantity) -> Option<String> {
    let force = unit.replace("lbs", "lb").replace("lb", "lbf");
    let factor = symbol::unit_factor(&force).ok()?;
    quantity.accepts(factor.dimension).then_some(force)
}

/// Reads `text` as a time (s) or an angle (rad); a bare 0 is a time.
#[cfg(feature = "cli")]
pub(super) fn time_or_angle(text: &str) -> Result<Every, UnitError> {
    let wrong = |what: String| UnitError {
        what,
        help: "write for example \"1 ms\" or \"1 deg\"".to_owned(),
    };
    let measured = measure(text).map_err(&wrong)?;
    if measured.is(Quantity::Time) {
        Ok(Every::Time(measured.value))
    } else if measured.is(Quantity::Angle) {
        Ok(Every::Angle(measured.value))
    } else if measured.unit.is_empty() {
        Err(wrong(format!("`{text}` has no unit")))
    } else {
        Err(wrong(format!("`{text}` is neither a time nor an angle")))
    }
}

fn wrong(what: String, quantity: Quantity) -> UnitError {
    UnitError {
        what,
        help: format!("write {} like {}", quantity.name(), quantity.examples()),
    }
}

/// With the units there are, where one symbol is enough.
fn wrong_unit(what: String, quantity: Quantity) -> UnitError {
    let mut error = wrong(what, quantity);
    let symbols = quantity.symbols();
    if !symbols.is_empty() {
        error.help += &format!("; units: {}", symbols.join(", "));
    }
    error
}

/// A number with a unit, SI.
struct Measured<'a> {
    value: f64,
    factor: Factor,
    unit: &'a str,
}

impl Measured<'_> {
    /// Zero is the same in every unit.
    fn is(&self, quantity: Quantity) -> bool {
        self.unit.is_empty() && self.value == 0.0 || quantity.accepts(self.factor.dimension)
    }
}

fn measure(text: &str) -> Result<Measured<'_>, String> {
    let (digits, unit) = split(text)?;
    let factor = symbol::unit_factor(unit)?;
    let value = factor
        .apply(&digits)
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("`{text}` is not a finite number"))?;
    Ok(Measured {
        value,
        factor,
        unit,
    })
}

/// Factor of a unit that stands alone, as in a column header `pressure [bar]`: SI value of one unit.
///
/// # Errors
/// As [`parse`].
pub fn factor(unit: &str, quantity: Quantity) -> Result<f64, UnitError> {
    parse(&format!("1 {unit}"), quantity)
}

/// Whether a text is a unit of any quantity.
pub(super) fn is_unit(text: &str) -> bool {
    !text.trim().is_empty() && symbol::unit_factor(text.trim()).is_ok()
}

/// Splits `"-2.5e3 N m"` into its digits and its unit.
fn split(text: &str) -> Result<(String, &str), String> {
    let trimmed = text.trim();
    let (sign, unsigned) = match trimmed.strip_prefix(['-', number::MINUS]) {
        Some(rest) => ("-", rest),
        None => ("", trimmed.strip_prefix('+').unwrap_or(trimmed)),
    };
    let (digits, unit) = unsigned.split_at(number::length(unsigned));
    if unit.starts_with(',') {
        return Err(format!(
            "`{text}` has a decimal comma where a point is expected"
        ));
    }
    let digits = format!("{sign}{}", number::plain(digits));
    if digits.parse::<f64>().is_err() {
        return Err(format!("`{text}` does not begin with a number"));
    }
    Ok((digits, unit.trim()))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn units_as_people_type_them() {
        for (text, quantity, expected) in [
            ("47 mm", Quantity::Length, 0.047),
            ("40mm", Quantity::Length, 0.040),
            ("27698.81 kg mm^2", Quantity::Inertia, 0.02769881),
            ("5807.55 kg·mm²", Quantity::Inertia, 0.00580755),
            ("0.2 kg m2", Quantity::Inertia, 0.2),
            ("200 rpm", Quantity::AngularSpeed, 200.0 * PI / 30.0),
            ("90 deg", Quantity::Angle, PI / 2.0),
            ("30°", Quantity::Angle, PI / 6.0),
            ("30 degrees", Quantity::Angle, PI / 6.0),
            ("2 turns", Quantity::Angle, 4.0 * PI),
            ("50 gon", Quantity::Angle, PI / 4.0),
            ("100 mgon", Quantity::Angle, PI / 2000.0),
            ("30 arcmin", Quantity::Angle, PI / 360.0),
            ("1800 arcsec", Quantity::Angle, PI / 360.0),
            ("3 radians/sec", Quantity::AngularSpeed, 3.0),
            ("5 msec", Quantity::Time, 0.005),
            ("2 N*m", Quantity::Torque, 2.0),
            ("250 N mm", Quantity::Torque, 0.25),
            ("2 Nm", Quantity::Torque, 2.0),
            ("10 bar", Quantity::Pressure, 1e6),
            ("1 lbf ft", Quantity::Torque, 1.3558179483314004),
            ("2 N-m", Quantity::Torque, 2.0),
            ("2 N.m", Quantity::Torque, 2.0),
            ("1 lbf-ft", Quantity::Torque, 1.3558179483314004),
            ("0.2 kg-m^2", Quantity::Inertia, 0.2),
            ("0.2 kg-m2", Quantity::Inertia, 0.2),
            ("0.2 kg.m²", Quantity::Inertia, 0.2),
            ("0.2 kg*m**2", Quantity::Inertia, 0.2),
            ("9.81 m-s-2", Quantity::Acceleration, 9.81),
            ("60 rev/min", Quantity::AngularSpeed, 2.0 * PI),
            ("60 r/min", Quantity::AngularSpeed, 2.0 * PI),
            ("60 RPM", Quantity::AngularSpeed, 2.0 * PI),
            ("2 inches", Quantity::Length, 0.0508),
            ("2 lbs", Quantity::Mass, 0.90718474),
            ("10 lbf", Quantity::Force, 44.482216152605),
            ("1 lb", Quantity::Mass, 0.45359237),
            ("1 psi", Quantity::Pressure, 6894.757293168361),
            ("0.02 N m s/rad", Quantity::RotaryDamping, 0.02),
            ("0.02 N m s", Quantity::RotaryDamping, 0.02),
            ("7.8 g/cm^3", Quantity::Density, 7800.0),
            ("1 kg/(m s^2)", Quantity::Pressure, 1.0),
            ("−3 N", Quantity::Force, -3.0),
            ("3e−2 N", Quantity::Force, 0.03),
            ("9.81 m s^−2", Quantity::Acceleration, 9.81),
            ("9.80665 m s⁻²", Quantity::Acceleration, 9.80665),
            ("0", Quantity::Length, 0.0),
            ("0.1", Quantity::Number, 0.1),
        ] {
            let value = parse(text, quantity).unwrap_or_else(|e| panic!("{text}: {e}"));
            let error = (value - expected).abs();
            assert!(
                error <= 2e-16 * expected.abs(),
                "{text}: {value} for {expected}"
            );
        }
    }

    #[test]
    fn what_is_not_a_quantity_is_refused() {
        for (text, quantity) in [
            ("47", Quantity::Length),
            ("47 kg", Quantity::Length),
            ("1,5 mm", Quantity::Length),
            ("mm", Quantity::Length),
            ("1e999 m", Quantity::Length),
            ("1 furlong", Quantity::Length),
            ("1 m^", Quantity::Length),
            ("1 m^99", Quantity::Length),
            ("3 1/s", Quantity::AngularSpeed),
            ("1 N m", Quantity::Force),
            ("1 kg/m s", Quantity::Pressure),
            ("nan m", Quantity::Length),
            ("1 (m", Quantity::Length),
            ("−−3 N", Quantity::Force),
            ("−-3 N", Quantity::Force),
            ("+-3 N", Quantity::Force),
            ("3− N", Quantity::Force),
            ("3 N−m", Quantity::Force),
            ("3 N-", Quantity::Force),
            ("3 m--1", Quantity::Length),
            ("3 m-", Quantity::Length),
            ("", Quantity::Length),
        ] {
            assert!(parse(text, quantity).is_err(), "{text}");
        }
    }

    #[test]
    fn what_was_meant_is_said() {
        for (text, quantity, what) in [
            ("2 lb ft", Quantity::Torque, "`lbf ft`"),
            ("2 in-lb", Quantity::Torque, "`in-lbf`"),
            ("30 Deg", Quantity::Angle, "`deg` is"),
            ("2 KG", Quantity::Mass, "`kg` is"),
            ("3 1/min", Quantity::AngularSpeed, "200 rpm"),
            (
                "3 grads",
                Quantity::Angle,
                "deg, °, rev, turn, gon, arcmin, arcsec",
            ),
            ("3 s", Quantity::Angle, "units: rad, deg"),
        ] {
            let error = parse(text, quantity).unwrap_err().to_string();
            assert!(error.contains(what), "{text}: {error}");
        }
    }
}
