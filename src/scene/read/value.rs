//! One value of a scene file.

use toml::de::DeValue;

use crate::scene::Every;
use crate::scene::keys::{self, Key, Kind};
use crate::scene::unit::{self, Uncertain};

/// A value that has been read.
#[derive(Clone, Debug)]
pub(in crate::scene) enum Value {
    /// SI
    Number(Uncertain),
    Text(String),
    /// Digits without quotes where a quantity or a formula may stand; the kind of load decides.
    Bare(String),
    Choice(&'static str),
    Every(Every),
}

impl Value {
    /// The value as a quantity, SI, if it is one.
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

/// Reads the value of a key, or says what is wrong and what would be right.
pub(in crate::scene) fn read(key: &Key, value: &DeValue<'_>) -> Result<Value, (String, String)> {
    let text = match value {
        DeValue::String(text) => text.to_string(),
        DeValue::Float(number) => number.as_str().replace('_', ""),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().replace('_', ""),
        DeValue::Integer(number) => {
            let what = format!("`{}` is a number to base {}", key.name, number.radix());
            return Err((what, expected(key.kind)));
        }
        other => {
            let what = format!("`{}` is {}", key.name, with_article(other.type_str()));
            return Err((what, expected(key.kind)));
        }
    };
    match key.kind {
        Kind::Text | Kind::Formula(_) if value.is_str() => Ok(Value::Text(text)),
        Kind::Text => Err((format!("`{text}` is a number"), expected(key.kind))),
        Kind::Formula(_) => Ok(Value::Bare(text)),
        Kind::Of(quantity) => unit::uncertain(&text, quantity)
            .map(Value::Number)
            .map_err(|e| (e.what, e.help)),
        Kind::TimeOrAngle => unit::time_or_angle(&text)
            .map(Value::Every)
            .map_err(|e| (e.what, e.help)),
        Kind::Choice(words) => match words.iter().find(|word| **word == text) {
            Some(word) => Ok(Value::Choice(word)),
            None => Err((
                format!("`{}` cannot be `{text}`", key.name),
                match keys::nearest(&text, words.iter().copied()) {
                    Some(near) => format!("did you mean \"{near}\"? It may be {}", quoted(words)),
                    None => expected(key.kind),
                },
            )),
        },
    }
}

fn expected(kind: Kind) -> String {
    match kind {
        Kind::Choice(words) => format!("write one of {}", quoted(words)),
        Kind::Text => "write a text in quotes".to_owned(),
        Kind::Of(quantity) | Kind::Formula(quantity) => {
            format!("write {} like {}", quantity.name(), quantity.examples())
        }
        Kind::TimeOrAngle => "write a time or an angle like \"1 ms\", \"1 deg\"".to_owned(),
    }
}

fn with_article(noun: &str) -> String {
    let article = if noun.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {noun}")
}

fn quoted(words: &[&str]) -> String {
    words
        .iter()
        .map(|word| format!("\"{word}\""))
        .collect::<Vec<_>>()
        .join(", ")
}
