//! Numbers of cells: their values, how finely they are printed, and what is wrong with them.

use std::borrow::Cow;

use crate::scene::number;

/// A number with a decimal point, whatever the file has; none if that has the other one.
pub(super) fn with_point(cell: &str, decimal_comma: bool) -> Option<Cow<'_, str>> {
    match decimal_comma {
        false => Some(Cow::Borrowed(cell)),
        true if cell.contains('.') => None,
        true => Some(Cow::Owned(cell.replacen(',', ".", 1))),
    }
}

/// What is wrong with a cell, and what would be right.
pub(super) struct NotANumber {
    pub what: String,
    pub help: &'static str,
}

fn wrong(what: String, help: &'static str) -> NotANumber {
    NotANumber { what, help }
}

/// The number of a cell.
pub(super) fn parse(cell: &str, decimal_comma: bool) -> Result<f64, NotANumber> {
    let Some(text) = with_point(cell, decimal_comma) else {
        let help = "write every number with a decimal comma and without separators of thousands";
        return Err(wrong(
            format!("`{cell}` has a point where numbers have decimal commas"),
            help,
        ));
    };
    match text
        .parse::<f64>()
        .or_else(|_| number::plain(&text).parse())
    {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(wrong(
            format!("`{text}` is not a finite number"),
            "give a number, or take the row out",
        )),
        Err(_) => Err(not_a_number(cell)),
    }
}

fn not_a_number(cell: &str) -> NotANumber {
    if cell.is_empty() {
        return wrong(
            "the value is missing".to_owned(),
            "give a number, or take the row out",
        );
    }
    if cell.replacen(',', ".", 1).parse::<f64>().is_ok() {
        return wrong(
            format!("`{cell}` has a decimal comma where a point is expected"),
            "write decimal points, or say so with --decimal comma if semicolons or tabs separate the columns",
        );
    }
    let separates = |c: char| matches!(c, ',' | '\'' | '_') || c.is_whitespace();
    if cell.replace(separates, "").parse::<f64>().is_ok() {
        return wrong(
            format!("`{cell}` is not a plain number"),
            "write numbers without separators of thousands",
        );
    }
    let digits = number::length(cell.trim_start_matches(['+', '-', number::MINUS]));
    let help = match digits {
        0 => "give a number; units belong in the header, comments begin with #",
        _ => "write the number alone, as 12.5 or 1.25e1; units belong in the header",
    };
    wrong(format!("`{cell}` is not a number"), help)
}

/// Powers of ten of the size of a value that are told apart.
const DECADES: usize = 40;
/// The least of them, changed in sign.
const FINEST: f64 = 20.0;

/// How finely values are printed: with so many decimals, or with so many digits where larger ones have fewer decimals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Digits {
    /// Values of each size.
    sizes: [usize; DECADES],
    decimals: i32,
    digits: i32,
}

impl Default for Digits {
    fn default() -> Digits {
        Digits {
            sizes: [0; DECADES],
            decimals: i32::MIN,
            digits: 1,
        }
    }
}

/// The power of ten of the first digit of a value, from that of the finest one on.
fn decade(value: f64) -> usize {
    (value.abs().log10().floor() + FINEST).clamp(0.0, DECADES as f64 - 1.0) as usize
}

impl Digits {
    /// Takes a value as printed, with a decimal point.
    pub fn take(&mut self, value: f64, text: &str) {
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let after = mantissa
            .split_once('.')
            .map_or(0, |(_, after)| after.len() as i32);
        let decimals = after
            .saturating_sub(exponent.parse().unwrap_or(0))
            .clamp(-300, 300);
        self.decimals = self.decimals.max(decimals);
        // A zero has no size.
        if value != 0.0 {
            let at = decade(value);
            self.sizes[at] += 1;
            self.digits = self.digits.max(decimals + at as i32 - FINEST as i32 + 1);
        }
    }

    /// Takes what others have shown.
    pub fn join(&mut self, other: &Digits) {
        self.decimals = self.decimals.max(other.decimals);
        self.digits = self.digits.max(other.digits);
        self.sizes
            .iter_mut()
            .zip(other.sizes)
            .for_each(|(mine, other)| *mine += other);
    }

    /// Root mean square of the steps to which the values are rounded: the larger one of the last decimal and of the last digit.
    pub fn step(&self) -> f64 {
        let finest = 10f64.powi(-self.decimals.max(-300));
        let square = |(at, count): (usize, &usize)| {
            let digit = 10f64.powi(at as i32 - FINEST as i32 + 1 - self.digits);
            *count as f64 * (finest.max(digit) / finest).powi(2)
        };
        let values: usize = self.sizes.iter().sum();
        let squares: f64 = self.sizes.iter().enumerate().map(square).sum();
        if values == 0 {
            finest
        } else {
            finest * (squares / values as f64).sqrt()
        }
    }
}
