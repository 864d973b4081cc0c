//! Scene files with other values: what a sweep varies.

mod draft;
mod free;
mod path;
mod values;

use std::fmt;
use std::str::FromStr;

use super::unit::Quantity;
pub use draft::Draft;
pub(super) use draft::Setting;
pub use free::{Assigned, NumberKey};
use path::KeyPath;
use values::Values;
pub use values::VariedValue;

/// A key of a scene and the values it takes, read from texts like `geometry.offset=0mm:20mm:41`.
///
/// After the key stand the first value, the last one and their number, evenly spread; with `:log` at the end
/// they are spread evenly in their logarithm. Or the values stand one by one, with commas between them, which
/// is the way for words and formulas. `geometry.rod=100mm:120mm` is spread evenly between two bounds at random,
/// `geometry.rod=155.8 +- 0.1 mm` is normal with this standard deviation. Keys are those of scene files; of several
/// torques or forces the number tells which, as in `torque[2].value`.
///
/// ```
/// use slider_crank::scene::Varied;
/// let offset: Varied = "geometry.offset = 0mm:20mm:41".parse().unwrap();
/// assert_eq!(offset.len(), 41);
/// assert_eq!(offset.value(1).text, "0.5 mm");
/// assert_eq!(offset.value(1).number, Some(0.0005));
/// assert_eq!(offset.column(), "geometry_offset_m");
/// let model: Varied = "rod.model = rigid, two-mass".parse().unwrap();
/// assert_eq!(model.value(1).text, "two-mass");
/// let rod: Varied = "geometry.rod = 155.8 +- 0.1 mm".parse().unwrap();
/// assert!((rod.quantile(0.975).number.unwrap() - 0.155995996398454).abs() < 1e-12);
/// assert!("geometry.ofset=0mm:20mm:41".parse::<Varied>().is_err());
/// ```
#[derive(Clone, Debug)]
pub struct Varied {
    path: KeyPath,
    text: String,
    values: Values,
    /// Whether all values are quantities.
    has_numbers: bool,
}

impl Varied {
    /// Number of values that are listed; one of a distribution.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        match &self.values {
            Values::Listed(list) => list.len(),
            Values::Uniform(_) | Values::Normal(_) => 1,
        }
    }

    /// Whether the values are random.
    pub fn is_distribution(&self) -> bool {
        !matches!(self.values, Values::Listed(_))
    }

    /// The bounds of an even distribution, in SI units and radians.
    pub fn bounds(&self) -> Option<[f64; 2]> {
        match self.values {
            Values::Uniform(bounds) => Some(bounds),
            Values::Listed(_) | Values::Normal(_) => None,
        }
    }

    /// The SI unit of the values as scene files have it; empty for numbers and words.
    pub fn unit(&self) -> &'static str {
        self.path.quantity().map_or("", Quantity::si)
    }

    /// Whether all values are quantities.
    pub fn has_numbers(&self) -> bool {
        self.has_numbers
    }

    /// The key, as `geometry.offset`.
    pub fn key(&self) -> String {
        self.path.to_string()
    }

    /// The key as the name of a column, with the SI unit of its numbers, as `geometry_offset_m`.
    pub fn column(&self) -> String {
        let name = self.path.column();
        match self.path.quantity().map(Quantity::column) {
            Some(unit) if self.has_numbers() && !unit.is_empty() => format!("{name}_{unit}"),
            _ => name,
        }
    }

    /// A listed value; the median of a distribution.
    ///
    /// # Panics
    /// If there is no value of this index, as slices do.
    pub fn value(&self, index: usize) -> VariedValue {
        match &self.values {
            Values::Listed(list) => list[index].clone(),
            Values::Uniform(_) | Values::Normal(_) => self.quantile(0.5),
        }
    }

    /// The value below which a part `p` of a distribution lies, with 0 < p < 1; listed values are equally likely.
    pub fn quantile(&self, p: f64) -> VariedValue {
        self.values.quantile(p, self.unit())
    }

    /// The key set to the text of a value.
    pub(super) fn setting<'a>(&self, text: &'a str) -> Setting<'a> {
        Setting {
            path: self.path,
            text,
            number: None,
        }
    }
}

/// The values as they are written.
impl fmt::Display for Varied {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl FromStr for Varied {
    type Err = String;

    fn from_str(text: &str) -> Result<Varied, String> {
        let (key, values) = text.split_once('=').ok_or_else(|| {
            format!("`{text}` has no values; write it like geometry.offset=0mm:20mm:41")
        })?;
        let path = KeyPath::parse(key.trim())?;
        let text = values.trim().to_owned();
        let values = values::read(path.key, values)?;
        Ok(Varied {
            path,
            text,
            has_numbers: values.are_numbers(),
            values,
        })
    }
}
