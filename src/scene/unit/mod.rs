//! Quantities as people type them: a number and a unit, exact factors, checked dimension.

mod symbol;

use std::fmt;

use symbol::Dimension;

/// What a value of a scene file measures; fixes the units it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// m
    Length,
    /// kg
    Mass,
    /// kg m²
    Inertia,
    /// rad
    Angle,
    /// rad/s
    AngularSpeed,
    /// m/s²
    Acceleration,
    /// s
    Time,
    /// N
    Force,
    /// N m
    Torque,
    /// N m s/rad
    RotaryDamping,
    /// N s/m
    LinearDamping,
    /// N/m
    Stiffness,
    /// Pa
    Pressure,
    /// kg/m³
    Density,
    /// m/s
    Velocity,
    /// no dimension
    Number,
}

impl Quantity {
    /// Every quantity, in the order of the enum.
    pub const ALL: [Quantity; 16] = [
        Quantity::Length,
        Quantity::Mass,
        Quantity::Inertia,
        Quantity::Angle,
        Quantity::AngularSpeed,
        Quantity::Acceleration,
        Quantity::Time,
        Quantity::Force,
        Quantity::Torque,
        Quantity::RotaryDamping,
        Quantity::LinearDamping,
        Quantity::Stiffness,
        Quantity::Pressure,
        Quantity::Density,
        Quantity::Velocity,
        Quantity::Number,
    ];

    fn facts(self) -> (&'static str, Dimension, &'static str) {
        match self {
            Self::Length => ("a length", [1, 0, 0, 0], "\"47 mm\", \"0.047 m\", \"2 in\""),
            Self::Mass => ("a mass", [0, 1, 0, 0], "\"0.86 kg\", \"860 g\", \"1.9 lb\""),
            Self::Inertia => (
                "a moment of inertia",
                [2, 1, 0, 0],
                "\"5807.55 kg mm^2\", \"0.0058 kg m^2\"",
            ),
            Self::Angle => (
                "an angle",
                [0, 0, 0, 1],
                "\"40 deg\", \"0.7 rad\", \"2 rev\"",
            ),
            Self::AngularSpeed => (
                "an angular speed",
                [0, 0, -1, 1],
                "\"200 rpm\", \"100 rad/s\", \"30 deg/s\"",
            ),
            Self::Acceleration => ("an acceleration", [1, 0, -2, 0], "\"9.80665 m/s^2\""),
            Self::Time => ("a time", [0, 0, 1, 0], "\"1 s\", \"5 ms\", \"2 min\""),
            Self::Force => ("a force", [1, 1, -2, 0], "\"-200 N\", \"5 kN\", \"10 lbf\""),
            Self::Torque => (
                "a torque",
                [2, 1, -2, 0],
                "\"2 N m\", \"250 N mm\", \"1 lbf ft\"",
            ),
            Self::RotaryDamping => (
                "a torque per angular speed",
                [2, 1, -1, -1],
                "\"0.02 N m s/rad\"",
            ),
            Self::LinearDamping => ("a force per velocity", [0, 1, -1, 0], "\"15 N s/m\""),
            Self::Stiffness => ("a stiffness", [0, 1, -2, 0], "\"2 kN/m\", \"3 N/mm\""),
            Self::Pressure => ("a pressure", [-1, 1, -2, 0], "\"10 bar\", \"101325 Pa\""),
            Self::Density => (
                "a density",
                [-3, 1, 0, 0],
                "\"7800 kg/m^3\", \"7.8 g/cm^3\"",
            ),
            Self::Velocity => ("a velocity", [1, 0, -1, 0], "\"2 m/s\""),
            Self::Number => ("a number", [0; 4], "0.1, 1e-10"),
        }
    }

