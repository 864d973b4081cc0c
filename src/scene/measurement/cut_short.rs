//! A file that ends in the middle of its last number.

use super::Measurement;
use super::digits::decimals_of;

/// Rows before the last one that are looked at, ...
const MOST: usize = 100;

/// ... and the fewest that tell how many digits numbers have: of a few, any may end in zeros that are not printed.
const FEWEST: usize = 20;

/// Says where a file ends without the end of a line, in a number that has fewer digits and decimals than those above it.
pub(super) fn cut_short(measurement: &Measurement) -> Option<String> {
    let source = measurement.source.as_ref()?;
    let delimiter = char::from(source.delimiter);
    let is_row = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
    let mut lines = source.text.rsplit('\n');
    let end = lines.next().filter(is_row)?;
    if !source.columns.contains(&end.matches(delimiter).count()) {
        return None;
    }
    let cell = |row: &str| -> String {
        let after = row.rfind(delimiter).map_or(0, |at| at + 1);
        row[after..].trim().replace(',', ".")
    };
    let last = cell(end);
    let (digits, decimals) = fineness(&last);
    let above: Vec<(usize, i32)> = lines
        .filter(is_row)
        .take(MOST.min(measurement.len() - 1))
        .map(|row| fineness(&cell(row)))
        .collect();
    let is_finer = |other: &(usize, i32)| other.0 > digits && other.1 > decimals;
    (above.len() >= FEWEST && above.iter().all(is_finer)).then(|| {
        format!(
            "the file ends without the end of a line, and its last number, {last}, has fewer digits than those above it: it may have been cut short"
        )
    })
}

/// The digits of a number, and how many of them are decimals.
fn fineness(number: &str) -> (usize, i32) {
    let mantissa = number.split(['e', 'E']).next().unwrap_or_default();
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).count();
    (digits, decimals_of(number.as_bytes()))
}
