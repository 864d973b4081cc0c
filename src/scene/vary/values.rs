//! The values that a key takes, one after the other.

use toml::de::DeValue;

use crate::scene::keys::{Key, Kind};
use crate::scene::read::value;
use crate::scene::unit;

/// Most values of one key.
const MOST: usize = 1_000_000;

/// A value as a scene file has it and, if it is a quantity, in SI.
#[derive(Clone, Debug)]
pub(super) struct Value {
    pub text: String,
    pub number: Option<f64>,
}

/// Reads `0mm:20mm:41`, `1:100:5:log` or `150 mm, 155.83 mm`.
pub(super) fn read(key: &Key, text: &str) -> Result<Vec<Value>, String> {
    let fields: Vec<&str> = text.split(':').map(str::trim).collect();
    let texts = match (fields.as_slice(), key.kind) {
        (_, Kind::Text) | ([_], _) => listed(text),
        ([from, to, count], _) => spread(from, to, count, false)?,
        ([from, to, count, "log"], _) => spread(from, to, count, true)?,
        _ => {
            return Err(format!(
                "`{text}` is no range; write first, last and count, like 0mm:20mm:41 or 1mm:100mm:7:log"
            ));
        }
    };
    texts.into_iter().map(|text| value(key, text)).collect()
}

fn value(key: &Key, text: String) -> Result<Value, String> {
    let found = value::read(key, &DeValue::String(text.as_str().into()));
    let number = found
        .map_err(|(what, help)| format!("{what}; {help}"))?
        .number(key.kind);
    if text.is_empty() {
        return Err(format!("a value of `{}` is empty", key.name));
    }
    let number = number.map(|number| number.value);
    Ok(Value { text, number })
}

/// The values between commas; those in brackets, as of `max(1, omega)`, do not count.
fn listed(text: &str) -> Vec<String> {
    let mut depth = 0;
    let parts = text.split(|c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    });
    parts.map(|part| part.trim().to_owned()).collect()
}

/// Values from the first to the last, in the unit in which these are written.
fn spread(from: &str, to: &str, count: &str, logarithmic: bool) -> Result<Vec<String>, String> {
    let count = match count.parse() {
        Ok(count @ 1..=MOST) => count,
        _ => {
            return Err(format!(
                "`{count}` is not a number of values from 1 to {MOST}"
            ));
        }
    };
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
    let at = |i: usize| match i {
        0 => first,
        i if i == end => last,
        i if logarithmic => first * (last / first).powf(i as f64 / end as f64),
        // Divided last, so that decimal steps stay decimal.
        i => first + (last - first) * i as f64 / end as f64,
    };
    let text = |i| format!("{} {last_unit}", at(i)).trim_end().to_owned();
    Ok((0..count).map(text).collect())
}

/// A number and its unit.
fn split(text: &str) -> Result<(f64, &str), String> {
    let (digits, unit) = unit::split(text)?;
    let number = digits
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite());
    Ok((
        number.ok_or_else(|| format!("`{text}` is not a finite number"))?,
        unit,
    ))
}
