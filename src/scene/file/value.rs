//! Reads one value of a scene file.

use toml::de::DeValue;

use super::key_path::nearest;
use super::keys::{Key, Kind};
use crate::scene::Every;
use crate::scene::unit::{self, Quantity, Uncertain, UnitError};

/// Value as read from a scene file.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// Quantity or number, SI.
    Number(Uncertain),
    /// Text, or the word of a choice.
    Text(String),
    /// Digits without quotes where a quantity or a formula may stand; the kind of load decides which.
    Bare(String),
    Every(Every),
}

impl Value {
    /// Returns the value as a quantity, SI, if it is one.
    pub fn number(&self, kind: Kind) -> Option<Uncertain> {
        match (self, kind) {
            (Value::Number(number), _) => Some(*number),
            (Value::Text(text) | Value::Bare(text), Kind::Formula(quantity)) => {
                unit::uncertain(text, quantity).ok()
            }
            _ => None,
        }
    }
}

/// Reads the value of a key; the error has the fault and the remedy.
pub(super) fn read(key: &Key, value: &DeValue<'_>) -> Result<Value, UnitError> {
    let wrong = |what: String| {
        let help = expected(key.kind);
        Err(UnitError { what, help })
    };
    let text = match value {
        DeValue::String(text) => text.to_string(),
        DeValue::Float(number) => number.as_str().replace('_', ""),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().replace('_', ""),
        DeValue::Integer(number) => {
            let base = number.radix();
            return wrong(format!("`{}` is a number to base {base}", key.name));
        }
        other => {
            let (noun, vowels) = (other.type_str(), ['a', 'e', 'i', 'o', 'u']);
            let n = if noun.starts_with(vowels) { "n" } else { "" };
            return wrong(format!("`{}` is a{n} {noun}", key.name));
        }
    };
    match key.kind {
        Kind::Text | Kind::Formula(_) if value.is_str() => Ok(Value::Text(text)),
        Kind::Text => wrong(format!("`{text}` is a number")),
        Kind::Formula(_) => Ok(Value::Bare(text)),
        Kind::Of(quantity) => unit::uncertain(&text, quantity).map(Value::Number),
        Kind::TimeOrAngle => time_or_angle(&text).map(Value::Every),
        Kind::Choice(_) | Kind::Kinds(_) => choice(key, &text),
    }
}

/// Reads `text` as a time (s) or an angle (rad); a bare 0 is a time.
fn time_or_angle(text: &str) -> Result<Every, UnitError> {
    let every = unit::number_with_unit(text).and_then(|number| {
        let time = number.of(Quantity::Time).map(Every::Time);
        let angle = || number.of(Quantity::Angle).map(Every::Angle);
        time.or_else(angle).ok_or_else(|| match number.unit {
            "" => format!("`{text}` has no unit"),
            _ => format!("`{text}` is neither a time nor an angle"),
        })
    });
    let help = "write for example \"1 ms\" or \"1 deg\"".to_owned();
    every.map_err(|what| UnitError { what, help })
}

fn choice(key: &Key, text: &str) -> Result<Value, UnitError> {
    let words = key.kind.words();
    if words.contains(&text) {
        return Ok(Value::Text(text.to_owned()));
    }
    let help = match nearest(text, words.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"? It may be {}", quoted(&words)),
        None => expected(key.kind),
    };
    let what = format!("`{}` cannot be `{text}`", key.name);
    Err(UnitError { what, help })
}

/// Reads the value of a key from its text.
pub(super) fn read_text(key: &Key, text: &str) -> Result<Value, UnitError> {
    read(key, &DeValue::String(text.into()))
}

fn expected(kind: Kind) -> String {
    match kind {
        Kind::Choice(_) | Kind::Kinds(_) => format!("write one of {}", quoted(&kind.words())),
        Kind::Text => "write a text in quotes".to_owned(),
        Kind::Of(quantity) | Kind::Formula(quantity) => {
            format!("write {} like {}", quantity.name(), quantity.examples())
        }
        Kind::TimeOrAngle => "write a time or an angle like \"1 ms\", \"1 deg\"".to_owned(),
    }
}

fn quoted(words: &[&str]) -> String {
    format!("\"{}\"", words.join("\", \""))
}
