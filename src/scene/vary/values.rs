//! The values that a key takes, one after the other or at random.

use statrs::distribution::{ContinuousCDF, Normal};
use toml::de::DeValue;

use crate::scene::keys::{Key, Kind};
use crate::scene::read::value;
use crate::scene::unit::{self, PLUS_MINUS};

/// Most values of one key.
const MOST_VALUES: usize = 1_000_000;

/// A value that a key of a scene takes.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedValue {
    /// As a scene file has it.
    pub text: String,
    /// In SI units and radians; none of words, formulas and files.
    pub number: Option<f64>,
}

/// Where the values of a key come from.
#[derive(Clone, Debug)]
pub(super) enum Values {
    Listed(Vec<VariedValue>),
    /// Evenly between two numbers, SI.
    Uniform([f64; 2]),
    /// With a mean and a standard deviation, SI.
    Normal(Normal),
}

/// Reads `0mm:20mm:41`, `1:100:5:log` or `150 mm, 155.83 mm`; the distributions `0mm:20mm` or `155.8 +- 0.1 mm`.
pub(super) fn read(key: &Key, text: &str) -> Result<Values, String> {
    let fields: Vec<&str> = text.split(':').map(str::trim).collect();
    let texts = match (fields.as_slice(), key.kind) {
        (_, Kind::Text) => listed(text),
        ([one], _) if PLUS_MINUS.iter().any(|sign| one.contains(sign)) => return normal(key, one),
        ([_], _) => listed(text),
        ([from, to], _) => return uniform(key, from, to),
        ([from, to, count], _) => spread(from, to, count, false)?,
        ([from, to, count, "log"], _) => spread(from, to, count, true)?,
        _ => {
            return Err(format!(
                "`{text}` is no range; write first, last and count, like 0mm:20mm:41 or 1mm:100mm:7:log"
            ));
        }
    };
    let values: Result<_, String> = texts.into_iter().map(|text| value(key, text)).collect();
    Ok(Values::Listed(values?))
}

fn uniform(key: &Key, low: &str, high: &str) -> Result<Values, String> {
    let number = |text: &str| {
        value(key, text.to_owned())?
            .number
            .ok_or_else(|| format!("`{text}` is no number"))
    };
    let (from, to) = (number(low)?, number(high)?);
    match from < to {
        true => Ok(Values::Uniform([from, to])),
        false => Err(format!("`{low}` is not less than `{high}`")),
    }
}

fn normal(key: &Key, text: &str) -> Result<Values, String> {
    let found = value::read(key, &DeValue::String(text.into()));
    let found = found
        .map_err(|(what, help)| format!("{what}; {help}"))?
        .number(key.kind);
    let normal = found.and_then(|found| Normal::new(found.value, found.error).ok());
    normal
        .map(Values::Normal)
        .ok_or_else(|| format!("`{text}` is no number with a standard deviation above 0"))
}

impl Values {
    /// Whether all are quantities.
    pub fn are_numbers(&self) -> bool {
        match self {
            Values::Listed(list) => list.iter().all(|value| value.number.is_some()),
            Values::Uniform(_) | Values::Normal(_) => true,
        }
    }

    /// The value below which a part `p` of them lies, in a unit.
    pub fn quantile(&self, p: f64, unit: &str) -> VariedValue {
        let number = match self {
            Values::Listed(list) => return list[(p * list.len() as f64) as usize].clone(),
            Values::Uniform([low, high]) => low + p * (high - low),
            Values::Normal(normal) => normal.inverse_cdf(p),
        };
        VariedValue {
            text: format!("{number} {unit}").trim_end().to_owned(),
            number: Some(number),
        }
    }
}

fn value(key: &Key, text: String) -> Result<VariedValue, String> {
    let found = value::read(key, &DeValue::String(text.as_str().into()));
    let number = found
        .map_err(|(what, help)| format!("{what}; {help}"))?
        .number(key.kind);
    if text.is_empty() {
        return Err(format!("a value of `{}` is empty", key.name));
    }
    let number = number.map(|number| number.value);
    Ok(VariedValue { text, number })
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
        Ok(count @ 1..=MOST_VALUES) => count,
        _ => {
            return Err(format!(
                "`{count}` is not a number of values from 1 to {MOST_VALUES}"
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
