//! Keys of a scene whose numbers are set by a computation.

use std::fmt;
use std::str::FromStr;

use toml::de::{DeTable, DeValue};

use super::Varied;
use super::draft::{Draft, Setting};
use super::path::KeyPath;
use crate::error::Error;
use crate::scene::keys::SECTIONS;
use crate::scene::read::value;
use crate::scene::unit::{self, Uncertain};
use crate::scene::{Problem, Problems, Scene, UncertainValue};

/// A key of a scene that takes a quantity, read from a text like `crank.inertia` or `torque[2].coefficient`.
#[derive(Clone, Copy, Debug)]
pub struct NumberKey(KeyPath);

/// A number, in SI units and radians, for a key.
#[derive(Clone, Copy, Debug)]
pub struct Assigned {
    /// The key.
    pub key: NumberKey,
    /// The number.
    pub value: f64,
}

impl NumberKey {
    /// The SI unit as scene files have it; empty for numbers.
    pub fn unit(&self) -> &'static str {
        self.0.quantity().map_or("", unit::Quantity::si)
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
        let path = KeyPath::parse(text.trim())?;
        match path.quantity() {
            Some(_) => Ok(NumberKey(path)),
            None => Err(format!("`{path}` holds no quantity")),
        }
    }
}

/// The quantity that a key has in a document.
fn quantity(document: &DeTable<'_>, path: &KeyPath) -> Option<Uncertain> {
    let table = match document.get(path.section.name)?.get_ref() {
        DeValue::Array(list) => list.get(path.index)?.get_ref().as_table(),
        other => other.as_table(),
    };
    let text = table?.get(path.key.name)?;
    value::read(path.key, text.get_ref())
        .ok()?
        .number(path.key.kind)
}

impl Draft {
    /// The number that a key has in the file, in SI units and radians.
    ///
    /// # Errors
    /// [`Problems`]: the scene has no such number.
    pub fn number(&self, key: &NumberKey) -> Result<f64, Problems> {
        let (document, _) = DeTable::parse_recoverable(self.text());
        let path = key.0;
        quantity(document.get_ref(), &path)
            .map(|number| number.value)
            .ok_or_else(|| {
                let example = match path.key.example() {
                    text if text.ends_with("\"...\"") => {
                        format!("{} = \"1 {}\"", path.key.name, key.unit())
                    }
                    text => text,
                };
                let help = format!("write a first guess into the scene, like {example}");
                let what = format!("`{key}` has no number in the scene to set out from");
                Problems::in_file(
                    &self.file,
                    self.text(),
                    vec![Problem::new(path.section.name, what, help)],
                )
            })
    }

    /// The values of the file that have a standard error, like `"155.8 +- 0.1 mm"`.
    ///
    /// # Errors
    /// [`Error::Scene`]: the scene is impossible with the error in it, on either side.
    pub fn uncertain(&self) -> Result<Vec<UncertainValue>, Error> {
        let list = self.uncertain_keys().into_iter();
        let list = list.map(|(path, Uncertain { value, error })| {
            let key = NumberKey(path);
            let moved = |value| self.with_numbers(&[Assigned { key, value }]);
            Ok(UncertainValue {
                key: key.to_string(),
                moved: moved(value + error).or_else(|_| moved(value - error))?,
            })
        });
        list.collect()
    }

    /// The values of the file that have a standard error, as normal distributions.
    pub fn tolerances(&self) -> Vec<Varied> {
        let list = self.uncertain_keys().into_iter();
        let list = list.filter_map(|(path, Uncertain { value, error })| {
            let unit = NumberKey(path).unit();
            format!("{path} = {value} +- {error} {unit}").parse().ok()
        });
        list.collect()
    }

    fn uncertain_keys(&self) -> Vec<(KeyPath, Uncertain)> {
        let (document, _) = DeTable::parse_recoverable(self.text());
        let document = document.get_ref();
        let paths = SECTIONS.iter().flat_map(|section| {
            let tables = document.get(section.name);
            let tables = tables.and_then(|tables| tables.get_ref().as_array());
            let count = tables.map_or(1, |list| list.len());
            let keys = move |index| {
                let path = move |key| KeyPath {
                    section,
                    index,
                    key,
                };
                section.keys.iter().map(path)
            };
            (0..count).flat_map(keys)
        });
        let found = paths.filter_map(|path| Some((path, quantity(document, &path)?)));
        found.filter(|(_, found)| found.error > 0.0).collect()
    }

    /// The scene with numbers in place of its own.
    ///
    /// # Errors
    /// [`Error::Scene`]: all that is wrong with the scene that results.
    pub fn with_numbers(&self, numbers: &[Assigned]) -> Result<Scene, Error> {
        let text = |one: &Assigned| format!("{} {}", one.value, one.key.unit());
        let texts: Vec<String> = numbers.iter().map(text).collect();
        let settings = numbers.iter().zip(&texts).map(|(one, text)| Setting {
            path: one.key.0,
            text: text.trim_end(),
            number: Some(one.value),
        });
        Ok(self.with_settings(settings)?)
    }
}
