//! Scene file as text, from which scenes with other values are made.

use std::path::Path;
use std::sync::Arc;

use toml::de::DeTable;
use toml_edit::{DocumentMut, Item, TomlError, Value};

use super::key_path::KeyPath;
use super::keys::{SECTIONS, Tables};
use super::read::Contents;
use super::{NumberKey, Varied, VariedValue, assemble};
use crate::error::Error;
use crate::scene::check::Check;
use crate::scene::problem::Source;
use crate::scene::unit::Uncertain;
use crate::scene::{MovedScene, Places, Problem, Problems, Scene, text, validate};

/// Scene file of the engine of Duarte et al. 2018, table 1, spinning freely; the default of commands without a scene.
pub const DUARTE: &str = include_str!("../../../data/duarte-engine.toml");

/// Scene file whose values may be replaced before it becomes a scene.
///
/// ```
/// use slider_crank::scene::{Draft, Varied};
/// let draft = Draft::duarte();
/// let rod: Varied = "geometry.rod = 150mm:160mm:3".parse().unwrap();
/// let values = [rod.value(1)];
/// let scene = draft.with_values(&[rod], &values).unwrap();
/// assert_eq!(scene.geometry.rod, 0.155);
/// ```
#[derive(Clone, Debug)]
pub struct Draft {
    contents: Contents,
    is_toml: bool,
    places: Places,
}

/// Number for a key, in SI units and radians.
#[derive(Clone, Copy, Debug)]
pub struct Assigned {
    /// Key of the number.
    pub key: NumberKey,
    /// Value in SI units and radians.
    pub value: f64,
}

impl Draft {
    /// Reads the text of a scene file; `file` is its name in messages, and the tables it names are relative to the
    /// folder of `file`.
    pub fn new(file: &Path, text: impl Into<String>) -> Draft {
        let text = text.into();
        let (document, errors) = DeTable::parse_recoverable(&text);
        let mut contents = match errors.is_empty() {
            true => Contents::of(document.get_ref()),
            false => Contents::default(),
        };
        contents.problems.extend(errors.iter().map(|error| {
            let what = format!("not TOML: {}", error.message());
            let help = "tables are `[geometry]`, values are `key = \"47 mm\"`";
            Problem::new("syntax", what, help).at(error.span())
        }));
        let is_toml = errors.is_empty();
        let (file, spans) = (file.to_owned(), std::mem::take(&mut contents.spans));
        Draft {
            contents,
            is_toml,
            places: Places(Some(Arc::new(Source { file, text, spans }))),
        }
    }

    /// Reads a scene file; `-` is standard input.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read, [`Error::Scene`] if it is not UTF-8 text.
    pub fn load(file: &Path) -> Result<Draft, Error> {
        let text = text::decoded(text::bytes(file)?).map_err(|what| {
            let help = "save the scene as plain text in UTF-8";
            Problems::in_file(file, "", vec![Problem::new("", what, help)])
        })?;
        Ok(Draft::new(file, text))
    }

    /// Returns the draft of the built-in scene.
    pub fn duarte() -> Draft {
        Draft::new(Path::new("duarte-engine.toml"), DUARTE)
    }

    /// Returns the text of the file.
    pub fn text(&self) -> &str {
        self.places.0.as_ref().map_or("", |source| &source.text)
    }

    /// Checks that the scene has the table of a varied key, or can add it.
    ///
    /// # Errors
    /// [`Problems`] if the scene has fewer tables of this name.
    pub fn takes(&self, varied: &Varied) -> Result<(), Problems> {
        let place = self.contents.clone().table(&varied.path).map(|_| ());
        place.map_err(|problem| self.places.problems(vec![problem]))
    }