    /// The quantity in words, with its article.
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// Accepted spellings, for error messages and the schema.
    pub fn examples(self) -> &'static str {
        self.facts().2
    }

    /// Radians are a dimension only where leaving them out could be a mistake:
    /// `N m s` is as good as `N m s/rad`.
    fn accepts(self, found: Dimension) -> bool {
        let want = self.facts().1;
        found == want || (self == Self::RotaryDamping && found[..3] == want[..3] && found[3] == 0)
    }
}

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
/// ```
/// use slider_crank::scene::unit::{parse, Quantity};
/// assert_eq!(parse("155.83 mm", Quantity::Length), Ok(0.15583));
/// assert_eq!(parse("5807.55 kg·mm²", Quantity::Inertia), Ok(5807.55e-6));
/// assert!(parse("47 kg", Quantity::Length).is_err());
/// ```
pub fn parse(text: &str, quantity: Quantity) -> Result<f64, UnitError> {
    let wrong = |what: String| UnitError {
        what,
        help: format!("write {} like {}", quantity.name(), quantity.examples()),
    };
    let (digits, unit) = split(text).map_err(&wrong)?;
    let factor = symbol::unit_factor(unit).map_err(&wrong)?;
    let value = factor
        .apply(&digits)
        .filter(|v| v.is_finite())
        .ok_or_else(|| wrong(format!("`{text}` is not a finite number")))?;
    if unit.trim().is_empty() && value == 0.0 {
        return Ok(value);
    }
    if !quantity.accepts(factor.dimension) {
        return Err(wrong(if unit.trim().is_empty() {
            format!("`{text}` has no unit")
        } else {
            format!("`{}` is not the unit of {}", unit.trim(), quantity.name())
        }));
    }
    Ok(value)
}

/// Factor of a unit that stands alone, as in a column header `pressure [bar]`: SI value of one unit.
pub fn factor(unit: &str, quantity: Quantity) -> Result<f64, UnitError> {
    parse(&format!("1 {unit}"), quantity)
}

/// Splits `"-2.5e3 N m"` into its digits and its unit.
fn split(text: &str) -> Result<(String, &str), String> {
    let trimmed = text.trim();
    let mut end = 0;
    let bytes = trimmed.as_bytes();
    let normal = trimmed.replace('\u{2212}', "-");
    if normal.len() != trimmed.len() {
        // A typographic minus sign is a minus sign.
        let rest = trimmed.trim_start_matches('\u{2212}');
        return split(rest).map(|(digits, unit)| (format!("-{digits}"), unit));
    }
    while end < bytes.len() {
        let sign = matches!(bytes[end], b'+' | b'-')
            && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        let exponent = matches!(bytes[end], b'e' | b'E')
            && bytes
                .get(end + 1)
                .is_some_and(|c| c.is_ascii_digit() || matches!(c, b'+' | b'-'));
        if !(bytes[end].is_ascii_digit() || bytes[end] == b'.' || sign || exponent) {
            break;
        }
        end += 1;
    }
    let digits = &trimmed[..end];
    if trimmed[end..].starts_with(',') {
        return Err(format!(
            "`{text}` has a decimal comma where a point is expected"
        ));
    }
    if digits.parse::<f64>().is_err() {
        return Err(format!("`{text}` does not begin with a number"));
    }
    Ok((digits.to_owned(), &trimmed[end..]))
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
            ("2 N*m", Quantity::Torque, 2.0),
            ("250 N mm", Quantity::Torque, 0.25),
            ("2 Nm", Quantity::Torque, 2.0),
            ("10 bar", Quantity::Pressure, 1e6),
            ("1 lbf ft", Quantity::Torque, 1.3558179483314004),
            ("10 lbf", Quantity::Force, 44.482216152605),
            ("1 lb", Quantity::Mass, 0.45359237),
            ("1 psi", Quantity::Pressure, 6894.757293168361),
            ("0.02 N m s/rad", Quantity::RotaryDamping, 0.02),
            ("0.02 N m s", Quantity::RotaryDamping, 0.02),
            ("7.8 g/cm^3", Quantity::Density, 7800.0),
            ("1 kg/(m s^2)", Quantity::Pressure, 1.0),
            ("−3 N", Quantity::Force, -3.0),
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
            ("", Quantity::Length),
        ] {
            assert!(parse(text, quantity).is_err(), "{text}");
        }
    }
}
