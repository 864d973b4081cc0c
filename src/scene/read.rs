//! Scene files: TOML to [`Scene`], with the place of everything that is wrong.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{self, Key, Kind, Section};
use super::unit::{self, Quantity};
use super::{Every, Problem, Problems, Scene};

/// A value that has been read.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    Text(String),
    Choice(&'static str),
    Every(Every),
}

/// The values of one table.
#[derive(Debug)]
pub(super) struct Values {
    pub path: String,
    entries: BTreeMap<&'static str, Value>,
}

impl Values {
    pub fn number(&self, key: &str) -> Option<f64> {
        match self.entries.get(key) {
            Some(Value::Number(number)) => Some(*number),
            _ => None,
        }
    }

    pub fn text(&self, key: &str) -> Option<&str> {
        match self.entries.get(key) {
            Some(Value::Text(text)) => Some(text),
            Some(Value::Choice(word)) => Some(word),
            _ => None,
        }
    }

    pub fn every(&self, key: &str) -> Option<Every> {
        match self.entries.get(key) {
            Some(Value::Every(every)) => Some(*every),
            _ => None,
        }
    }

    pub fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    pub fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.entries.keys().copied()
    }

    pub fn field(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }
}

/// Collects problems and remembers where each key stands.
#[derive(Debug, Default)]
pub(super) struct Reader {
    pub problems: Vec<Problem>,
    spans: BTreeMap<String, Range<usize>>,
    failed: Vec<String>,
    /// Start of the text of string values, for errors inside a formula.
    text_start: BTreeMap<String, usize>,
}

impl Reader {
    pub fn problem(&mut self, field: &str, what: impl Into<String>, help: impl Into<String>) {
        self.problems.push(Problem::new(field, what, help));
    }

    /// A problem at one place inside a text value.
    pub fn problem_in_text(
        &mut self,
        field: &str,
        at: usize,
        length: usize,
        what: String,
        help: String,
    ) {
        let span = self
            .text_start
            .get(field)
            .map(|start| start + at..start + (at + 1).min(length).max(at));
        self.problems.push(Problem {
            field: field.to_owned(),
            span,
            what,
            help,
        });
    }

    /// Whether this key was there but could not be read; it is not missing then.
    pub fn failed(&self, field: &str) -> bool {
        self.failed.iter().any(|f| f == field)
    }

    /// Gives every problem the place of its key, or of the table it belongs to.
    fn locate(&mut self) {
        for problem in &mut self.problems {
            let mut field = problem.field.as_str();
            while problem.span.is_none() {
                problem.span = self.spans.get(field).cloned();
                match field.rsplit_once('.') {
                    Some((parent, _)) => field = parent,
                    None => break,
                }
            }
        }
        self.problems
            .sort_by_key(|problem| problem.span.as_ref().map_or(0, |span| span.start));
    }
}

/// Reads the text of a scene file; tables it names are looked for beside it.
pub(super) fn scene(file: &Path, source: &str) -> Result<Scene, Problems> {
    let (document, errors) = DeTable::parse_recoverable(source);
    let mut reader = Reader::default();
    for error in &errors {
        reader.problems.push(Problem {
            field: "syntax".to_owned(),
            span: error.span(),
            what: format!("not TOML: {}", error.message()),
            help: "tables are `[geometry]`, values are `key = \"47 mm\"`".to_owned(),
        });
    }
    if !errors.is_empty() {
        return Err(Problems::in_file(file, source, reader.problems));
    }
    let (title, tables) = tables(&mut reader, document.get_ref(), source);
    let folder = file.parent().unwrap_or(Path::new(""));
    let scene = super::assemble::scene(&mut reader, title, &tables, folder);
    if let Some(scene) = &scene {
        reader.problems.extend(super::validate::problems(scene));
    }
    reader.locate();
    match scene {
        Some(scene) if reader.problems.is_empty() => Ok(scene),
        _ => Err(Problems::in_file(file, source, reader.problems)),
    }
}

