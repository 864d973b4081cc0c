//! Paths of the values in a scene, and the known name that an unknown one may mean.

use std::fmt;
use std::str::FromStr;

use super::keys::{self, Key, Section, Tables};
use crate::scene::unit::Quantity;

/// Path of a value in a scene, as `geometry.offset` or `torque[2].value`.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyPath {
    pub section: &'static Section,
    /// Index among several tables of one name, from 0.
    pub index: usize,
    pub key: &'static Key,
}

impl KeyPath {
    /// Returns the SI unit in the form of scene files; empty for numbers and words.
    pub fn unit(&self) -> &'static str {
        self.key.kind.quantity().map_or("", Quantity::si)
    }
}

/// Parses a path; the number of a table counts from 1 and may be left out for the first.
impl FromStr for KeyPath {
    type Err = String;

    fn from_str(text: &str) -> Result<KeyPath, String> {
        let (table, name) = text.split_once('.').ok_or_else(|| {
            format!("`{text}` is no key of a scene; write it like geometry.offset")
        })?;
        let (table, index) = numbered(table).ok_or_else(|| {
            format!("`{table}` does not end in a number from 1 on, like torque[1]")
        })?;
        let section = keys::section(table).ok_or_else(|| {
            let known = keys::SECTIONS.iter().map(|section| section.name);
            let help = did_you_mean(table, "a scene", known);
            format!("`{table}` is not part of a scene; {help}")
        })?;
        let key = section.key(name).ok_or_else(|| {
            let known = section.keys.iter().map(|key| key.name);
            let help = did_you_mean(name, table, known);
            format!("`{name}` is not a key of {table}; {help}")
        })?;
        let is_known = index == 0 || section.tables == Tables::Many;
        let path = is_known.then_some(KeyPath {
            section,
            index,
            key,
        });
        path.ok_or_else(|| format!("a scene has one {table} only; write {table}.{name}"))
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (section, key) = (self.section.name, self.key.name);
        match self.section.tables {
            Tables::Many => write!(f, "{section}[{}].{key}", self.index + 1),
            Tables::One => write!(f, "{section}.{key}"),
        }
    }
}

/// Splits `torque[2]` into its name and its index from 0.
fn numbered(table: &str) -> Option<(&str, usize)> {
    let Some((name, number)) = table.split_once('[') else {
        return Some((table, 0));
    };
    let number: usize = number.strip_suffix(']')?.trim().parse().ok()?;
    Some((name, number.checked_sub(1)?))
}

/// Key of a scene that takes a quantity, parsed from a text like `crank.inertia` or `torque[2].coefficient`.
#[derive(Clone, Copy, Debug)]
pub struct NumberKey(pub(super) KeyPath);

impl NumberKey {
    /// Returns the SI unit in the form of scene files; empty for numbers.
    pub fn unit(&self) -> &'static str {
        self.0.unit()
    }
}

impl fmt::Display for NumberKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for NumberKey {
    type Err = String;

    fn from_str(text: &str) -> Result<NumberKey, String> {
        let path: KeyPath = text.trim().parse()?;
        let quantity = path.key.kind.quantity();
        let key = quantity.map(|_| NumberKey(path));
        key.ok_or_else(|| format!("`{path}` holds no quantity"))
    }
}

/// Returns the help for an unknown `name`: the most similar known name, or all names that `owner` has.
pub fn did_you_mean<'a>(
    name: &str,
    owner: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("{owner} has {}", known.collect::<Vec<_>>().join(", ")),
    }
}

/// Returns the candidate most similar to `name`, if its Jaro-Winkler similarity is above 0.75.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
