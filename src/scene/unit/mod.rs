//! Quantities in text: takes a number and a unit, checks the dimension, returns the SI value by exact factors.

mod grammar;
#[cfg(feature = "cli")]
mod pattern;
mod quantity;
mod symbol;

use super::number;
#[cfg(feature = "cli")]
pub(super) use pattern::pattern;
pub use quantity::Quantity;
use symbol::Factor;

/// Reason why a text is not the requested quantity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}; {help}")]
pub struct UnitError {
    /// Fault, in words.
    pub what: String,
    /// Remedy, in words.
    pub help: String,
}

/// Reads `text` as `quantity` and returns it in SI units and radians.
///
/// Powers of ten are applied to the decimal digits before they are rounded, so `"155.83 mm"` is the
/// double nearest to 0.15583.
///
/// # Errors
/// [`UnitError`] with the fault of number or unit, and examples of the remedy.
///
/// ```
/// use slider_crank::scene::unit::{parse, Quantity};
/// assert_eq!(parse("155.83 mm", Quantity::Length), Ok(0.15583));
/// assert_eq!(parse("5807.55 kg·mm²", Quantity::Inertia), Ok(5807.55e-6));
/// assert!(parse("47 kg", Quantity::Length).is_err());
/// ```
pub fn parse(text: &str, quantity: Quantity) -> Result<f64, UnitError> {
    let measured = number_with_unit(text).map_err(|what| {
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

/// Value with its standard error, SI and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertain {
    /// Estimated value.
    pub value: f64,
    /// Standard error, 0 if none is written.
    pub error: f64,
}

/// Signs between a value and its standard error.
pub(super) const PLUS_MINUS: [&str; 3] = ["+-", "+/-", "±"];

/// Reads `text` as `quantity` with an optional standard error; a unit written once holds for both.
///
/// # Errors
/// The errors of [`parse`], and a negative standard error.
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

/// Creates an error with examples of the quantity and, if `with_units`, the unit symbols of its dimension.
fn wrong(what: String, quantity: Quantity, with_units: bool) -> UnitError {
    let mut help = format!("write {} like {}", quantity.name(), quantity.examples());
    let symbols: Vec<_> = symbol::symbols(quantity.dimension()).collect();
    if with_units && !symbols.is_empty() {
        help += &format!("; units: {}", symbols.join(", "));
    }
    UnitError { what, help }
}

/// Number with a unit.
pub(super) struct NumberWithUnit<'a> {
    digits: String,
    /// Value, SI.
    value: f64,
    factor: Factor,
    pub unit: &'a str,
}

impl NumberWithUnit<'_> {
    /// Returns the value, SI, if it is one of this quantity; a bare zero is one of every quantity.
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        if self.unit.is_empty() && self.value == 0.0 || quantity.accepts(self.factor.dimension) {
            return Some(self.value);
        }
        // 1/min as an angular speed counts turns.
        let turns = self.factor.revolutions();
        let turns = turns.filter(|_| quantity == Quantity::AngularSpeed);
        turns?.apply(&self.digits)
    }
}

pub(super) fn number_with_unit(text: &str) -> Result<NumberWithUnit<'_>, String> {
    let (digits, unit) = split(text)?;
    let factor = grammar::unit_factor(unit)?;
    let value = factor
        .apply(&digits)
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("`{text}` is not a finite number"))?;
    Ok(NumberWithUnit {
        digits,
        value,
        factor,
        unit,
    })
}

/// Returns the SI value of one unit that stands alone, as in a column header `pressure [bar]`.
///
/// # Errors
/// The errors of [`parse`].
pub fn factor(unit: &str, quantity: Quantity) -> Result<f64, UnitError> {
    parse(&format!("1 {unit}"), quantity)
}

/// Returns the ratio of unit `of` to unit `to`, both of one dimension, like 100 for `"m"` in `"cm"`.
///
/// # Errors
/// Fault of a unit, in words.
pub fn ratio(of: &str, to: &str) -> Result<f64, String> {
    let [one, other] = [of, to].map(|unit| format!("1 {unit}"));
    let (one, other) = (number_with_unit(&one)?, number_with_unit(&other)?);
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