fn tables(
    reader: &mut Reader,
    document: &DeTable<'_>,
    source: &str,
) -> (Option<String>, Vec<(&'static Section, Values)>) {
    let mut title = None;
    let mut found = Vec::new();
    for (key, value) in document.iter() {
        let name = key.get_ref().as_ref();
        reader.spans.insert(name.to_owned(), key.span());
        if name == "title" {
            title = value.get_ref().as_str().map(str::to_owned);
            if title.is_none() {
                reader.problem("title", "the title is not a text", "write title = \"...\"");
            }
            continue;
        }
        let Some(section) = keys::section(name) else {
            let known = keys::SECTIONS.iter().map(|s| s.name).chain(["title"]);
            let help = match keys::nearest(name, known.clone()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("a scene has {}", known.collect::<Vec<_>>().join(", ")),
            };
            reader.problem(name, format!("`{name}` is not part of a scene"), help);
            continue;
        };
        match (value.get_ref(), section.repeated) {
            (DeValue::Table(table), false) => {
                let values = values(reader, section, name.to_owned(), table, source);
                found.push((section, values));
            }
            (DeValue::Array(array), true) if array.iter().all(|item| item.get_ref().is_table()) => {
                for (i, item) in array.iter().enumerate() {
                    let path = format!("{name}[{}]", i + 1);
                    reader.spans.insert(path.clone(), item.span());
                    if let DeValue::Table(table) = item.get_ref() {
                        let values = values(reader, section, path, table, source);
                        found.push((section, values));
                    }
                }
            }
            (_, true) => reader.problem(
                name,
                format!("`{name}` must be a list of tables"),
                format!("begin each {name} with [[{name}]]"),
            ),
            (_, false) => reader.problem(
                name,
                format!("`{name}` must be a table"),
                format!("begin it with [{name}], once"),
            ),
        }
    }
    (title, found)
}

fn values(
    reader: &mut Reader,
    section: &'static Section,
    path: String,
    table: &DeTable<'_>,
    source: &str,
) -> Values {
    let mut values = Values {
        path,
        entries: BTreeMap::new(),
    };
    for (name, value) in table.iter() {
        let field = values.field(name.get_ref());
        let Some(key) = section.keys.iter().find(|key| key.name == name.get_ref()) else {
            reader.spans.insert(field.clone(), name.span());
            let known = section.keys.iter().map(|key| key.name);
            let help = match keys::nearest(name.get_ref(), known.clone()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!(
                    "{} has {}",
                    section.name,
                    known.collect::<Vec<_>>().join(", ")
                ),
            };
            let what = format!("`{}` is not a key of {}", name.get_ref(), section.name);
            reader.problem(&field, what, help);
            continue;
        };
        reader.spans.insert(field.clone(), value.span());
        if value.get_ref().is_str() {
            let quotes = source[value.span()]
                .chars()
                .take_while(|c| *c == '"' || *c == '\'');
            let start = value.span().start + quotes.count().min(3);
            reader.text_start.insert(field.clone(), start);
        }
        match read_value(key, value) {
            Ok(read) => {
                values.entries.insert(key.name, read);
            }
            Err((what, help)) => {
                reader.problem(&field, what, help);
                reader.failed.push(field);
            }
        }
    }
    for required in section.required {
        let field = values.field(required);
        if !values.has(required) && !reader.failed(&field) {
            let key = section.keys.iter().find(|key| key.name == *required);
            reader.problem(
                &field,
                format!("`{required}` is missing in {}", section.name),
                key.map_or_else(String::new, |key| {
                    format!("add {required}: {}", key.meaning)
                }),
            );
        }
    }
    values
}

fn read_value(key: &Key, value: &Spanned<DeValue<'_>>) -> Result<Value, (String, String)> {
    let text = match value.get_ref() {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Integer(number) if number.radix() == 10 => Some(number.as_str().replace('_', "")),
        DeValue::Float(number) => Some(number.as_str().replace('_', "")),
        _ => None,
    };
    let is_text = value.get_ref().is_str();
    let Some(text) = text else {
        let found = value.get_ref().type_str();
        return Err((
            format!("`{}` is a {found}", key.name),
            match key.kind {
                Kind::Choice(words) => format!("write one of {}", quoted(words)),
                Kind::Text => "write a text in quotes".to_owned(),
                Kind::Quantity(quantity) | Kind::QuantityOrFormula(quantity) => {
                    format!("write {} like {}", quantity.name(), quantity.examples())
                }
                Kind::TimeOrAngle => "write a time or an angle like \"1 ms\", \"1 deg\"".to_owned(),
            },
        ));
    };
    match key.kind {
        Kind::Text | Kind::QuantityOrFormula(_) if is_text => Ok(Value::Text(text)),
        Kind::Text => Err((
            format!("`{text}` is a number"),
            "write a text in quotes".to_owned(),
        )),
        Kind::Choice(words) => match words.iter().find(|word| **word == text) {
            Some(word) => Ok(Value::Choice(word)),
            None => Err((
                format!("`{text}` is not a {} this program knows", key.name),
                match keys::nearest(&text, words.iter().copied()) {
                    Some(near) => format!("did you mean \"{near}\"? It may be {}", quoted(words)),
                    None => format!("write one of {}", quoted(words)),
                },
            )),
        },
        Kind::TimeOrAngle => unit::parse(&text, Quantity::Time)
            .map(Every::Time)
            .or_else(|_| unit::parse(&text, Quantity::Angle).map(Every::Angle))
            .map(Value::Every)
            .map_err(|_| {
                (
                    format!("`{text}` is neither a time nor an angle"),
                    "write for example \"1 ms\" or \"1 deg\"".to_owned(),
                )
            }),
        Kind::Quantity(quantity) | Kind::QuantityOrFormula(quantity) => {
            unit::parse(&text, quantity)
                .map(Value::Number)
                .map_err(|e| (e.what, e.help))
        }
    }
}

fn quoted(words: &[&str]) -> String {
    words
        .iter()
        .map(|word| format!("\"{word}\""))
        .collect::<Vec<_>>()
        .join(", ")
}
