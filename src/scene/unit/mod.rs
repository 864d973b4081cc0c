//! Quantities as people type them: a number and a unit, exact factors, checked dimension.

mod grammar;
#[cfg(feature = "cli")]
mod pattern;
mod quantity;
mod symbol;

use std::fmt;

#[cfg(feature = "cli")]
use super::Every;
use super::number;
#[cfg(feature = "cli")]
pub(super) use pattern::pattern;
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
    let measured = measure(text).map_err(|what| {
        let has_unit = split(text).is_ok_and(|(_, unit)| !unit.is_empty());
        wrong(what, quantity, has_unit)
    })?;
    if let Some(value) = measured.of(quantity) {
        return Ok(value);
    }
    let unit = measured.unit;
    // The unit with the pound as a force.
    let force = unit.replace("lbs", "lb").replace("lb", "lbf");
    let is_force = |factor: Factor| quantity.accepts(factor.dimension);
    let what = if unit.is_empty() {
        format!("`{text}` has no unit")
    } else if grammar::unit_factor(&force).is_ok_and(is_force) {
        format!("in `{unit}` the pound is a mass: write `{force}` for the force")
    } else {
        format!("`{unit}` is not the unit of {}", quantity.name())
    };
    Err(wrong(what, quantity, true))
}

/// A value with its standard error, SI and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertain {
    /// The middle.
    pub value: f64,
    /// Standard error, 0 if none is written.
    pub error: f64,
}

/// Signs between a value and its standard error.
pub(super) const PLUS_MINUS: [&str; 3] = ["+-", "+/-", "±"];

/// Reads `text` as `quantity` that may have a standard error; a unit that stands once holds for both.
///
/// # Errors
/// As [`parse`].
///
/// ```
/// use slider_crank::scene::unit::{Quantity, Uncertain, uncertain};
/// let rod = uncertain("155.8 +- 0.1 mm", Quantity::Length);
/// assert_eq!(rod, Ok(Uncertain { value: 0.1558, error: 1e-4 }));
/// ```
pub fn uncertain(text: &str, quantity: Quantity) -> Result<Uncertain, UnitError> {
    let parts = PLUS_MINUS.iter().find_map(|sign| text.split_once(sign));
    let Some((value, error)) = parts else {
        let value = parse(text, quantity)?;
        return Ok(Uncertain { value, error: 0.0 });
    };
    let with_unit = |text: &str, other: &str| match [text, other].map(split) {
        [Ok((_, "")), Ok((_, unit))] => parse(&format!("{text} {unit}"), quantity),
        _ => parse(text, quantity),
    };
    let (value, error) = (value.trim(), error.trim());
    let found = Uncertain {
        error: with_unit(error, value)?,
        value: with_unit(value, error)?,
    };
    if found.error < 0.0 {
        let what = format!("the error `{error}` is negative");
        return Err(wrong(what, quantity, false));
    }
    Ok(found)
}

/// A unit of a quantity, for many numbers.
#[cfg(feature = "cli")]
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale(Factor);

#[cfg(feature = "cli")]
impl Scale {
    /// None if the unit is not one of this quantity.
    pub fn new(unit: &str, quantity: Quantity) -> Option<Scale> {
        let factor = grammar::unit_factor(unit).ok()?;
        factor.of(quantity).map(Scale)
    }

    /// The value of these digits in SI units and radians.
    pub fn value(self, digits: &str) -> Option<f64> {
        self.0.apply(digits)
    }
}

/// Reads `text` as a time (s) or an angle (rad); a bare 0 is a time.
#[cfg(feature = "cli")]
pub(super) fn time_or_angle(text: &str) -> Result<Every, UnitError> {
    let measured = measure(text).and_then(|measured| {
        let time = measured.of(Quantity::Time).map(Every::Time);
        let angle = || measured.of(Quantity::Angle).map(Every::Angle);
        time.or_else(angle).ok_or_else(|| match measured.unit {
            "" => format!("`{text}` has no unit"),
            _ => format!("`{text}` is neither a time nor an angle"),
        })
    });
    measured.map_err(|what| UnitError {
        what,
        help: "write for example \"1 ms\" or \"1 deg\"".to_owned(),
    })
}

/// With the units there are, where one symbol is enough.
fn wrong(what: String, quantity: Quantity, with_units: bool) -> UnitError {
    let mut help = format!("write {} like {}", quantity.name(), quantity.examples());
    let symbols: Vec<_> = symbol::symbols(quantity.dimension()).collect();
    if with_units && !symbols.is_empty() {
        help += &format!("; units: {}", symbols.join(", "));
    }
    UnitError { what, help }
}

/// A number with a unit.
struct Measured<'a> {
    digits: String,
    /// SI
    value: f64,
    factor: Factor,
    unit: &'a str,
}

impl Measured<'_> {
    /// The value if it is one of this quantity, SI; zero is the same in every unit.
    fn of(&self, quantity: Quantity) -> Option<f64> {
        if self.unit.is_empty() && self.value == 0.0 || quantity.accepts(self.factor.dimension) {
            return Some(self.value);
        }
        self.factor.of(quantity)?.apply(&self.digits)
    }
}

impl Factor {
    /// As a factor of this quantity: a plain 1/min of an angular speed counts turns.
    fn of(self, quantity: Quantity) -> Option<Factor> {
        match quantity.accepts(self.dimension) {
            true => Some(self),
            false => self
                .revolutions()
                .filter(|_| quantity == Quantity::AngularSpeed),
        }
    }
}

fn measure(text: &str) -> Result<Measured<'_>, String> {
    let (digits, unit) = split(text)?;
    let factor = grammar::unit_factor(unit)?;
    let value = factor
        .apply(&digits)
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("`{text}` is not a finite number"))?;
    Ok(Measured {
        digits,
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

/// How many of one unit are one of another, both of the same kind, like 100 for `"m"` in `"cm"`.
///
/// # Errors
/// What is wrong with a unit, in words.
pub fn ratio(of: &str, to: &str) -> Result<f64, String> {
    let [one, other] = [of, to].map(|unit| format!("1 {unit}"));
    let (one, other) = (measure(&one)?, measure(&other)?);
    match one.factor.dimension == other.factor.dimension {
        true => Ok(one.value / other.value),
        false => Err(format!("`{to}` is no unit of what is shown in {of}")),
    }
}

/// Whether a text is a unit of any quantity.
pub(super) fn is_unit(text: &str) -> bool {
    !text.trim().is_empty() && grammar::unit_factor(text.trim()).is_ok()
}

/// Splits `"-2.5e3 N m"` into its digits and its unit.
pub(super) fn split(text: &str) -> Result<(String, &str), String> {
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
