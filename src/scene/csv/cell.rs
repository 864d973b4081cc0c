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
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    let separates = |c: char| matches!(c, ',' | '\'' | '_') || c.is_whitespace();
    let (what, help) = if cell.is_empty() {
        let what = "the value is missing".to_owned();
        return NotANumber {
            what,
            help: LACKS_VALUE,
        };
    } else if decimal_comma && cell.contains('.') {
        let help = "write every number with a decimal comma and without separators of thousands";
        ("has a point where numbers have decimal commas", help)
    } else if is_number(cell) {
        ("is not a finite number", LACKS_VALUE)
    } else if is_number(&cell.replacen(',', ".", 1)) {
        let help = "write decimal points, or say so with --decimal comma if semicolons or tabs separate the columns";
        ("has a decimal comma where a point is expected", help)
    } else if is_number(&cell.replace(separates, "")) {
        let help = "write numbers without separators of thousands";
        ("is not a plain number", help)
    } else {
        let help = "write the number alone, as 12.5 or 1.25e1; units belong in the header, comments begin with #";
        ("is not a number", help)
    };
    let what = format!("`{cell}` {what}");
    NotANumber { what, help }
}
