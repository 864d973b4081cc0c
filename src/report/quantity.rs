//! Meaning of columns, from their names: label, symbol, displayed unit and panel; and lookup of columns by the names
//! that users type.

use std::borrow::Cow;
use std::f64::consts::PI;

use serde::Serialize;

use crate::error::Error;
use crate::scene::unit;

/// Splits the name of a column into base name and unit suffix.
pub(super) fn split(column: &str) -> (&str, &str) {
    let ending = UNITS.iter().find(|(ending, ..)| column.ends_with(ending));
    column.split_at(column.len() - ending.map_or(0, |(ending, ..)| ending.len()))
}

/// Column with its label, displayed unit and panel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Quantity {
    /// Name of the column, with the SI unit.
    pub name: String,
    /// Name and symbol.
    pub label: String,
    /// Displayed unit; empty if dimensionless.
    pub unit: Cow<'static, str>,
    /// Factor from the unit of the column to `unit`.
    pub factor: f64,
    /// Name of the panel: columns of one group share a panel.
    pub group: String,
}

/// Unit suffix of columns, displayed unit, and factor from the first to the second; longer suffixes first.
const UNITS: [(&str, &str, f64); 22] = [
    ("_rad_per_s2", "rad/s²", 1.0),
    ("_m_per_rad2", "mm/rad²", 1e3),
    ("_m_per_rad", "mm/rad", 1e3),
    ("_rad_per_s", "rad/s", 1.0),
    ("_m_per_s2", "m/s²", 1.0),
    ("_m_per_s", "m/s", 1.0),
    ("_per_s2", "1/s²", 1.0),
    ("_per_rad2", "1/rad²", 1.0),
    ("_per_rad", "1/rad", 1.0),
    ("_per_s", "1/s", 1.0),
    ("_kg_m2", "kg m²", 1.0),
    ("_rad", "°", 180.0 / PI),
    ("_deg", "°", 1.0),
    ("_nm", "N m", 1.0),
    ("_kg", "kg", 1.0),
    ("_mm", "mm", 1.0),
    ("_j", "J", 1.0),
    ("_w", "W", 1.0),
    ("_hz", "Hz", 1.0),
    ("_n", "N", 1.0),
    ("_m", "mm", 1e3),
    ("_s", "s", 1.0),
];

/// Known columns: base name, label and panel.
const KNOWN: [(&str, &str, &str); 19] = [
    ("t", "time t", ""),
    ("theta", "crank angle θ", "crank angle"),
    ("omega", "crank speed ω", "crank speed"),
    ("alpha", "crank acceleration α", "crank acceleration"),
    ("x", "slider position x", "slider position"),
    ("v", "slider velocity v", "slider velocity"),
    ("a", "slider acceleration a", "slider acceleration"),
    ("dx", "x′", "first derivative of x"),
    ("d2x", "x″", "second derivative of x"),
    ("phi", "rod angle φ", "rod angle"),
    ("dphi", "φ′", "derivatives of the rod angle"),
    ("d2phi", "φ″", "derivatives of the rod angle"),
    ("gamma", "crank-pin angle γ", "crank-pin angle"),
    ("transmission", "transmission angle", "transmission angle"),
    ("side_thrust", "side thrust", "side thrust"),
    ("spin_only_force", "energies of the paper", "forces"),
    ("duarte_9_force", "(9) as printed", "forces"),
    ("self_locking", "self-locking", ""),
    ("near_dead_centre", "near a dead centre", ""),
];

/// Prefixes and suffixes of columns that share the panel of their base column.
const VARIANTS: [&str; 6] = [
    "ideal",
    "first_order",
    "changed",
    "change",
    "measured",
    "fitted",
];

