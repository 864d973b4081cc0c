//! The text of a scene file, from which scenes with other values are made.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_edit::{DocumentMut, Item, TomlError, Value};

use super::{KeyPath, Varied, VariedValue};
use crate::error::Error;
use crate::scene::read::{self, Template};
use crate::scene::{DUARTE, Problem, Problems, Scene, text};

/// A scene file whose values may be replaced before it is read.
///
/// ```
/// use slider_crank::scene::{Draft, Varied};
/// let draft = Draft::duarte();
/// let rod: Varied = "geometry.rod = 150mm:160mm:3".parse().unwrap();
/// let scene = draft.with([(&rod, "155 mm")]).unwrap();
/// assert_eq!(scene.geometry.rod, 0.155);
/// ```
#[derive(Clone, Debug)]
pub struct Draft {
    pub(super) file: PathBuf,
    text: String,
    template: OnceLock<Option<Template>>,
}

impl Draft {
    /// From the text of a scene file; `file` is its name in messages and the place from which the tables it
    /// names are found.
    pub fn new(file: &Path, text: impl Into<String>) -> Draft {
        Draft {
            file: file.to_owned(),
            text: text.into(),
            template: OnceLock::new(),
        }
    }

    /// Reads the text of a scene file; `-` is standard input.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read, [`Error::Scene`] if it is no text.
    pub fn load(file: &Path) -> Result<Draft, Error> {
        let text = text::decoded(text::bytes(file)?).map_err(|what| {
            let help = "save the scene as plain text in UTF-8";
            Problems::in_file(file, "", vec![Problem::new("", what, help)])
        })?;
        Ok(Draft::new(file, text))
    }

    /// The file of the built-in scene.
    pub fn duarte() -> Draft {
        Draft::new(Path::new("duarte-engine.toml"), DUARTE)
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the scene has the table that a varied key belongs to, or a place for it.
    ///
    /// # Errors
    /// [`Problems`]: the scene has fewer tables of this name.
    pub fn takes(&self, varied: &Varied) -> Result<(), Problems> {
        let (mut document, _) = DeTable::parse_recoverable(&self.text);
        let text = varied.value(0).text;
        let applied = varied.setting(&text).apply(document.get_mut());
        applied.map_err(|problem| Problems::in_file(&self.file, &self.text, vec![problem]))
    }

    /// The text with values in place of its own, or beside them; all else stays as it is written.
    ///
    /// # Errors
    /// [`Problems`]: the text is no TOML, or has fewer tables of a name than a key says.
    pub fn text_with<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Varied, &'a str)>,
    ) -> Result<String, Problems> {
        let mut document: DocumentMut = self.text.parse().map_err(|error: TomlError| {
            let help = "correct what `check` says of the scene";
            let problem = Problem::new("", error.message(), help);
            Problems::in_file(&self.file, &self.text, vec![problem])
        })?;
        for (varied, text) in values {
            self.takes(varied)?;
            let KeyPath {
                section,
                index,
                key,
            } = varied.path;
            let table = &mut document[section.name];
            let table = match section.repeated {
                true => &mut table[index],
                false => table,
            };
            let decor = table.get(key.name).and_then(Item::as_value);
            let decor = decor.map(|old| old.decor().clone());
            let mut value = Value::from(text);
            if let Some(decor) = decor {
                *value.decor_mut() = decor;
            }
            table[key.name] = Item::Value(value);
        }
        Ok(document.to_string())
    }

    /// The scene as it is written.
    ///
    /// # Errors
    /// [`Problems`]: all that is wrong, with its places.
    pub fn scene(&self) -> Result<Scene, Problems> {
        self.with([])
    }

    /// The scene with the texts of values in place of its own, or beside them.
    ///
    /// # Errors
    /// [`Problems`]: all that is wrong with the scene that results.
    pub fn with<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Varied, &'a str), IntoIter: Clone>,
    ) -> Result<Scene, Problems> {
        let values = values.into_iter();
        self.with_settings(values.map(|(varied, text)| varied.setting(text)))
    }

    /// The scene with values in place of its own, or beside them.
    ///
    /// # Errors
    /// [`Problems`]: all that is wrong with the scene that results.
    pub fn with_values(
        &self,
        varied: &[Varied],
        values: &[VariedValue],
    ) -> Result<Scene, Problems> {
        let pairs = varied.iter().zip(values);
        self.with_settings(pairs.map(|(varied, value)| Setting {
            number: value.number,
            ..varied.setting(&value.text)
        }))
    }

    /// The scene with keys set.
    pub(super) fn with_settings<'a>(
        &'a self,
        settings: impl Iterator<Item = Setting<'a>> + Clone,
    ) -> Result<Scene, Problems> {
        let template = self
            .template
            .get_or_init(|| Template::new(&self.file, &self.text));
        let scene = template.as_ref().and_then(|one| one.with(settings.clone()));
        scene.map_or_else(|| read::scene(&self.file, &self.text, settings), Ok)
    }
}

/// A value in place of the one in the file.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Setting<'a> {
    pub path: KeyPath,
    pub text: &'a str,
    /// The quantity that the text says, SI, where it is known.
    pub number: Option<f64>,
}

impl<'a> Setting<'a> {
    /// Writes the value into the document, with its table if that is not there.
    ///
    /// # Errors
    /// If the scene has fewer tables of this name.
    pub fn apply(self, document: &mut DeTable<'a>) -> Result<(), Problem> {
        let (section, key) = (self.path.section, self.path.key);
        let table = document
            .entry(nowhere(section.name.into()))
            .or_insert_with(|| {
                nowhere(match section.repeated {
                    true => DeValue::Array(Default::default()),
                    false => DeValue::Table(Default::default()),
                })
            });
        let mut table = table.get_mut();
        if let DeValue::Array(list) = table {
            let count = list.len();
            let found = list.get_mut(self.path.index);
            table = found.ok_or_else(|| self.no_table(count))?.get_mut();
        }
        // What is no table is left for the reader to complain of.
        if let DeValue::Table(table) = table {
            let value = DeValue::String(self.text.into());
            let old = table.get(key.name);
            let span = old.map_or(0..0, Spanned::span);
            table.insert(nowhere(key.name.into()), Spanned::new(span, value));
        }
        Ok(())
    }

    fn no_table(&self, count: usize) -> Problem {
        let name = self.path.section.name;
        let what = format!(
            "`{}` cannot be set: tables [[{name}]] in the scene: {count}",
            self.path
        );
        Problem::new(
            name,
            what,
            format!("add a [[{name}]] with its kind to the scene"),
        )
    }
}

/// What does not stand in the file.
fn nowhere<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}
