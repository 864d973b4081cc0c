//! Scene files with other values: what a sweep varies.

mod draft;
mod free;
mod path;
mod values;

use std::str::FromStr;

use super::unit::Quantity;
pub use draft::Draft;
pub(super) use draft::Setting;
pub use free::{Assigned, NumberKey};
use path::KeyPath;

/// A key of a scene and the values it takes, read from texts like `geometry.offset=0mm:20mm:41`.
///
/// After the key stand the first value, the last one and their number, evenly spread; with `:log` at the end
/// they are spread evenly in their logarithm. Or the values stand one by one, with commas between them, which
/// is the way for words and formulas. Keys are those of scene files; of several torques or forces the number
/// tells which, as in `torque[2].value`.
///
/// ```
/// use slider_crank::scene::Varied;
/// let offset: Varied = "geometry.offset = 0mm:20mm:41".parse().unwrap();
/// assert_eq!(offset.len(), 41);
/// assert_eq!((offset.text(1), offset.number(1)), ("0.5 mm", Some(0.0005)));
/// assert_eq!(offset.column(), "geometry_offset_m");
/// let model: Varied = "rod.model = rigid, two-mass".parse().unwrap();
/// assert_eq!((model.text(1), model.number(1)), ("two-mass", None));
/// assert!("geometry.ofset=0mm:20mm:41".parse::<Varied>().is_err());
/// ```
#[derive(Clone, Debug)]
pub struct Varied {
    path: KeyPath,
    values: Vec<values::Value>,
    /// Whether all values are quantities.
    numbers: bool,
}

impl Varied {
    /// Number of values, at least one.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The key, as `geometry.offset`.
    pub fn key(&self) -> String {
        self.path.to_string()
    }

    /// The key as the name of a column, with the SI unit of its numbers, as `geometry_offset_m`.
    pub fn column(&self) -> String {
        let name = self.path.column();
        match self.path.quantity().map(Quantity::column) {
            Some(unit) if self.numbers && !unit.is_empty() => format!("{name}_{unit}"),
            _ => name,
        }
    }

    /// A value as a scene file has it.
    ///
    /// # Panics
    /// If there is no value of this index, as slices do.
    pub fn text(&self, index: usize) -> &str {
        &self.values[index].text
    }

    /// A value in SI units and radians; none for words, formulas and files.
    ///
    /// # Panics
    /// If there is no value of this index, as slices do.
    pub fn number(&self, index: usize) -> Option<f64> {
        self.values[index].number.filter(|_| self.numbers)
    }

    /// The key set to a value.
    pub(super) fn setting(&self, index: usize) -> Setting<'_> {
        Setting {
            path: self.path,
            text: self.text(index),
        }
    }
}

impl FromStr for Varied {
    type Err = String;

    fn from_str(text: &str) -> Result<Varied, String> {
        let (key, values) = text.split_once('=').ok_or_else(|| {
            format!("`{text}` has no values; write it like geometry.offset=0mm:20mm:41")
        })?;
        let path = KeyPath::parse(key.trim())?;
        let values = values::read(path.key, values)?;
        Ok(Varied {
            path,
            numbers: values.iter().all(|value| value.number.is_some()),
            values,
        })
    }
}
