//! Places of the keys of a scene in the file it comes from.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use super::{Problem, Problems};

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
    /// Returns the text of the file, and the byte range of the value of a key.
    #[cfg(feature = "cli")]
    pub(super) fn of(&self, field: &str) -> Option<(&str, Range<usize>)> {
        let source = self.0.as_ref()?;
        Some((&source.text, source.spans.get(field)?.clone()))
    }

    /// Returns problems of the scene, with their places, as the error; no error for an empty list.
    pub(super) fn result(&self, list: Vec<Problem>) -> Result<(), Problems> {
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
