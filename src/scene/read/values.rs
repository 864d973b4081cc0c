//! The values of one table.

use std::collections::BTreeMap;

use toml::de::DeTable;

use super::Reader;
use super::value::{self, Value};
use crate::scene::keys::{self, Key, Section};
use crate::scene::{Every, Load};

/// The values of one table that could be read, by key.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Values {
    /// The section the table belongs to.
    pub section: &'static Section,
    /// The load of the table, where it is known already.
    pub load: Option<Load>,
    path: String,
    entries: BTreeMap<&'static str, Value>,
}

impl Values {
    /// Reads a table, which stands at `path` in the scene.
    pub fn read(
        reader: &mut Reader,
        section: &'static Section,
        path: String,
        table: &DeTable<'_>,
    ) -> Values {
        let mut values = Values {
            section,
            load: None,
            path,
            entries: BTreeMap::new(),
        };
        for (name, value) in table.iter() {
            let (name, name_span) = (name.get_ref(), name.span());
            let field = values.field(name);
            let Some(key) = section.keys.iter().find(|key| key.name == name) else {
                reader.found(&field, name_span);
                let what = format!("`{name}` is not a key of {}", section.name);
                let known = section.keys.iter().map(|key| key.name);
                reader.problem(&field, what, keys::did_you_mean(name, section.name, known));
                continue;
            };
            reader.found(&field, value.span());
            match value::read(key, value.get_ref()) {
                Ok(read) => {
                    values.entries.insert(key.name, read);
                }
                Err((what, help)) => reader.problem(&field, what, help),
            }
        }
        for key in section.keys {
            if section.required.contains(&key.name) {
                let what = format!("`{}` is missing in {}", key.name, section.name);
                let help = format!("add {}: {}", key.example(), key.meaning);
                reader.missing(&values, key.name, what, help);
            }
        }
        values
    }

    /// Puts a value in place of the one of a key, or beside the others.
    pub fn set(&mut self, key: &'static Key, value: Value) {
        self.entries.insert(key.name, value);
        self.load = None;
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        match self.entries.get(key) {
            Some(Value::Number(number)) => Some(number.value),
            _ => None,
        }
    }

    /// A text or the word of a choice.
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.entries.get(key) {
            Some(Value::Text(text)) => Some(text),
            Some(Value::Choice(word)) => Some(word),
            _ => None,
        }
    }

    /// A number without quotes where a quantity or a formula may stand.
    pub fn bare(&self, key: &str) -> Option<&str> {
        match self.entries.get(key) {
            Some(Value::Bare(digits)) => Some(digits),
            _ => None,
        }
    }

    pub fn every(&self, key: &str) -> Option<Every> {
        match self.entries.get(key) {
            Some(Value::Every(every)) => Some(*every),
            _ => None,
        }
    }

    pub fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    pub fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.entries.keys().copied()
    }

    /// The name of a key in problems, as `torque[1].value`.
    pub fn field(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }
}
