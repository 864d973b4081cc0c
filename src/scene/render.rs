//! Problems as text for a terminal, with the line of the file underlined.

use std::borrow::Cow;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use super::{Problem, Problems};

impl Problems {
    /// The text for a terminal, in colour or plain.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let blocks: Vec<String> = self
            .list()
            .iter()
            .map(|problem| self.render_one(problem, &renderer))
            .collect();
        blocks.join("\n\n")
    }

    fn render_one(&self, problem: &Problem, renderer: &Renderer) -> String {
        let title = Level::ERROR.primary_title(shortened(&problem.what));
        let help = Level::HELP.message(problem.help.as_str());
        let report = match (&self.file, &problem.span) {
            (Some(file), Some(span)) => title.element(
                Snippet::source(self.source.as_str())
                    .path(file.display().to_string())
                    .annotation(
                        AnnotationKind::Primary
                            .span(span.clone())
                            .label(problem.field.as_str()),
                    ),
            ),
            (Some(file), None) => {
                title.element(annotate_snippets::Origin::path(file.display().to_string()))
            }
            (None, _) => title.element(Level::NOTE.message(problem.field.as_str())),
        };
        renderer.render(&[report.element(help)])
    }
}

/// Longest message, in characters: one that is longer quotes a value as long as a file.
const LONGEST: usize = 300;

/// A message without the middle of what it quotes, if that is very long.
fn shortened(text: &str) -> Cow<'_, str> {
    let count = text.chars().count();
    if count <= LONGEST {
        return Cow::Borrowed(text);
    }
    let half = LONGEST / 2;
    let start: String = text.chars().take(half).collect();
    let end: String = text.chars().skip(count - half).collect();
    Cow::Owned(format!("{start} ... {end}"))
}
