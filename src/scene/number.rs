//! Numbers: their length in a text, and their form in messages.

use std::ops::Range;

/// Returns the length, bytes, of the unsigned number that begins the text: digits and points, then an exponent.
pub(super) fn length(text: &str) -> usize {
    let mantissa = text
        .bytes()
        .take_while(|b| b.is_ascii_digit() || *b == b'.')
        .count();
    let Some(exponent) = text[mantissa..].strip_prefix(['e', 'E']) else {
        return mantissa;
    };
    let unsigned = exponent.strip_prefix(['+', '-', MINUS]).unwrap_or(exponent);
    let digits = unsigned.bytes().take_while(u8::is_ascii_digit).count();
    if mantissa == 0 || digits == 0 {
        mantissa
    } else {
        text.len() - unsigned.len() + digits
    }
}

/// Typographic minus sign, which editors and web pages put in place of a hyphen.
pub(super) const MINUS: char = '\u{2212}';

/// Returns the text with hyphens in place of typographic minus signs.
pub(super) fn plain(text: &str) -> String {
    text.replace(MINUS, "-")
}

/// Formats a stated value with 12 significant digits, which hides rounding noise.
pub(super) fn show(value: f64) -> String {
    rounded(value, 12, WITHOUT_EXPONENT)
}

/// Formats a value with its unit, if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", show(value)).trim_end().to_owned()
}

/// Formats two values that differ with enough digits to show it.
pub(super) fn apart(a: f64, b: f64) -> (String, String) {
    let both = |digits| {
        let [a, b] = [a, b].map(|value| rounded(value, digits, WITHOUT_EXPONENT));
        (a, b)
    };
    let differ = (6..=17).map(both).find(|(a, b)| a != b);
    differ.unwrap_or_else(|| both(12))
}

/// Formats a computed value with six significant digits.
pub(super) fn computed(value: f64) -> String {
    rounded(value, 6, WITHOUT_EXPONENT)
}

/// Formats a count with its noun: `1 row`, `2 rows`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Sizes of the numbers that messages write without exponent.
const WITHOUT_EXPONENT: Range<f64> = 1e-6..1e15;

/// Formats a number with all its digits.
pub(crate) fn unrounded(value: f64) -> String {
    rounded(value, 17, WITHOUT_EXPONENT)
}

/// Formats a number with at most `digits` significant digits, without trailing zeros; without exponent if its size is
/// in `plain`.
pub(crate) fn rounded(value: f64, digits: usize, plain: Range<f64>) -> String {
    let short = format!("{value:.*e}", digits - 1);
    // Minus zero is zero.
    let value = short.parse().unwrap_or(value) + 0.0;
    let size = value.abs();
    match size == 0.0 || !size.is_finite() || plain.contains(&size) {
        true => format!("{value}"),
        false => format!("{value:e}"),
    }
}
