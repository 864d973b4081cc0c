//! Texts in figures: estimated widths, wrapping and cutting.

use super::layout::LAYOUT;

/// Returns the height of a line of text of a font size, pixels.
pub(super) fn line_height(size: f64) -> f64 {
    1.25 * size
}

/// Escapes a text for XML, without control characters, which XML forbids.
pub(crate) fn escaped(text: &str) -> String {
    let plain: String = text.chars().filter(|c| !c.is_control()).collect();
    let text = plain.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns an upper estimate of the width of a text, pixels: the reader's fonts are unknown.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 0.36,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 1.0,
        c if c.is_uppercase() => 0.75,
        c if c.is_ascii() => 0.64,
        _ => 1.0,
    };
    size * text.chars().map(em).sum::<f64>()
}

/// Wraps a text between words into lines of width `room`, pixels; cuts longer words.
pub(super) fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(|c: char| c.is_whitespace() || c.is_control()) {
        let mut word = word.to_owned();
        while width(&word, size) > room && word.pop().is_some() {}
        match lines.last_mut() {
            _ if word.is_empty() => (),
            Some(line) if width(&format!("{line} {word}"), size) <= room => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// Returns the part of a label that fits into one line of width `room`, pixels.
pub(super) fn fitted(label: &str, room: f64) -> String {
    let mut lines = wrapped(label, LAYOUT.text, room).into_iter();
    lines.next().unwrap_or_default()
}
