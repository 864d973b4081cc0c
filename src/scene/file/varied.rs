//! Values of a key that a sweep varies: a list or a distribution.

use std::fmt;
use std::str::FromStr;

use statrs::distribution::{ContinuousCDF, Normal};

use super::evenly::evenly;
use super::key_path::KeyPath;
use super::keys::{Key, Kind};
use super::value;
use crate::scene::unit::{PLUS_MINUS, Uncertain};

/// Key of a scene and the values it takes, parsed from texts like `geometry.offset=0mm:20mm:41`.
///
/// After the key stand the first value, the last one and their number, evenly spaced; with `:log` at the end they are
/// evenly spaced in their logarithm. Alternatively the values stand one by one, separated by commas, as words and
/// formulas must. `geometry.rod=100mm:120mm` is uniformly distributed between two bounds,
/// `geometry.rod=155.8 +- 0.1 mm` is normal with this standard deviation. Keys are those of scene files; a number
/// selects one of several torques or forces, as in `torque[2].value`.
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
    pub(super) path: KeyPath,
    /// Values as written.
    text: String,
    values: Variation,
    /// Whether all values are quantities.
    pub(crate) has_numbers: bool,
}

/// Value that a key of a scene takes.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedValue {
    /// Text in the form of a scene file.
    pub text: String,
    /// Number in SI units and radians; none for words, formulas and files.
    pub number: Option<f64>,
}

#[derive(Clone, Debug)]
enum Variation {
    Listed(Vec<VariedValue>),
    /// Uniform distribution between two numbers, SI.
    Uniform([f64; 2]),
    /// Normal distribution with mean and standard deviation, SI.
    Normal(Normal),
}

impl Varied {
    /// Returns the number of listed values; 1 for a distribution.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        match &self.values {
            Variation::Listed(list) => list.len(),
            _ => 1,
        }
    }

    /// Whether the values are a distribution.
    pub fn is_distribution(&self) -> bool {
        !matches!(self.values, Variation::Listed(_))
    }

    /// Returns the bounds of a uniform distribution, in SI units and radians.
    pub fn bounds(&self) -> Option<[f64; 2]> {
        match self.values {
            Variation::Uniform(bounds) => Some(bounds),
            _ => None,
        }
    }

    /// Returns the SI unit of the values in the form of scene files; empty for numbers and words.
    pub fn unit(&self) -> &'static str {
        self.path.unit()
    }

    /// Returns the key, as `geometry.offset`.
    pub fn key(&self) -> String {
        self.path.to_string()
    }

    /// Returns the key as the name of a column, with the SI unit of its numbers, as `geometry_offset_m`.
    pub fn column(&self) -> String {
        let name = self.key().replace('[', "_");
        let name = name.replace("].", "_").replace('.', "_");
        match self.path.key.kind.quantity() {
            Some(quantity) if self.has_numbers => quantity.column(&name),
            _ => name,
        }
    }

    /// Returns a listed value, or the median of a distribution.
    ///
    /// # Panics
    /// If `index` is not below the number of listed values.
    pub fn value(&self, index: usize) -> VariedValue {
        match &self.values {
            Variation::Listed(list) => list[index].clone(),
            _ => self.quantile(0.5),
        }
    }

    /// Returns the `p` quantile of a distribution, 0 < p < 1; listed values are equally likely.
    pub fn quantile(&self, p: f64) -> VariedValue {
        let number = match &self.values {
            Variation::Listed(list) => return list[(p * list.len() as f64) as usize].clone(),
            Variation::Uniform([low, high]) => low + p * (high - low),
            Variation::Normal(normal) => normal.inverse_cdf(p),
        };
        VariedValue::of(number, self.unit())
    }
}

impl VariedValue {
    pub(super) fn read(key: &Key, text: String) -> Result<VariedValue, String> {
        let number = number(key, &text)?.map(|number| number.value);
        Ok(VariedValue { text, number })
    }

    /// Creates a value from a number in SI units and radians.
    pub(super) fn of(number: f64, unit: &str) -> VariedValue {
        VariedValue {
            text: format!("{number} {unit}").trim_end().to_owned(),
            number: Some(number),
        }
    }
}

/// Writes the values as given.
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
        let path: KeyPath = key.trim().parse()?;
        let text = values.trim().to_owned();
        let values = read(path.key, values)?;
        let has_numbers = match &values {
            Variation::Listed(list) => list.iter().all(|value| value.number.is_some()),
            Variation::Uniform(_) | Variation::Normal(_) => true,
        };
        Ok(Varied {
            path,
            text,
            values,
            has_numbers,
        })
    }
}

/// Parses `0mm:20mm:41`, `1:100:5:log`, `150 mm, 155.83 mm`, or the distributions `0mm:20mm` and `155.8 +- 0.1 mm`.
fn read(key: &Key, text: &str) -> Result<Variation, String> {
    let fields: Vec<&str> = text.split(':').map(str::trim).collect();
    let texts = match (fields.as_slice(), key.kind) {
        (_, Kind::Text) => listed(text),
        ([one], _) if PLUS_MINUS.iter().any(|sign| one.contains(sign)) => {
            let normal = number(key, one)?.and_then(|n| Normal::new(n.value, n.error).ok());
            return normal
                .map(Variation::Normal)
                .ok_or_else(|| format!("`{one}` is no number with a standard deviation above 0"));
        }
        ([_], _) => listed(text),
        ([low, high], _) => {
            let bound = |text: &str| {
                let number = number(key, text)?.ok_or_else(|| format!("`{text}` is no number"));
                number.map(|number| number.value)
            };
            let (from, to) = (bound(low)?, bound(high)?);
            return match from < to {
                true => Ok(Variation::Uniform([from, to])),
                false => Err(format!("`{low}` is not less than `{high}`")),
            };
        }
        ([from, to, count], _) => {
            return evenly(key, [from, to], count, false).map(Variation::Listed);
        }
        ([from, to, count, "log"], _) => {
            return evenly(key, [from, to], count, true).map(Variation::Listed);
        }
        _ => {
            return Err(format!(
                "`{text}` is no range; write first, last and count, like 0mm:20mm:41 or 1mm:100mm:7:log"
            ));
        }
    };
    let values = texts.into_iter().map(|text| VariedValue::read(key, text));
    Ok(Variation::Listed(values.collect::<Result<_, _>>()?))
}

/// Reads a text as the quantity of a key, if the key takes one.
fn number(key: &Key, text: &str) -> Result<Option<Uncertain>, String> {
    let value = value::read_text(key, text).map_err(|error| error.to_string())?;
    match text {
        "" => Err(format!("a value of `{}` is empty", key.name)),
        _ => Ok(value.number(key.kind)),
    }
}

/// Splits values at commas, except those in brackets, as in `max(1, omega)`.
fn listed(text: &str) -> Vec<String> {
    let mut depth = 0;
    let parts = text.split(|c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    });
    parts.map(|part| part.trim().to_owned()).collect()
}
