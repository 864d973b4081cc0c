//! Reads scene files: takes TOML, returns the values of each table, and the problems with their places.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use toml::de::{DeTable, DeValue};

use super::VariedValue;
use super::key_path::{KeyPath, did_you_mean};
use super::keys::{self, Key, Kind, Section, Tables};
use super::value::{self, Value};
use crate::scene::check::Check;
use crate::scene::problem::Spans;
use crate::scene::unit::Uncertain;
use crate::scene::{Every, Load, Problem};

/// Values of one table that could be read, by key.
#[derive(Clone, Debug)]
pub(super) struct Values {
    pub section: &'static Section,
    /// Load of the table, set once it is known to have no problem.
    pub load: OnceLock<Load>,
    path: String,
    entries: Vec<(&'static str, Value)>,
}

impl Values {
    pub fn new(section: &'static Section, path: String) -> Values {
        Values {
            section,
            load: OnceLock::new(),
            path,
            entries: Vec::new(),
        }
    }

    /// Sets the value of a key; none, for a value that could not be read, removes it.
    pub fn set(&mut self, key: &'static Key, value: Option<Value>) {
        self.load = OnceLock::new();
        self.entries.retain(|(name, _)| *name != key.name);
        self.entries.extend(value.map(|value| (key.name, value)));
    }

    fn get(&self, key: &str) -> Option<&Value> {
        let entry = self.entries.iter().find(|(name, _)| *name == key);
        entry.map(|(_, value)| value)
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        match self.get(key) {
            Some(Value::Number(number)) => Some(number.value),
            _ => None,
        }
    }

    /// Returns the quantity of a key with its standard error, also where a formula may stand.
    pub fn uncertain(&self, key: &Key) -> Option<Uncertain> {
        self.get(key.name)?.number(key.kind)
    }

    /// Returns a text or the word of a choice.
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.get(key) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// Returns the value whose name is the word of a choice.
    pub fn choice<T>(&self, key: &str, named: fn(&str) -> Option<T>) -> Option<T> {
        self.text(key).and_then(named)
    }

    /// Returns a number without quotes, where a quantity or a formula may stand.
    pub fn bare(&self, key: &str) -> Option<&str> {
        match self.get(key) {
            Some(Value::Bare(digits)) => Some(digits),
            _ => None,
        }
    }

    pub fn every(&self, key: &str) -> Option<Every> {
        match self.get(key) {
            Some(Value::Every(every)) => Some(*every),
            _ => None,
        }
    }

    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    pub fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.entries.iter().map(|(name, _)| *name)
    }

    /// Returns the name of a key in problems, as `torque[1].value`.
    pub fn field(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }
}

/// Contents of a document, as far as it could be read.
#[derive(Clone, Debug, Default)]
pub(super) struct Contents {
    pub title: Option<String>,
    pub tables: Vec<Arc<Values>>,
    pub problems: Vec<Problem>,
    /// Byte ranges of keys and tables.
    pub spans: Spans,
}

impl Contents {
    pub fn of(document: &DeTable<'_>) -> Contents {
        let mut found = Contents::default();
        for (key, value) in document.iter() {
            let name = key.get_ref().as_ref();
            found.spans.insert(name.to_owned(), key.span());
            if name == "title" {
                found.title = value.get_ref().as_str().map(str::to_owned);
                if found.title.is_none() {
                    found.problem(name, "the title is not a text", "write title = \"...\"");
                }
            } else if let Some(section) = keys::section(name) {
                found.section(section, value.get_ref());
            } else {
                let known = keys::SECTIONS.iter().map(|s| s.name).chain(["title"]);
                let help = did_you_mean(name, "a scene", known);
                found.problem(name, format!("`{name}` is not part of a scene"), help);
            }
        }
        found
    }

    fn problem(&mut self, field: &str, what: impl Into<String>, help: impl Into<String>) {
        self.problems.push(Problem::new(field, what, help));
    }

    /// Reads the tables of one section: one, or each `[[name]]`.
    fn section(&mut self, section: &'static Section, value: &DeValue<'_>) {
        let name = section.name;
        match (value, section.tables) {
            (DeValue::Table(table), Tables::One) => self.read(section, name.to_owned(), table),
            (DeValue::Array(array), Tables::Many)
                if array.iter().all(|item| item.get_ref().is_table()) =>
            {
                for (i, item) in array.iter().enumerate() {
                    let path = format!("{name}[{}]", i + 1);
                    self.spans.insert(path.clone(), item.span());
                    if let DeValue::Table(table) = item.get_ref() {
                        self.read(section, path, table);
                    }
                }
            }
            (_, Tables::Many) => {
                let what = format!("`{name}` must be a list of tables");
                self.problem(name, what, format!("begin each {name} with [[{name}]]"));
            }
            (_, Tables::One) => {
                let what = format!("`{name}` must be a table");
                self.problem(name, what, format!("begin it with [{name}], once"));
            }
        }
    }

