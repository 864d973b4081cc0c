//! JSON Schema of scene files, from the same list of keys that the reader uses.

use serde_json::{Map, Value, json};

use super::keys::{FORCES, Key, Kind, KindKeys, MOTIONS, SECTIONS, Section, TORQUES};
use super::unit::Quantity;

/// The schema, draft 2020-12.
///
/// ```
/// let schema = slider_crank::scene::schema();
/// assert_eq!(schema["properties"]["geometry"]["required"][0], "crank");
/// ```
pub fn schema() -> Value {
    let mut properties = Map::new();
    properties.insert(
        "title".to_owned(),
        json!({"type": "string", "description": "what the scene is, in a line"}),
    );
    for section in SECTIONS {
        properties.insert(section.name.to_owned(), table(section));
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "slider-crank scene",
        "type": "object",
        "properties": properties,
        "required": ["geometry"],
        "additionalProperties": false,
    })
}

fn table(section: &Section) -> Value {
    let properties: Map<String, Value> = section
        .keys
        .iter()
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
    let mut one = json!({
        "type": "object",
        "description": section.meaning,
        "properties": properties,
        "required": section.required,
        "additionalProperties": false,
    });
    match section.name {
        "torque" => one["allOf"] = kinds(TORQUES),
        "force" => one["allOf"] = kinds(FORCES),
        "motion" => one["allOf"] = kinds(MOTIONS),
        _ => {}
    }
    if section.repeated {
        json!({"type": "array", "items": one})
    } else {
        one
    }
}

/// Each kind with the keys it needs.
fn kinds(kinds: &[KindKeys]) -> Value {
    kinds
        .iter()
        .map(|kind| {
            json!({
                "if": {"properties": {"kind": {"const": kind.name}}, "required": ["kind"]},
                "then": {"required": &kind.keys[..kind.required]},
            })
        })
        .collect()
}

fn property(key: &Key) -> Value {
    let mut value = match key.kind {
        Kind::Quantity(Quantity::Number) => json!({"type": "number"}),
        Kind::Quantity(quantity) => measured(&[quantity.examples()]),
        Kind::TimeOrAngle => measured(&[Quantity::Time.examples(), Quantity::Angle.examples()]),
        Kind::QuantityOrFormula(quantity) => measured(&[quantity.examples()]),
        Kind::Choice(words) => json!({"enum": words}),
        Kind::Text => json!({"type": "string"}),
    };
    value["description"] = json!(key.meaning);
    value
}

/// A text with number and unit, or 0.
fn measured(examples: &[&str]) -> Value {
    let examples: Vec<&str> = examples
        .iter()
        .flat_map(|list| list.split(", "))
        .map(|example| example.trim_matches('"'))
        .collect();
    json!({"anyOf": [{"type": "string"}, {"const": 0}], "examples": examples})
}
