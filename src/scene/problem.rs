//! Problems of scenes and data files, their places, and their display with the line of the file.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One fault of a scene or of data.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Key at fault, as `geometry.rod` or `torque[1].value`.
    pub field: String,
    /// Byte range in the file, if known.
    pub span: Option<Range<usize>>,
    /// Fault, with the value.
    pub what: String,
    /// Remedy.
    pub help: String,
}

impl Problem {
    /// Creates a problem with a value, without a place.
    pub fn new(field: &str, what: impl Into<String>, help: impl Into<String>) -> Problem {
        Problem {
            field: field.to_owned(),
            span: None,
            what: what.into(),
            help: help.into(),
        }
    }

    /// Returns the problem with its byte range in the file.
    pub(super) fn at(self, span: impl Into<Option<Range<usize>>>) -> Problem {
        let span = span.into();
        Problem { span, ..self }
    }
}

/// All problems of one scene or data file.
#[derive(Clone, Debug)]
pub struct Problems {
    pub(super) file: Option<PathBuf>,
    pub(super) source: String,
    list: Vec<Problem>,
}

impl Problems {
    pub(super) fn in_file(file: &Path, source: &str, mut list: Vec<Problem>) -> Problems {
        for span in list.iter_mut().filter_map(|problem| problem.span.as_mut()) {
            *span = whole_characters(source, span.clone());
        }
        list.sort_by_key(|problem| problem.span.as_ref().map_or(0, |span| span.start));
        Problems {
            file: Some(file.to_owned()),
            source: source.to_owned(),
            list,
        }
    }

    /// Creates the problems of data from code.
    pub fn in_code(list: Vec<Problem>) -> Problems {
        Problems {
            file: None,
            source: String::new(),
            list,
        }
    }

    /// Returns the problems, in the order of the file.
    pub fn list(&self) -> &[Problem] {
        &self.list
    }

    /// Returns line and column, from 1, of a problem that has a place.
    pub fn place(&self, problem: &Problem) -> Option<(usize, usize)> {
        let start = problem.span.as_ref()?.start.min(self.source.len());
        let before = self.source.get(..start)?;
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        Some((line, column))
    }
}

/// Widens a span to whole characters of the source, which the renderer requires.
fn whole_characters(source: &str, span: Range<usize>) -> Range<usize> {
    let boundary = |at: &usize| source.is_char_boundary(*at);
    let length = source.len();
    let start = (0..=span.start.min(length)).rev().find(boundary);
    let end = (span.end.min(length)..=length).find(boundary);
    let start = start.unwrap_or(0);
    start..end.unwrap_or(length).max(start)
}

impl fmt::Display for Problems {
    #[cfg(feature = "cli")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }

    #[cfg(not(feature = "cli"))]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for problem in &self.list {
            if let Some(file) = &self.file {
                write!(f, "{}:", file.display())?;
            }
            if let Some((line, column)) = self.place(problem) {
                write!(f, "{line}:{column}: ")?;
            }
            let (field, what, help) = (&problem.field, &problem.what, &problem.help);
            writeln!(f, "{field}: {what}\nhelp: {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

/// Byte ranges in the file, by key or table.
pub(super) type Spans = BTreeMap<String, Range<usize>>;

/// Places of a scene's keys; none for a scene from code.
#[derive(Clone, Default)]
pub struct Places(pub(super) Option<Arc<Source>>);

pub(super) struct Source {
    pub file: PathBuf,
    pub text: String,
    pub spans: Spans,
}

impl Places {
    /// Returns problems of the scene, with their places, as the error, unless the list is empty.
    pub(crate) fn reject_any(&self, list: Vec<Problem>) -> Result<(), Problems> {
        match list.is_empty() {
            true => Ok(()),
            false => Err(self.problems(list)),
        }
    }

    /// Returns problems of the scene, each with the place of its key, or of the table the key belongs to.
    pub(super) fn problems(&self, mut list: Vec<Problem>) -> Problems {
        let Some(source) = &self.0 else {
            return Problems::in_code(list);
        };
        for problem in &mut list {
            let mut fields = std::iter::successors(Some(problem.field.as_str()), |field| {
                Some(field.rsplit_once('.')?.0)
            });
            let place = || fields.find_map(|field| source.spans.get(field).cloned());
            problem.span = problem.span.take().or_else(place);
        }
        Problems::in_file(&source.file, &source.text, list)
    }
}

impl fmt::Debug for Places {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.0.as_ref().map(|source| &source.file);
        f.debug_tuple("Places").field(&file).finish()
    }
}