    fn read(&mut self, section: &'static Section, path: String, table: &DeTable<'_>) {
        let mut values = Values::new(section, path);
        for (name, value) in table.iter() {
            let field = values.field(name.get_ref());
            let key = section.key(name.get_ref());
            let span = key.map_or_else(|| name.span(), |_| value.span());
            self.spans.insert(field.clone(), span);
            let Some(key) = key else {
                let name = name.get_ref();
                let what = format!("`{name}` is not a key of {}", section.name);
                let known = section.keys.iter().map(|key| key.name);
                self.problem(&field, what, did_you_mean(name, section.name, known));
                continue;
            };
            match value::read(key, value.get_ref()) {
                Ok(read) => values.set(key, Some(read)),
                Err(error) => self.problem(&field, error.what, error.help),
            }
        }
        self.tables.push(Arc::new(values));
    }

    /// Iterates over the tables of a section.
    pub fn of_section(&self, section: &Section) -> impl Iterator<Item = &Values> {
        let tables = self.tables.iter().map(|values| &**values);
        tables.filter(move |values| values.section.name == section.name)
    }

    /// Returns the table of a key; adds it to a section that has one table only, and refuses one of a list that is absent.
    pub fn table(&mut self, path: &KeyPath) -> Result<&mut Values, Problem> {
        let (section, name) = (path.section, path.section.name);
        let count = self.of_section(section).count();
        if count == 0 && section.tables == Tables::One {
            let values = Values::new(section, name.to_owned());
            self.tables.push(Arc::new(values));
        }
        let tables = self.tables.iter_mut();
        let mut tables = tables.filter(|values| values.section.name == name);
        tables.nth(path.index).map(Arc::make_mut).ok_or_else(|| {
            let what = format!("`{path}` cannot be set: tables [[{name}]] in the scene: {count}");
            let help = format!("add a [[{name}]] with its kind to the scene");
            Problem::new(name, what, help)
        })
    }

    /// Replaces the value of a key, and the problems of the key.
    pub fn set(&mut self, check: &mut Check, path: KeyPath, value: &VariedValue) {
        let values = match self.table(&path) {
            Ok(values) => values,
            Err(problem) => return check.problems.push(problem),
        };
        let field = values.field(path.key.name);
        check.problems.retain(|problem| problem.field != field);
        let read = match (value.number, path.key.kind) {
            (Some(value), Kind::Of(_)) => Ok(Value::Number(Uncertain { value, error: 0.0 })),
            _ => value::read_text(path.key, &value.text),
        };
        match read {
            Ok(value) => values.set(path.key, Some(value)),
            Err(error) => {
                values.set(path.key, None);
                check.add(field, error.what, error.help);
            }
        }
    }
}

impl Check<'_> {
    /// Adds a problem, fault and remedy, with a required key, unless the key is present or already has one.
    pub(super) fn missing(
        &mut self,
        values: &Values,
        key: &str,
        problem: impl FnOnce() -> [String; 2],
    ) {
        if !self.is_present(values, key) {
            let [what, help] = problem();
            self.add(values.field(key), what, help);
        }
    }

    /// Whether a key is present, even if unreadable.
    pub(super) fn is_present(&self, values: &Values, key: &str) -> bool {
        // Shortcut for sweeps, which read thousands of scenes, most without a problem.
        values.has(key) || !self.problems.is_empty() && !self.has_no_problem(&[&values.field(key)])
    }

    /// Adds a problem at byte `at` of a text value.
    pub(super) fn add_in_text(
        &mut self,
        field: &str,
        text: &str,
        at: usize,
        what: String,
        help: String,
    ) {
        let source = self.places.0.as_ref();
        let span = source.and_then(|source| {
            let value = source.spans.get(field)?.clone();
            inside(&source.text, value, text, at)
        });
        let problem = Problem::new(field, what, help).at(span);
        self.problems.push(problem);
    }
}

/// Returns the place of the character at byte `at` of a text whose value, with its quotes, stands at `value`; none if
/// escapes make the written form differ from the text.
fn inside(source: &str, value: Range<usize>, text: &str, at: usize) -> Option<Range<usize>> {
    let end = value.end;
    let quoted = source.get(value)?;
    let long = quoted.strip_prefix("\"\"\"");
    let body = match long.or(quoted.strip_prefix("'''")) {
        // The newline right after the opening quotes does not belong to the text.
        Some(body) => {
            let newline = body.strip_prefix('\n').or(body.strip_prefix("\r\n"));
            newline.unwrap_or(body)
        }
        None => quoted.strip_prefix(['"', '\''])?,
    };
    if !body.starts_with(text) {
        return None;
    }
    let start = end - body.len() + at;
    let width = text.get(at..)?.chars().next().map_or(0, char::len_utf8);
    Some(start..start + width)
}
