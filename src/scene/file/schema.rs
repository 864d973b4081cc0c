//! JSON Schema of scene files, built from the list of keys that the reader uses.

use serde_json::{Map, Value, json};

use super::keys::{Key, Kind, SECTIONS, Section, Tables};
use crate::scene::unit::{self, Quantity};

/// Returns the schema, draft 2020-12.
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
    if !section.kinds().is_empty() {
        one["allOf"] = kinds(section);
    }
    if section.tables == Tables::Many {
        json!({"type": "array", "items": one})
    } else {
        one
    }
}

/// Returns each kind with its required keys (for `dry` a value or a table), and the units of keys that are formulas in
/// another kind.
fn kinds(section: &Section) -> Value {
    let kinds = section.kinds();
    kinds
        .iter()
        .map(|kind| {
            let mut then = match kind.name {
                "dry" => json!({"anyOf": [{"required": ["value"]}, {"required": ["file", "of"]}]}),
                _ => json!({"required": &kind.keys[..kind.required]}),
            };
            let keys = section.keys.iter();
            for key in keys.filter(|key| kind.keys.contains(&key.name)) {
                if let Kind::Formula(quantity) = key.kind
                    && kind.name != "expression"
                {
                    then["properties"][key.name] = measured(&[quantity]);
                }
            }
            json!({
                "if": {"properties": {"kind": {"const": kind.name}}, "required": ["kind"]},
                "then": then,
            })
        })
        .collect()
}

fn property(key: &Key) -> Value {
    let mut value = match key.kind {
        Kind::Of(Quantity::Number) => json!({"type": "number"}),
        Kind::Of(quantity) => measured(&[quantity]),
        Kind::TimeOrAngle => measured(&[Quantity::Time, Quantity::Angle]),
        Kind::Formula(quantity) => {
            json!({"type": ["string", "number"], "examples": examples(&[quantity])})
        }
        Kind::Choice(_) | Kind::Kinds(_) => json!({"enum": key.kind.words()}),
        Kind::Text => json!({"type": "string"}),
    };
    value["description"] = json!(key.meaning);
    value
}

/// Returns the schema of a text with a number and a unit of one of these quantities, or of 0.
fn measured(quantities: &[Quantity]) -> Value {
    let pattern = unit::pattern(quantities);
    json!({
        "anyOf": [{"type": "string", "pattern": pattern}, {"const": 0}],
        "examples": examples(quantities),
    })
}

fn examples(quantities: &[Quantity]) -> Vec<&'static str> {
    let lists = quantities.iter().map(|quantity| quantity.examples());
    let each = lists.flat_map(|list| list.split(", "));
    each.map(|example| example.trim_matches('"')).collect()
}
