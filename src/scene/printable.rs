//! Texts of scenes and names of files on a terminal or in a figure.

use std::borrow::Cow;

/// The text with control characters, and those that turn the direction of writing, as their codes: what a title or a
/// name says is shown, never obeyed. Line feeds and tabs stay.
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

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn control_characters_are_shown_as_codes() {
        assert_eq!(
            printable("a\u{1b}[31mb\r\n\tc\u{202e}\u{9b}"),
            "a\\u{1b}[31mb\\r\n\tc\\u{202e}\\u{9b}"
        );
        assert_eq!(printable("θ = 3°"), "θ = 3°");
    }
}
