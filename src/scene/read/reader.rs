//! Problems on the way from text to scene, and the places of keys and values.

use std::ops::Range;

use super::Values;
use crate::scene::Problem;
use crate::scene::places::{Spans, locate};

/// Collects problems and remembers where each key stands.
pub(in crate::scene) struct Reader<'a> {
    pub problems: Vec<Problem>,
    source: &'a str,
    spans: Spans,
}

impl<'a> Reader<'a> {
    pub fn new(source: &'a str) -> Reader<'a> {
        Reader {
            problems: Vec::new(),
            source,
            spans: Spans::new(),
        }
    }

    /// Remembers where the value of a key, or the header of a table, stands.
    pub fn found(&mut self, field: &str, span: Range<usize>) {
        self.spans.insert(field.to_owned(), span);
    }

    pub fn problem(&mut self, field: &str, what: impl Into<String>, help: impl Into<String>) {
        self.problems.push(Problem::new(field, what, help));
    }

    /// A problem at byte `at` of a text value.
    pub fn problem_in_text(
        &mut self,
        field: &str,
        text: &str,
        at: usize,
        what: String,
        help: String,
    ) {
        let span = self.spans.get(field).cloned();
        self.problems.push(Problem {
            field: field.to_owned(),
            span: span.and_then(|span| inside(self.source, span, text, at)),
            what,
            help,
        });
    }

    /// A problem with a key that is needed, unless it is there or already has one.
    pub fn missing(
        &mut self,
        values: &Values,
        key: &str,
        what: impl Into<String>,
        help: impl Into<String>,
    ) {
        if !self.met(values, key) {
            self.problem(&values.field(key), what, help);
        }
    }

    /// Whether there is a problem with this key already; it may be there but unreadable.
    pub fn doubtful(&self, field: &str) -> bool {
        self.problems.iter().any(|problem| problem.field == field)
    }

    /// Whether a key is there, even if unreadable.
    pub fn met(&self, values: &Values, key: &str) -> bool {
        // Most scenes have no problem, and thousands are read in a sweep.
        values.has(key) || !self.problems.is_empty() && self.doubtful(&values.field(key))
    }

    /// The problems, each with the place of its key or of the table it belongs to, and all places.
    pub fn located(mut self) -> (Vec<Problem>, Spans) {
        locate(&mut self.problems, &self.spans);
        (self.problems, self.spans)
    }
}

/// Place of the character at byte `at` of a text whose value stands, with its quotes, at `value`. None if
/// escapes make what is written differ from the text.
fn inside(source: &str, value: Range<usize>, text: &str, at: usize) -> Option<Range<usize>> {
    let end = value.end;
    let quoted = source.get(value)?;
    let body = match ["\"\"\"", "'''"]
        .iter()
        .find_map(|q| quoted.strip_prefix(q))
    {
        // The newline right after the opening quotes does not belong to the text.
        Some(body) => ["\n", "\r\n"]
            .iter()
            .find_map(|newline| body.strip_prefix(newline))
            .unwrap_or(body),
        None => quoted.strip_prefix(['"', '\''])?,
    };
    if !body.starts_with(text) {
        return None;
    }
    let start = end - body.len() + at;
    let width = text.get(at..)?.chars().next().map_or(0, char::len_utf8);
    Some(start..start + width)
}
