//! Two columns of numbers under a header, as text with the lines they stand in.

use csv::{Reader, StringRecord};

use crate::scene::number::{self, counted};

/// A CSV text of two columns.
pub(super) struct Pairs<'a> {
    name: &'a str,
    text: &'a str,
    reader: Reader<&'a [u8]>,
    header: StringRecord,
    record: StringRecord,
}

impl<'a> Pairs<'a> {
    /// Reads the header; `name` begins the messages.
    ///
    /// # Errors
    /// What is wrong, as text.
    pub fn new(name: &'a str, text: &'a str) -> Result<Pairs<'a>, String> {
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter(text))
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| e.to_string())?.clone();
        let pairs = Pairs {
            name,
            text,
            reader,
            header,
            record: StringRecord::new(),
        };
        pairs.on_one_line(&pairs.header, 0)?;
        Ok(pairs)
    }

    /// The cells of the header.
    pub fn header(&self) -> &StringRecord {
        &self.header
    }

    /// The byte at which the last record ended.
    pub fn end(&self) -> u64 {
        self.reader.position().byte()
    }

    /// File and line of the record that ended at a byte. A record's own position is where the search for it
    /// begins, before comments and empty lines.
    pub fn place(&self, end: u64) -> String {
        format!("{} line {}", self.name, line_before(self.text, end))
    }

    /// The next two numbers; none after the last row.
    ///
    /// # Errors
    /// What is wrong, with its place, as text.
    pub fn next(&mut self) -> Result<Option<(f64, f64)>, String> {
        loop {
            let before = self.end();
            let read = self.reader.read_record(&mut self.record);
            if !read.map_err(|e| e.to_string())? {
                return Ok(None);
            }
            self.on_one_line(&self.record, before)?;
            if self.record.iter().any(|cell| !cell.is_empty()) || self.record.len() > 1 {
                break;
            }
        }
        let point = point(&self.record).map_err(|what| format!("{}{what}", self.place(self.end())));
        point.map(Some)
    }

    /// Whether the record that begins at or after a byte ends on its line.
    fn on_one_line(&self, record: &StringRecord, from: u64) -> Result<(), String> {
        if !record.iter().any(|cell| cell.contains('\n')) {
            return Ok(());
        }
        let from = usize::try_from(from).unwrap_or(usize::MAX);
        let at = open_quote(self.text, from);
        let line = self.text[..at].matches('\n').count() + 1;
        let name = self.name;
        Err(format!("{name} line {line}: {OPEN_QUOTE}"))
    }
}

/// What is wrong with a value that goes on over the end of its line.
pub(in crate::scene) const OPEN_QUOTE: &str = "a quote is not closed on its line";

/// The byte of the first quote at or after a byte, comments apart.
pub(in crate::scene) fn open_quote(text: &str, from: usize) -> usize {
    let mut start = from.min(text.len());
    for line in text[start..].split_inclusive('\n') {
        if let (Some(at), false) = (line.find('"'), line.starts_with('#')) {
            return start + at;
        }
        start += line.len();
    }
    start
}

/// The number of the line that ends at or before a byte of the text, from 1.
fn line_before(text: &str, end: u64) -> usize {
    let end = usize::try_from(end).map_or(text.len(), |end| end.min(text.len()));
    let read = text.as_bytes()[..end].trim_ascii_end();
    read.iter().filter(|byte| **byte == b'\n').count() + 1
}

/// The two numbers of a row, or what follows its place in the message.
fn point(record: &StringRecord) -> Result<(f64, f64), String> {
    if record.len() != 2 {
        return Err(format!(
            ": {} where 2 are expected",
            counted(record.len(), "value")
        ));
    }
    let number = |column: usize| {
        let cell = &record[column];
        number::plain(cell).parse::<f64>().map_err(|_| {
            let what = if cell.replacen(',', ".", 1).parse::<f64>().is_ok() {
                "has a decimal comma where a point is expected"
            } else {
                "is not a number"
            };
            format!(" column {}: `{cell}` {what}", column + 1)
        })
    };
    Ok((number(0)?, number(1)?))
}

/// What separates the columns: a semicolon or a tab if the first line has one, else a comma.
pub(in crate::scene) fn delimiter(text: &str) -> u8 {
    let first = text
        .trim_start_matches('\u{feff}')
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .unwrap_or_default();
    [b';', b'\t']
        .into_iter()
        .find(|d| first.as_bytes().contains(d))
        .unwrap_or(b',')
}
