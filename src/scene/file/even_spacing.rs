//! Evenly spaced values of a key, computed on demand.

use super::keys::Key;
use super::{VariedValue, value};
use crate::scene::unit::{self, Factor};

/// Evenly spaced values from first to last, in the unit in which these are written.
#[derive(Clone, Debug)]
pub(super) struct EvenSpacing {
    ends: [f64; 2],
    unit: String,
    count: usize,
    logarithmic: bool,
    /// Factor of the unit to SI, if the key takes a quantity.
    factor: Option<Factor>,
}

impl EvenSpacing {
    /// Creates a spacing from first value, last value and count as written, even in the values or in their logarithm.
    pub fn new(
        key: &Key,
        [from, to]: [&str; 2],
        count: &str,
        logarithmic: bool,
    ) -> Result<EvenSpacing, String> {
        let most = 1_000_000;
        let counted = count.parse().ok();
        let counted = counted.filter(|count| (1..=most).contains(count));
        let count = counted
            .ok_or_else(|| format!("`{count}` is not a number of values from 1 to {most}"))?;
        let ((first, unit), (last, last_unit)) = (split(from)?, split(to)?);
        if !unit.is_empty() && unit != last_unit {
            return Err(format!(
                "`{from}` and `{to}` have different units; write both in one"
            ));
        }
        if count == 1 && first != last {
            return Err(format!("one value cannot be both `{from}` and `{to}`"));
        }
        if logarithmic && first * last <= 0.0 {
            return Err(format!(
                "`{from}` to `{to}` has no even spread in the logarithm; both must have one sign"
            ));
        }
        let spacing = EvenSpacing {
            ends: [first, last],
            unit: last_unit.to_owned(),
            count,
            logarithmic,
            factor: key
                .kind
                .quantity()
                .and_then(|quantity| unit::exact_factor(last_unit, quantity)),
        };
        // Values are monotonic: a fault of any of them is a fault of one of these.
        for index in [0, count - 1, 1, count.saturating_sub(2)] {
            let text = spacing.value(index.min(count - 1)).text;
            value::read_text(key, &text).map_err(|error| error.to_string())?;
        }
        Ok(spacing)
    }

    /// Returns the number of values, at least one.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns a value as written in a scene file, and in SI units and radians if it is a quantity.
    ///
    /// # Panics
    /// If `index` is not below the number of values.
    pub fn value(&self, index: usize) -> VariedValue {
        let ([first, last], end) = (self.ends, self.count - 1);
        assert!(index <= end, "value {index} of {}", self.count);
        let part = |whole: f64| whole * index as f64 / end as f64;
        let value = match index {
            0 => first,
            _ if index == end => last,
            _ if self.logarithmic => first * (last / first).powf(part(1.0)),
            // Division comes last, to keep decimal steps decimal.
            _ => first + part(last - first),
        };
        let mut text = value.to_string();
        let number = self.factor.and_then(|factor| factor.apply(&text));
        if !self.unit.is_empty() {
            text.push(' ');
            text.push_str(&self.unit);
        }
        VariedValue { text, number }
    }
}

/// Splits a text into a finite number and its unit.
fn split(text: &str) -> Result<(f64, &str), String> {
    let (digits, unit) = unit::split(text)?;
    let number = digits
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite());
    let number = number.ok_or_else(|| format!("`{text}` is not a finite number"))?;
    Ok((number, unit))
}
