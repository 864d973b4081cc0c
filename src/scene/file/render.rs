//! Formats problems as text for a terminal, with the line of the file underlined.

use std::borrow::Cow;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use crate::scene::number::counted;
use crate::scene::{Problem, Problems};

impl Problems {
    /// Returns the text for a terminal, in colour or plain.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let most_shown = 20;
        let (shown, others) = self.list().split_at(self.list().len().min(most_shown));
        let render = |problem| self.render_one(problem, &renderer);
        let mut blocks: Vec<String> = shown.iter().map(render).collect();
        if !others.is_empty() {
            let title = counted(others.len(), "more problem");
            let help = Level::HELP.message("put right the first ones, and look again");
            let report = Level::ERROR.primary_title(title).element(help);
            blocks.push(renderer.render(&[report]));
        }
        blocks.join("\n\n")
    }

    fn render_one(&self, problem: &Problem, renderer: &Renderer) -> String {
        let what = printable(&problem.what);
        let (help, field) = (printable(&problem.help), printable(&problem.field));
        let title = Level::ERROR.primary_title(shortened(&what));
        let help = Level::HELP.message(help);
        let file = self.file.as_ref().map(|file| file.display().to_string());
        let file = file.as_deref().map(printable);
        let report = match (file, &problem.span) {
            (Some(file), Some(span)) => title.element(
                Snippet::source(self.source.as_str())
                    .path(file)
                    .annotation(AnnotationKind::Primary.span(span.clone()).label(field)),
            ),
            (Some(file), None) => title.element(annotate_snippets::Origin::path(file)),
            (None, _) => title.element(Level::NOTE.message(field)),
        };
        renderer.render(&[report.element(help)])
    }
}

/// Cuts out the middle of a very long message, which quotes a value as long as a file.
fn shortened(text: &str) -> Cow<'_, str> {
    let (count, longest) = (text.chars().count(), 300);
    if count <= longest {
        return Cow::Borrowed(text);
    }
    let half = longest / 2;
    let start: String = text.chars().take(half).collect();
    let end: String = text.chars().skip(count - half).collect();
    Cow::Owned(format!("{start} ... {end}"))
}

/// Replaces control characters, and characters that change the direction of writing, by their codes, because a terminal
/// would obey them. Line feeds and tabs stay.
///
/// ```
/// use slider_crank::scene::printable;
/// assert_eq!(printable("a\u{1b}[31mb\r\n\tc\u{202e}\u{9b}"), "a\\u{1b}[31mb\\r\n\tc\\u{202e}\\u{9b}");
/// assert_eq!(printable("θ = 3°"), "θ = 3°");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(commands) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if commands(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

fn commands(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || (c.is_control() && !matches!(c, '\n' | '\t'))
}
