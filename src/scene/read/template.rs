//! A scene file that is read once, for scenes that differ in some values.

use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::value::{self, Value};
use super::{Reader, Values};
use crate::scene::keys::Kind;
use crate::scene::places::Places;
use crate::scene::unit::Uncertain;
use crate::scene::vary::Setting;
use crate::scene::{Scene, assemble, validate};

/// The values of a scene file without a mistake.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Template {
    title: Option<String>,
    tables: Vec<Values>,
    folder: PathBuf,
    places: Places,
}

impl Template {
    /// None if anything is wrong with the file.
    pub fn new(file: &Path, source: &str) -> Option<Template> {
        let (document, errors) = DeTable::parse_recoverable(source);
        let mut reader = Reader::new(source);
        let (title, mut tables) = super::tables(&mut reader, document.get_ref());
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        let scene = assemble::scene(&mut reader, title.clone(), &tables, &folder);
        validate::problems(&scene, &mut reader.problems);
        let (problems, spans) = reader.located();
        let (mut torques, mut forces) = (scene.torques.into_iter(), scene.forces.into_iter());
        for values in &mut tables {
            values.load = match values.section.name {
                "torque" => torques.next(),
                "force" => forces.next(),
                _ => None,
            };
        }
        (errors.is_empty() && problems.is_empty()).then(|| Template {
            title,
            tables,
            folder,
            places: Places::in_file(file, source, spans),
        })
    }

    /// The scene with keys set; none if anything is wrong with it, of which reading the text again tells.
    pub fn with<'a>(&self, settings: impl Iterator<Item = Setting<'a>>) -> Option<Scene> {
        let mut tables = self.tables.clone();
        for Setting { path, text, number } in settings {
            let mut of_section = tables
                .iter_mut()
                .filter(|values| values.section.name == path.section.name);
            let values = of_section.nth(path.index)?;
            let value = match (number, path.key.kind) {
                (Some(value), Kind::Of(_)) => Value::Number(Uncertain { value, error: 0.0 }),
                _ => value::read(path.key, &DeValue::String(text.into())).ok()?,
            };
            values.set(path.key, value);
            if path.key.name == "branch" {
                // Gas pushes towards the crank.
                tables.iter_mut().for_each(|values| values.load = None);
            }
        }
        let mut reader = Reader::new("");
        let mut scene = assemble::scene(&mut reader, self.title.clone(), &tables, &self.folder);
        validate::problems(&scene, &mut reader.problems);
        scene.places = self.places.clone();
        reader.problems.is_empty().then_some(scene)
    }
}
