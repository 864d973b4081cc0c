//! Column headers with units: `t [s]`, `theta (deg)`, `omega_rad_per_s`, `pressure / bar`.

use super::Column;
use crate::scene::unit::{self, Quantity};

/// A header split into the name and the unit of its column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::scene) struct Header {
    /// Name of the column, in lower case.
    pub name: String,
    /// Unit as written, empty if there is none.
    pub unit: String,
}

/// Greek letters that stand for column names.
const GREEK: [(&str, &str); 3] = [("θ", "theta"), ("γ", "gamma"), ("ω", "omega")];

/// Splits a column header into name and unit.
pub(in crate::scene) fn split(text: &str) -> Header {
    let text = text.trim().trim_start_matches('\u{feff}');
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = text.split_once(open)
            && let Some(unit) = rest.trim_end().strip_suffix(close)
        {
            return header(name, unit);
        }
    }
    if let Some((name, unit)) = text.split_once(" / ") {
        return header(name, unit);
    }
    for (at, _) in text.match_indices('_') {
        let unit = text[at + 1..].replace("_per_", "/").replace('_', " ");
        if unit::is_unit(&unit) {
            return header(&text[..at], &unit);
        }
    }
    if let Some((name, unit)) = text.rsplit_once([' ', ','])
        && unit::is_unit(unit)
    {
        return header(name, unit);
    }
    let (name, unit) = text.split_once('/').unwrap_or((text, ""));
    header(name, unit)
}

fn header(name: &str, unit: &str) -> Header {
    let name = name
        .trim_matches([' ', '/', '_', ','])
        .to_lowercase()
        .replace(['_', '-'], " ");
    let letter = GREEK.iter().find(|letter| letter.0 == name);
    Header {
        name: letter.map_or(name.as_str(), |letter| letter.1).to_owned(),
        unit: unit.trim().to_owned(),
    }
}

/// Returns a unit without the brackets around it.
pub(in crate::scene) fn bare(unit: &str) -> &str {
    unit.trim_matches(['[', ']', '(', ')', ' '])
}

impl Header {
    /// Returns the column of the header, whose unit must be one of `quantity`.
    pub(in crate::scene) fn into_column(self, quantity: Quantity) -> Result<Column, String> {
        let Header { name, unit } = self;
        if unit.is_empty() {
            let usual = quantity.usual_unit();
            return Err(format!(
                "the column `{name}` has no unit: write it like `{name} [{usual}]`"
            ));
        }
        let factor = unit::factor(&unit, quantity).map_err(|e| e.to_string())?;
        Ok(Column { factor, unit })
    }
}
