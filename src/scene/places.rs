//! Where the keys of a scene stand in the file it comes from.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
#[cfg(feature = "cli")]
use std::path::Path;
use std::path::PathBuf;
use std::sync::Arc;

use super::{Problem, Problems};

/// Bytes of the file, by key or table.
pub(super) type Spans = BTreeMap<String, Range<usize>>;

/// The places of a scene's keys; none of a scene from code.
#[derive(Clone, Default)]
pub struct Places(Option<Arc<Source>>);

struct Source {
    file: PathBuf,
    text: String,
    spans: Spans,
}

impl Places {
    #[cfg(feature = "cli")]
    pub(super) fn in_file(file: &Path, text: &str, spans: Spans) -> Places {
        Places(Some(Arc::new(Source {
            file: file.to_owned(),
            text: text.to_owned(),
            spans,
        })))
    }

    /// Problems of the scene, each with the place of its key.
    pub(super) fn problems(&self, mut list: Vec<Problem>) -> Problems {
        let Some(source) = &self.0 else {
            return Problems::in_code(list);
        };
        locate(&mut list, &source.spans);
        Problems::in_file(&source.file, &source.text, list)
    }
}

/// Gives each problem without a place that of its key, or of the table the key belongs to.
pub(super) fn locate(problems: &mut [Problem], spans: &Spans) {
    for problem in problems {
        let mut field = problem.field.as_str();
        while problem.span.is_none() {
            problem.span = spans.get(field).cloned();
            match field.rsplit_once('.') {
                Some((parent, _)) => field = parent,
                None => break,
            }
        }
    }
}

impl fmt::Debug for Places {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.0.as_ref().map(|source| &source.file);
        f.debug_tuple("Places").field(&file).finish()
    }
}
