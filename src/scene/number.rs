//! Numbers: their length in a text, and their form in messages.

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
    rounded(value, 12)
}

/// Formats a value with its unit, if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", show(value)).trim_end().to_owned()
}

/// Formats two values that differ with enough digits to show it.
pub(super) fn apart(a: f64, b: f64) -> (String, String) {
    (6..=17)
        .map(|digits| (rounded(a, digits), rounded(b, digits)))
        .find(|(a, b)| a != b)
        .unwrap_or_else(|| (show(a), show(b)))
}

/// Formats a computed value with six significant digits.
pub(super) fn computed(value: f64) -> String {
    rounded(value, 6)
}

/// Formats a count with its noun: `1 row`, `2 rows`.
pub(super) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn rounded(value: f64, digits: usize) -> String {
    let value = format!("{value:.*e}", digits - 1)
        .parse::<f64>()
        .map_or(value, |short| short + 0.0);
    if value == 0.0 || !value.is_finite() || (1e-6..1e15).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}
