//! Columns of rows by the names that people give them.

use super::quantity::{Quantity, split};
use super::table::Table;
use crate::error::Error;
use crate::scene::unit;

/// A column as it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub name: String,
    pub quantity: Quantity,
}

impl Curve {
    /// Values as they are shown.
    pub fn values<'a>(&self, table: &'a Table) -> impl Iterator<Item = f64> + use<'a> {
        let factor = self.quantity.factor;
        let values = table.numbers(&self.name).unwrap_or_default();
        values.iter().map(move |value| factor * value)
    }
}

/// Words and unit of an axis.
pub(super) fn labelled(words: &str, unit: &str) -> String {
    match unit {
        "" => words.to_owned(),
        unit => format!("{words} [{unit}]"),
    }
}

/// The column of the horizontal axis.
pub(super) fn base(names: &[&str], text: &str) -> Result<Curve, Error> {
    let mut found = curves(names, text)?;
    match found.len() {
        1 => Ok(found.remove(0)),
        _ => Err(no_column(names, text)),
    }
}

/// The columns that a text names, with the unit behind a colon.
pub(super) fn curves(names: &[&str], text: &str) -> Result<Vec<Curve>, Error> {
    let (wanted, in_unit) = match text.split_once(':') {
        Some((wanted, unit)) => (wanted.trim(), Some(unit.trim())),
        None => (text.trim(), None),
    };
    let has_name = |name: &&&str| **name == wanted || split(name).0 == wanted;
    let part = |name: &&&str| {
        let rest = |rest: &str| rest.starts_with('_') || rest.ends_with('_');
        let base = split(name).0;
        let (first, last) = (base.strip_prefix(wanted), base.strip_suffix(wanted));
        !wanted.is_empty() && [first, last].into_iter().flatten().any(rest)
    };
    let mut found: Vec<&&str> = names.iter().filter(has_name).collect();
    if found.is_empty() {
        found = names.iter().filter(part).collect();
    }
    if found.is_empty() {
        return Err(no_column(names, text));
    }
    found.into_iter().map(|name| curve(name, in_unit)).collect()
}

fn curve(name: &str, in_unit: Option<&str>) -> Result<Curve, Error> {
    let mut quantity = Quantity::of(name);
    if let Some(unit) = in_unit {
        let ratio = unit::ratio(&quantity.unit, unit)
            .map_err(|reason| Error::refused(reason, "a unit like x:cm, theta:rad or force:kN"))?;
        quantity.factor *= ratio;
        quantity.unit = unit.to_owned().into();
    }
    Ok(Curve {
        name: name.to_owned(),
        quantity,
    })
}

fn no_column(names: &[&str], text: &str) -> Error {
    let bases: Vec<&str> = names.iter().map(|name| split(name).0).collect();
    Error::refused(
        format!("`{text}` names no column of these rows"),
        format!("columns: {}", bases.join(", ")),
    )
}
