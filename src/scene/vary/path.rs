//! Where a value stands in a scene.

use std::fmt;

use crate::scene::keys::{self, Key, Kind, Section};
use crate::scene::unit::Quantity;

/// The place of a value in a scene, as `geometry.offset` or `torque[2].value`.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct KeyPath {
    pub section: &'static Section,
    /// Which of several tables, from 0.
    pub index: usize,
    pub key: &'static Key,
}

impl KeyPath {
    /// Reads a path; the number of a table counts from 1 and may be left out where the first is meant.
    pub fn parse(text: &str) -> Result<KeyPath, String> {
        let (table, name) = text.split_once('.').ok_or_else(|| {
            format!("`{text}` is no key of a scene; write it like geometry.offset")
        })?;
        let (table, index) = numbered(table).ok_or_else(|| {
            format!("`{table}` does not end in a number from 1 on, like torque[1]")
        })?;
        let section = keys::section(table).ok_or_else(|| {
            let known = keys::SECTIONS.iter().map(|section| section.name);
            let help = keys::did_you_mean(table, "a scene", known);
            format!("`{table}` is not part of a scene; {help}")
        })?;
        let key = section.keys.iter().find(|key| key.name == name);
        let key = key.ok_or_else(|| {
            let known = section.keys.iter().map(|key| key.name);
            let help = keys::did_you_mean(name, table, known);
            format!("`{name}` is not a key of {table}; {help}")
        })?;
        if index > 0 && !section.repeated {
            return Err(format!(
                "a scene has one {table} only; write {table}.{name}"
            ));
        }
        Ok(KeyPath {
            section,
            index,
            key,
        })
    }

    /// What the key measures, if it takes a quantity.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.key.kind {
            Kind::Of(quantity) | Kind::Formula(quantity) => Some(quantity),
            Kind::TimeOrAngle | Kind::Choice(_) | Kind::Text => None,
        }
    }

    /// The path as the name of a column.
    pub fn column(&self) -> String {
        let number = match self.section.repeated {
            true => format!("_{}", self.index + 1),
            false => String::new(),
        };
        format!("{}{number}_{}", self.section.name, self.key.name)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.section.repeated {
            true => write!(f, "{}[{}].", self.section.name, self.index + 1)?,
            false => write!(f, "{}.", self.section.name)?,
        }
        f.write_str(self.key.name)
    }
}

/// `torque[2]` as its name and its index from 0.
fn numbered(table: &str) -> Option<(&str, usize)> {
    let Some((name, number)) = table.split_once('[') else {
        return Some((table, 0));
    };
    let number: usize = number.strip_suffix(']')?.trim().parse().ok()?;
    Some((name, number.checked_sub(1)?))
}
