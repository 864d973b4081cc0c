//! Evenly spaced values of a key.

use super::VariedValue;
use super::keys::Key;
use crate::scene::unit;

/// Returns values from first to last, even in the values or in their logarithm, in the unit in which these are written.
pub(super) fn evenly(
    key: &Key,
    [from, to]: [&str; 2],
    count: &str,
    logarithmic: bool,
) -> Result<Vec<VariedValue>, String> {
    let most = 1_000_000;
    let counted: Option<usize> = count.parse().ok();
    let counted = counted.filter(|count| (1..=most).contains(count));
    let count =
        counted.ok_or_else(|| format!("`{count}` is not a number of values from 1 to {most}"))?;
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
    let end = count - 1;
    let value = |index: usize| {
        let part = |whole: f64| whole * index as f64 / end as f64;
        let value = match index {
            0 => first,
            _ if index == end => last,
            _ if logarithmic => first * (last / first).powf(part(1.0)),
            // Division comes last, to keep decimal steps decimal.
            _ => first + part(last - first),
        };
        VariedValue::read(key, format!("{value} {last_unit}").trim_end().to_owned())
    };
    (0..count).map(value).collect()
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