    /// Returns the text with values replaced or added; all else stays as written.
    ///
    /// # Errors
    /// [`Problems`] if the text is not TOML, or has fewer tables of a name than a key says.
    pub fn text_with<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Varied, &'a str)>,
    ) -> Result<String, Problems> {
        let mut document: DocumentMut = self.text().parse().map_err(|error: TomlError| {
            let help = "correct what `check` says of the scene";
            let problem = Problem::new("", error.message(), help);
            self.places.problems(vec![problem])
        })?;
        for (varied, text) in values {
            self.takes(varied)?;
            let (path, key) = (varied.path, varied.path.key.name);
            let table = &mut document[path.section.name];
            let table = match path.section.tables {
                Tables::Many => &mut table[path.index],
                Tables::One => table,
            };
            let mut value = Value::from(text);
            if let Some(old) = table.get(key).and_then(Item::as_value) {
                *value.decor_mut() = old.decor().clone();
            }
            table[key] = Item::Value(value);
        }
        Ok(document.to_string())
    }

    /// Returns the scene as written.
    ///
    /// # Errors
    /// [`Problems`] of the file, with their places.
    pub fn scene(&self) -> Result<Scene, Problems> {
        self.with_values(&[], &[])
    }

    /// Returns the scene with values replaced or added.
    ///
    /// # Errors
    /// [`Problems`] of the resulting scene.
    pub fn with_values(
        &self,
        varied: &[Varied],
        values: &[VariedValue],
    ) -> Result<Scene, Problems> {
        self.with(varied.iter().map(|one| one.path).zip(values))
    }

    /// Returns the scene with numbers replaced or added.
    ///
    /// # Errors
    /// [`Error::Scene`] with the problems of the resulting scene.
    pub fn with_numbers(&self, numbers: &[Assigned]) -> Result<Scene, Error> {
        let value = |one: &Assigned| VariedValue::of(one.value, one.key.unit());
        let values: Vec<VariedValue> = numbers.iter().map(value).collect();
        Ok(self.with(numbers.iter().map(|one| one.key.0).zip(&values))?)
    }

    fn with<'a>(
        &self,
        values: impl Iterator<Item = (KeyPath, &'a VariedValue)>,
    ) -> Result<Scene, Problems> {
        let mut contents = self.contents.clone();
        let mut check = Check {
            problems: std::mem::take(&mut contents.problems),
            places: &self.places,
        };
        if !self.is_toml {
            return Err(self.places.problems(check.problems));
        }
        for (path, value) in values {
            contents.set(&mut check, path, value);
        }
        let mut scene = assemble::scene(&mut check, contents);
        validate::problems(&scene, &mut check);
        check.places.reject_any(check.problems)?;
        scene.places = self.places.clone();
        Ok(scene)
    }

    /// Returns the number of a key in the file, in SI units and radians.
    ///
    /// # Errors
    /// [`Problems`] if the scene has no number for the key.
    pub fn number(&self, key: &NumberKey) -> Result<f64, Problems> {
        let path = key.0;
        let values = self.contents.of_section(path.section).nth(path.index);
        let number = values.and_then(|values| values.uncertain(path.key));
        number.map(|number| number.value).ok_or_else(|| {
            let example = match path.key.example() {
                text if text.ends_with("\"...\"") => {
                    format!("{} = \"1 {}\"", path.key.name, key.unit())
                }
                text => text,
            };
            let help = format!("write a first guess into the scene, like {example}");
            let what = format!("`{key}` has no number in the scene to set out from");
            let problem = Problem::new(path.section.name, what, help);
            self.places.problems(vec![problem])
        })
    }

    /// Returns the values of the file that have a standard error, like `"155.8 +- 0.1 mm"`, as scenes moved by it.
    ///
    /// # Errors
    /// [`Error::Scene`] if a value makes the scene impossible when moved by its error to either side.
    pub fn uncertain(&self) -> Result<Vec<MovedScene>, Error> {
        let list = self.uncertain_keys().into_iter();
        let list = list.map(|(path, Uncertain { value, error })| {
            let key = NumberKey(path);
            let moved = |value| self.with_numbers(&[Assigned { key, value }]);
            Ok(MovedScene {
                key: key.to_string(),
                moved: moved(value + error).or_else(|_| moved(value - error))?,
            })
        });
        list.collect()
    }

    /// Returns the values of the file that have a standard error, as normal distributions.
    pub fn tolerances(&self) -> Vec<Varied> {
        let list = self.uncertain_keys().into_iter();
        let list = list.filter_map(|(path, Uncertain { value, error })| {
            let unit = NumberKey(path).unit();
            format!("{path} = {value} +- {error} {unit}").parse().ok()
        });
        list.collect()
    }

    /// Returns the keys of the file that have a number.
    pub fn number_keys(&self) -> impl Iterator<Item = NumberKey> {
        self.numbers().into_iter().map(|(path, _)| NumberKey(path))
    }

    fn uncertain_keys(&self) -> Vec<(KeyPath, Uncertain)> {
        let mut found = self.numbers();
        found.retain(|(_, number)| number.error > 0.0);
        found
    }

    fn numbers(&self) -> Vec<(KeyPath, Uncertain)> {
        let mut found = Vec::new();
        for section in SECTIONS {
            for (index, values) in self.contents.of_section(section).enumerate() {
                found.extend(section.keys.iter().filter_map(|key| {
                    let path = KeyPath {
                        section,
                        index,
                        key,
                    };
                    Some((path, values.uncertain(key)?))
                }));
            }
        }
        found
    }
}