impl Quantity {
    /// Derives label, unit and panel from the name of a column.
    pub fn of(column: &str) -> Quantity {
        let (base, ending) = split(column);
        let unit = UNITS.iter().find(|(known, ..)| *known == ending);
        let (_, unit, factor) = unit.copied().unwrap_or(("", "", 1.0));
        // Errors stay in radians, far smaller than a degree.
        let (unit, factor) = match base.starts_with("error") || base.starts_with("estimate") {
            true if ending == "_rad" => ("rad", 1.0),
            _ => (unit, factor),
        };
        let (base, of) = match base.rsplit_once("_of_") {
            Some((base, number)) if number.parse::<u32>().is_ok() => (base, Some(number)),
            _ => (base, None),
        };
        let beside = VARIANTS.iter().find_map(|more| {
            let (first, last) = (base.strip_prefix(more), base.strip_suffix(more));
            let rest = first.or(last)?.trim_matches('_');
            Some((rest, more.replace('_', " ")))
        });
        let (base, more) = beside.unwrap_or((base, String::new()));
        let known = KNOWN.iter().find(|(known, ..)| *known == base);
        let (words, group) = match known {
            Some((_, words, group)) => ((*words).to_owned(), (*group).to_owned()),
            None => (base.replace('_', " "), group(base, unit)),
        };
        let more = of.map_or(more, |number| format!("motion {number}"));
        let label = if more.is_empty() {
            words
        } else {
            format!("{words}, {more}")
        };
        Quantity {
            name: column.to_owned(),
            label,
            unit: Cow::Borrowed(unit),
            factor,
            group,
        }
    }
}

/// Returns the panel of a column that is not among [`KNOWN`].
fn group(name: &str, unit: &str) -> String {
    match unit {
        _ if name.starts_with("journal") => String::new(),
        "N" => "forces".to_owned(),
        "N m" => "torques".to_owned(),
        "J" => "energies".to_owned(),
        "" => name.replace('_', " "),
        unit => format!("{} [{unit}]", name.replace('_', " ")),
    }
}

/// Finds the column of the horizontal axis; refuses a text that names several.
pub(super) fn base(names: &[&str], text: &str) -> Result<Quantity, Error> {
    let [found] =
        <[Quantity; 1]>::try_from(curves(names, text)?).map_err(|_| no_column(names, text))?;
    Ok(found)
}

/// Finds the columns that a text names, fully or by first or last words; a unit may follow a colon.
pub(super) fn curves(names: &[&str], text: &str) -> Result<Vec<Quantity>, Error> {
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

fn curve(name: &str, in_unit: Option<&str>) -> Result<Quantity, Error> {
    let mut quantity = Quantity::of(name);
    if let Some(unit) = in_unit {
        let ratio = unit::ratio(&quantity.unit, unit)
            .map_err(|reason| Error::refused(reason, "a unit like x:cm, theta:rad or force:kN"))?;
        quantity.factor *= ratio;
        quantity.unit = unit.to_owned().into();
    }
    Ok(quantity)
}

fn no_column(names: &[&str], text: &str) -> Error {
    let bases: Vec<&str> = names.iter().map(|name| split(name).0).collect();
    Error::refused(
        format!("`{text}` names no column of these rows"),
        format!("columns: {}", bases.join(", ")),
    )
}

#[cfg(test)]
mod tests {
    use super::Quantity;

    #[test]
    fn names_of_columns_tell_quantity_and_unit() {
        for (column, label, unit, group) in [
            ("t_s", "time t", "s", ""),
            ("theta_rad", "crank angle θ", "°", "crank angle"),
            (
                "x_ideal_m",
                "slider position x, ideal",
                "mm",
                "slider position",
            ),
            ("v_m_per_s", "slider velocity v", "m/s", "slider velocity"),
            ("d2x_m_per_rad2", "x″", "mm/rad²", "second derivative of x"),
            ("wrist_pin_x_n", "wrist pin x", "N", "forces"),
            ("crank_torque_nm", "crank torque", "N m", "torques"),
            ("shaking_moment_nm", "shaking moment", "N m", "torques"),
            ("journal_x_m", "journal x", "mm", ""),
            ("dphi", "φ′", "", "derivatives of the rod angle"),
        ] {
            let found = Quantity::of(column);
            assert_eq!(found.label, label);
            assert_eq!((&*found.unit, &*found.group), (unit, group), "{column}");
        }
    }
}
