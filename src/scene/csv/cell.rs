//! Parses the numbers of cells, and says what is wrong with cells that hold none.

use std::borrow::Cow;

use crate::scene::number;

/// Returns a number with a decimal point; none for a cell with a point where numbers have decimal commas.
pub(in crate::scene) fn with_point(cell: &str, decimal_comma: bool) -> Option<Cow<'_, str>> {
    match decimal_comma {
        false => Some(Cow::Borrowed(cell)),
        true if cell.contains('.') => None,
        true => Some(Cow::Owned(cell.replacen(',', ".", 1))),
    }
}

/// Remedy for a cell that lacks a value.
pub(in crate::scene) const LACKS_VALUE: &str = "give a number, or take the row out";

/// What cells without a value contain.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Missing {
    pub texts: Vec<String>,
    pub decimal_comma: bool,
}

impl Missing {
    /// Whether a cell has one of the texts, in any case, or the same number.
    pub fn is_in(&self, cell: &str) -> bool {
        let number = |text: &str| parse(text, self.decimal_comma).ok();
        let is_same = |text: &str| number(text).is_some_and(|mark| number(cell) == Some(mark));
        let mut texts = self.texts.iter();
        texts.any(|text| text.eq_ignore_ascii_case(cell) || is_same(text))
    }
}

/// Fault of a cell, and its remedy.
pub(in crate::scene) struct NotANumber {
    pub what: String,
    pub help: &'static str,
}

/// Parses the finite number of a cell.
pub(in crate::scene) fn parse(cell: &str, decimal_comma: bool) -> Result<f64, NotANumber> {
    let value = with_point(cell, decimal_comma).and_then(|text| {
        let plain = |_| number::plain(&text).parse::<f64>();
        text.parse::<f64>().or_else(plain).ok()
    });
    match value {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err(not_a_number(cell, decimal_comma)),
    }
}

fn not_a_number(cell: &str, decimal_comma: bool) -> NotANumber {
    let is_number = |text: String| text.parse::<f64>().is_ok();
    let separates = |c: char| matches!(c, ',' | '\'' | '_') || c.is_whitespace();
    let (what, help) = if cell.is_empty() {
        ("the value is missing".to_owned(), LACKS_VALUE)
    } else if decimal_comma && cell.contains('.') {
        (
            format!("`{cell}` has a point where numbers have decimal commas"),
            "write every number with a decimal comma and without separators of thousands",
        )
    } else if is_number(cell.to_owned()) {
        (format!("`{cell}` is not a finite number"), LACKS_VALUE)
    } else if is_number(cell.replacen(',', ".", 1)) {
        (
            format!("`{cell}` has a decimal comma where a point is expected"),
            "write decimal points, or say so with --decimal comma if semicolons or tabs separate the columns",
        )
    } else if is_number(cell.replace(separates, "")) {
        (
            format!("`{cell}` is not a plain number"),
            "write numbers without separators of thousands",
        )
    } else {
        (
            format!("`{cell}` is not a number"),
            "write the number alone, as 12.5 or 1.25e1; units belong in the header, comments begin with #",
        )
    };
    NotANumber { what, help }
}
