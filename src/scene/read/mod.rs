//! Scene files: TOML to [`Scene`], with the place of everything that is wrong.

mod reader;
mod template;
pub(super) mod value;
mod values;

use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{self, Section};
use super::places::Places;
use super::vary::Setting;
use super::{Problem, Problems, Scene, assemble, validate};
pub(super) use reader::Reader;
pub(super) use template::Template;
pub(super) use values::Values;

/// Reads the text of a scene file, with these values in place of its own; tables it names are looked for
/// beside it.
pub(super) fn scene<'a>(
    file: &Path,
    source: &'a str,
    settings: impl Iterator<Item = Setting<'a>>,
) -> Result<Scene, Problems> {
    let (mut document, errors) = DeTable::parse_recoverable(source);
    if !errors.is_empty() {
        let problem = |error: &toml::de::Error| Problem {
            field: "syntax".to_owned(),
            span: error.span(),
            what: format!("not TOML: {}", error.message()),
            help: "tables are `[geometry]`, values are `key = \"47 mm\"`".to_owned(),
        };
        let problems = errors.iter().map(problem).collect();
        return Err(Problems::in_file(file, source, problems));
    }
    let mut reader = Reader::new(source);
    for setting in settings {
        let applied = setting.apply(document.get_mut());
        reader.problems.extend(applied.err());
    }
    let (title, tables) = tables(&mut reader, document.get_ref());
    let folder = file.parent().unwrap_or(Path::new(""));
    let mut scene = assemble::scene(&mut reader, title, &tables, folder);
    validate::problems(&scene, &mut reader.problems);
    let (problems, spans) = reader.located();
    if problems.is_empty() {
        scene.places = Places::in_file(file, source, spans);
        Ok(scene)
    } else {
        Err(Problems::in_file(file, source, problems))
    }
}

fn tables(reader: &mut Reader, document: &DeTable<'_>) -> (Option<String>, Vec<Values>) {
    let mut title = None;
    let mut found = Vec::new();
    for (key, value) in document.iter() {
        let name = key.get_ref().as_ref();
        reader.found(name, key.span());
        if name == "title" {
            title = value.get_ref().as_str().map(str::to_owned);
            if title.is_none() {
                reader.problem("title", "the title is not a text", "write title = \"...\"");
            }
            continue;
        }
        match keys::section(name) {
            Some(section) => found.extend(section_values(reader, section, value)),
            None => {
                let known = keys::SECTIONS.iter().map(|s| s.name).chain(["title"]);
                let help = keys::did_you_mean(name, "a scene", known);
                reader.problem(name, format!("`{name}` is not part of a scene"), help);
            }
        }
    }
    (title, found)
}

/// The tables of one section: one, or each `[[name]]`.
fn section_values(
    reader: &mut Reader,
    section: &'static Section,
    value: &Spanned<DeValue<'_>>,
) -> Vec<Values> {
    let name = section.name;
    match (value.get_ref(), section.repeated) {
        (DeValue::Table(table), false) => {
            vec![Values::read(reader, section, name.to_owned(), table)]
        }
        (DeValue::Array(array), true) if array.iter().all(|item| item.get_ref().is_table()) => {
            let mut found = Vec::new();
            for (i, item) in array.iter().enumerate() {
                let path = format!("{name}[{}]", i + 1);
                reader.found(&path, item.span());
                if let DeValue::Table(table) = item.get_ref() {
                    found.push(Values::read(reader, section, path, table));
                }
            }
            found
        }
        (_, true) => {
            let what = format!("`{name}` must be a list of tables");
            reader.problem(name, what, format!("begin each {name} with [[{name}]]"));
            Vec::new()
        }
        (_, false) => {
            let what = format!("`{name}` must be a table");
            reader.problem(name, what, format!("begin it with [{name}], once"));
            Vec::new()
        }
    }
}
