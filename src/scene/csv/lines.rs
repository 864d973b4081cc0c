//! Rows of a data file: lines that are neither blank nor comments, and their cells.

use std::ops::Range;

/// Division of a data file into rows and cells.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Dialect {
    pub delimiter: char,
    /// Byte at which the rows, header included, begin.
    pub start: usize,
}

/// True for a text that spreadsheets write where a formula has no value, `#N/A`, `#NV`, `#REF!`: at the beginning of a line it
/// looks like a comment.
fn is_no_value(cell: &str) -> bool {
    let name = cell.strip_suffix(['!', '?']).unwrap_or(cell);
    let is_upper = |c: char| c.is_ascii_uppercase() || matches!(c, '#' | '/' | '0');
    matches!(cell, "#N/A" | "#NV") || name != cell && name.chars().all(is_upper)
}

/// Fault of a value that continues over the end of its line.
pub(in crate::scene) const OPEN_QUOTE: &str = "a quote is not closed on its line";
pub(in crate::scene) const CLOSE_QUOTE: &str =
    "write numbers without quotes, and each row on a line of its own";

impl Dialect {
    /// Determines the dialect of a text whose first `skip` lines do not count: a line `sep=;` states the delimiter;
    /// else it is a semicolon or a tab if the first row has one, or a comma, or blanks between numbers alone.
    pub fn of(text: &str, skip: usize) -> Dialect {
        let mark = text.len() - text.trim_start_matches('\u{feff}').len();
        let skipped: usize = text.split_inclusive('\n').take(skip).map(str::len).sum();
        let skipped = skipped.max(mark);
        let first = text.split_inclusive('\n').next().unwrap_or_default();
        let bare = first[mark..].trim_matches(|c: char| matches!(c, '"' | '\r' | '\n'));
        if let Some(delimiter) = bare.strip_prefix("sep=")
            && let Ok(delimiter) = delimiter.parse()
        {
            let start = skipped.max(first.len());
            return Dialect { delimiter, start };
        }
        let mut dialect = Dialect {
            delimiter: ',',
            start: skipped,
        };
        let row = dialect.rows(text).next().unwrap_or_default();
        let found = [';', '\t']
            .into_iter()
            .find(|delimiter| row.contains(*delimiter));
        let are_numbers = || {
            row.split_whitespace()
                .all(|cell| cell.parse::<f64>().is_ok())
        };
        let blank = (row.split_whitespace().count() > 1 && are_numbers()).then_some(' ');
        dialect.delimiter = found.or(blank).unwrap_or(',');
        dialect
    }

    /// Iterates over the rows of a whole text.
    pub fn rows(self, text: &str) -> impl Iterator<Item = &str> {
        self.rows_of(text.get(self.start..).unwrap_or_default())
    }

    /// Iterates over the rows of a part of a text.
    pub fn rows_of(self, part: &str) -> impl Iterator<Item = &str> {
        let lines = part
            .split_inclusive('\n')
            .map(|line| line.trim_end_matches(['\n', '\r']));
        let separates = move |c: char| c == self.delimiter || c.is_whitespace();
        lines.filter(move |line| !line.chars().all(separates) && !self.is_comment(line))
    }

    /// Whether a line begins with `%`, with `#` other than in `#N/A` and the like, or with `;` that separates no cells.
    pub fn is_comment(self, line: &str) -> bool {
        let line = line.trim_start();
        let first = line.split(self.delimiter).next().unwrap_or_default();
        match line.chars().next() {
            Some('#') => !is_no_value(first.trim()),
            Some(mark) => mark == '%' || mark == ';' && self.delimiter != ';',
            None => false,
        }
    }

    /// Returns the first quote of a row with an odd number of quotes.
    pub fn open_quote(row: &str) -> Option<&str> {
        let at = row.find('"')?;
        (row.matches('"').count() % 2 == 1).then(|| &row[at..=at])
    }

    pub fn list(self, row: &str) -> Vec<&str> {
        self.cells(row).collect()
    }

    /// Iterates over the cells of a row without blanks and quotes around them; quoted delimiters separate none.
    pub fn cells<'a>(self, row: &'a str) -> impl Iterator<Item = &'a str> {
        let mut quoted = false;
        let separates = move |c: char| {
            quoted ^= c == '"';
            !quoted && c == self.delimiter
        };
        let bare = |cell: &'a str| {
            let cell = cell.trim_matches(|c: char| c.is_whitespace());
            let bare = cell
                .strip_prefix('"')
                .and_then(|cell| cell.strip_suffix('"'));
            bare.map_or(cell, str::trim)
        };
        // Blanks separate cells by any number of them.
        let counts = move |cell: &&str| self.delimiter != ' ' || !cell.is_empty();
        row.split(separates).map(bare).filter(counts)
    }
}

/// Returns the byte range of `part`, a slice of `text`, in `text`.
pub(in crate::scene) fn span(text: &str, part: &str) -> Range<usize> {
    let start = (part.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
    start.min(text.len())..(start + part.len()).min(text.len())
}

/// Returns the number, from 1, of the line of `text` in which its slice `part` begins.
pub(in crate::scene) fn line_number(text: &str, part: &str) -> usize {
    text[..span(text, part).start].matches('\n').count() + 1
}
