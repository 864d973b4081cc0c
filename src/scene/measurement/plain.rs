//! Rows of plain numbers, read on all cores. Whatever else a file holds is left to the reader that says what is wrong.

use super::columns::{Columns, with_point};
use super::digits::Digits;
use super::read::Samples;
use super::source::no_value;
use crate::numeric::parallel;

/// Bytes of a piece of text, about.
const PIECE: usize = 1 << 18;

/// The samples of a text without header; none if there is anything but numbers in it.
pub(super) fn samples(text: &str, delimiter: u8, columns: &Columns) -> Option<Samples> {
    // A quoted cell may hold the end of a line.
    if text.as_bytes().contains(&b'"') {
        return None;
    }
    let pieces = pieces(text);
    let read = |piece: &str| samples_of(piece, delimiter, columns);
    let found = parallel::map(pieces.into_iter(), read);
    let found: Vec<Samples> = found.into_iter().collect::<Option<_>>()?;
    let rows = found.iter().map(|(times, _, _)| times.len()).sum();
    let mut all = (
        Vec::with_capacity(rows),
        Vec::with_capacity(rows),
        Digits::default(),
    );
    for (times, values, digits) in found {
        all.0.extend(times);
        all.1.extend(values);
        all.2.join(&digits);
    }
    Some(all)
}

/// The text in pieces of whole lines.
fn pieces(mut text: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    while !text.is_empty() {
        let from = PIECE.min(text.len());
        let rest = text.as_bytes()[from..].iter().position(|b| *b == b'\n');
        let (piece, after) = text.split_at(rest.map_or(text.len(), |at| from + at + 1));
        pieces.push(piece);
        text = after;
    }
    pieces
}

fn samples_of(text: &str, delimiter: u8, columns: &Columns) -> Option<Samples> {
    let rows = text.len() / 16;
    let mut samples = (
        Vec::with_capacity(rows),
        Vec::with_capacity(rows),
        Digits::default(),
    );
    let bytes = text.as_bytes();
    let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
    let mut at = 0;
    while at < bytes.len() {
        if is_end(&bytes[at]) {
            at += 1;
            continue;
        }
        if bytes[at] == b'#' {
            if no_value(&text[at..], delimiter).is_some() {
                return None;
            }
            at += bytes[at..].iter().position(|byte| *byte == b'\n')?;
            continue;
        }
        let mut pair = [""; 2];
        for column in 0..columns.count {
            let start = at;
            let ends = |byte: &u8| *byte == delimiter || is_end(byte);
            at += bytes[at..]
                .iter()
                .position(ends)
                .unwrap_or(bytes.len() - at);
            for (cell, wanted) in pair.iter_mut().zip(columns.at) {
                if column == wanted {
                    *cell = text[start..at].trim_ascii();
                }
            }
            // The last cell ends the line, and no other one does.
            let last = bytes.get(at).is_none_or(is_end);
            if last != (column + 1 == columns.count) {
                return None;
            }
            at += 1;
        }
        let pair = [with_point(pair[0], columns)?, with_point(pair[1], columns)?];
        let number = |cell: &str| cell.parse::<f64>().ok().filter(|v| v.is_finite());
        let [time, value] = [number(&pair[0]), number(&pair[1])];
        samples.0.push(time? * columns.time.factor);
        samples.1.push(value? * columns.value.factor);
        samples.2.take(value?, pair[1].as_bytes());
    }
    Some(samples)
}
