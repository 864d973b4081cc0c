//! Measured motion from CSV files.

use std::path::Path;

use csv::ByteRecord;

use super::columns::{Columns, columns, with_point};
use super::digits::Digits;
use super::plain;
use super::source::{Records, Source, cell, line_at, no_value};
use super::{Measurement, Reading};
use crate::scene::number::{self, counted};
use crate::scene::table::pairs::{OPEN_QUOTE, delimiter, open_quote};
use crate::scene::text::with_line_feeds;
use crate::scene::{Problem, Problems};

/// Problems of one kind that are listed; all are counted.
pub(super) const MOST_LISTED: usize = 3;

/// A file's samples, each a number, not yet checked against each other.
pub(super) fn measurement(
    file: &Path,
    text: String,
    reading: &Reading,
) -> Result<Measurement, Problems> {
    let text = with_line_feeds(text);
    let (has_header, delimiter) = (reading.columns.is_none(), delimiter(&text));
    let wrong =
        |what: &str, help: &str| Problems::in_file(file, &text, vec![Problem::new("", what, help)]);
    if reading.decimal_comma && delimiter == b',' {
        let help = "separate the columns by semicolon or tab";
        return Err(wrong(
            "commas cannot be decimal and separate the columns",
            help,
        ));
    }
    let mut records = Records::new(&text, delimiter);
    if !records.next() {
        let help = "give rows of time and motion below a header, as `t [s],theta [deg]`";
        return Err(wrong("the file is empty", help));
    }
    if runs_on(&records.record) {
        return Err(Problems::in_file(file, &text, vec![unclosed(&text, 0)]));
    }
    let (header, body) = match &reading.columns {
        Some(_) if columns(&records.record, reading).is_ok() => {
            let help = "leave --columns out: it is for files without header";
            return Err(wrong("the file has a header", help));
        }
        Some(given) => (split(given), 0),
        None => (records.record.clone(), records.end()),
    };
    let columns = columns(&header, reading).map_err(|found| {
        let mut problem = Problem::new("header", found.what, found.help);
        match &reading.columns {
            Some(_) => problem.what = format!("--columns: {}", problem.what),
            None => {
                let whole = line_at(&text, body);
                let part = found.column.map(|at| cell(&text, body, delimiter, at));
                problem.span = Some(part.unwrap_or(whole));
            }
        }
        Problems::in_file(file, &text, vec![problem])
    })?;
    let rows = text.get(body..);
    let plain = rows.and_then(|rows| plain::samples(rows, delimiter, &columns));
    let (times, values, digits) = match plain {
        Some(samples) => samples,
        None => samples(file, &text, delimiter, has_header, &columns)?,
    };
    let resolution = columns.value.factor * digits.step();
    Ok(Measurement {
        measured: columns.measured,
        times,
        elapsed: None,
        origin: 0.0,
        spacing: 0.0,
        values,
        resolution,
        notes: columns.note.into_iter().collect(),
        source: Some(Source {
            file: file.to_owned(),
            delimiter,
            has_header,
            columns: columns.at,
            time: columns.time,
            value: columns.value,
            text,
        }),
    })
}

/// The cells of a header given as an option.
fn split(header: &str) -> ByteRecord {
    let separator = [';', '\t'].into_iter().find(|c| header.contains(*c));
    header
        .split(separator.unwrap_or(','))
        .map(str::trim)
        .collect::<Vec<_>>()
        .into()
}

/// Times, values, and how finely these are printed.
pub(super) type Samples = (Vec<f64>, Vec<f64>, Digits);

/// The samples of a file, or all that is wrong with it.
fn samples(
    file: &Path,
    text: &str,
    delimiter: u8,
    has_header: bool,
    columns: &Columns,
) -> Result<Samples, Problems> {
    let mut records = Records::new(text, delimiter);
    if has_header {
        records.next();
    }
    let (mut times, mut values, mut digits) = (Vec::new(), Vec::new(), Digits::default());
    let mut problems = without_values(text, delimiter);
    let mut count = problems.len();
    problems.truncate(MOST_LISTED);
    let names = ["time", columns.measured.name()];
    let mut before = records.end();
    while records.next() {
        let (record, end) = (&records.record, records.end());
        let mut wrong = |column: Option<usize>, field: &str, what: String, help: String| {
            count += 1;
            let mut problem = Problem::new(field, what, help);
            let alike = |other: &&Problem| other.field == field && other.help == problem.help;
            if problems.iter().filter(alike).count() < MOST_LISTED {
                problem.span = Some(match column {
                    Some(column) => cell(text, end, delimiter, column),
                    None => line_at(text, end),
                });
                problems.push(problem);
            }
        };
        if runs_on(record) {
            count += 1;
            problems.push(unclosed(text, before));
            break;
        }
        before = end;
        if record.len() != columns.count {
            let what = format!(
                "{} where {} {}",
                counted(record.len(), "value"),
                if has_header {
                    "the header has"
                } else {
                    "--columns has"
                },
                counted(columns.count, "column")
            );
            let help = match delimiter {
                b',' if record.len() > columns.count => {
                    "give one value for each column; where numbers have decimal commas, separate the columns by semicolon or tab"
                }
                _ => "give one value for each column; leave no quote open",
            };
            wrong(None, "row", what, help.to_owned());
            continue;
        }
        let mut pair = [f64::NAN; 2];
        for (value, (column, name)) in pair.iter_mut().zip(columns.at.into_iter().zip(names)) {
            match parse(&record[column], columns) {
                Ok(found) => *value = found,
                Err((what, help)) => wrong(Some(column), name, what, help),
            }
        }
        let [time, value] = pair;
        times.push(time * columns.time.factor);
        values.push(value * columns.value.factor);
        let cell = std::str::from_utf8(&record[columns.at[1]])
            .unwrap_or_default()
            .trim();
        digits.take(
            value,
            with_point(cell, columns).unwrap_or_default().as_bytes(),
        );
    }
    problems.extend(more(count - problems.len(), text));
    if problems.is_empty() {
        Ok((times, values, digits))
    } else {
        Err(Problems::in_file(file, text, problems))
    }
}

/// How many problems there are beside those that are listed, if any.
pub(super) fn more(count: usize, text: &str) -> Option<Problem> {
    (count > 0).then(|| {
        let what = format!("{} more like these", counted(count, "problem"));
        let mut last = Problem::new("", what, "repair the data, or take the rows out");
        last.span = Some(text.len()..text.len());
        last
    })
}

/// Rows that begin with what spreadsheets write where a formula has no value.
fn without_values(text: &str, delimiter: u8) -> Vec<Problem> {
    let mut start = 0;
    let mut problems = Vec::new();
    for line in text.split_inclusive('\n') {
        if let Some(mark) = no_value(line, delimiter) {
            let (what, help) = not_a_number(mark);
            let mut problem = Problem::new("row", what, help);
            problem.span = Some(start..start + mark.len());
            problems.push(problem);
        }
        start += line.len();
    }
    problems
}

/// A value that goes on over the end of its line, in the record that begins at or after a byte.
fn unclosed(text: &str, from: usize) -> Problem {
    let at = open_quote(text, from);
    let help = "write numbers without quotes, and each row on a line of its own";
    let mut problem = Problem::new("quote", OPEN_QUOTE, help);
    problem.span = Some(at..at + 1);
    problem
}

/// Whether a value of a record goes on over the end of its line.
fn runs_on(record: &ByteRecord) -> bool {
    record.iter().any(|cell| cell.contains(&b'\n'))
}

/// A number, or what is wrong with it and what would be right.
fn parse(cell: &[u8], columns: &Columns) -> Result<f64, (String, String)> {
    let whole = std::str::from_utf8(cell).unwrap_or_default().trim();
    let Some(text) = with_point(whole, columns) else {
        return Err((
            format!("`{whole}` has a point where numbers have decimal commas"),
            "write every number with a decimal comma and without separators of thousands"
                .to_owned(),
        ));
    };
    let text = text.as_ref();
    let parsed = text.parse::<f64>().or_else(|_| number::plain(text).parse());
    match parsed {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err((
            format!("`{text}` is not a finite number"),
            "give a number, or take the row out".to_owned(),
        )),
        Err(_) => Err(not_a_number(whole)),
    }
}

fn not_a_number(text: &str) -> (String, String) {
    if text.is_empty() {
        return (
            "the value is missing".to_owned(),
            "give a number, or take the row out".to_owned(),
        );
    }
    if text.replacen(',', ".", 1).parse::<f64>().is_ok() {
        return (
            format!("`{text}` has a decimal comma where a point is expected"),
            "write decimal points, or say so with --decimal comma if semicolons or tabs separate the columns".to_owned(),
        );
    }
    let separates = |c: char| matches!(c, ',' | '\'' | '_') || c.is_whitespace();
    if text.replace(separates, "").parse::<f64>().is_ok() {
        let help = "write numbers without separators of thousands".to_owned();
        return (format!("`{text}` is not a plain number"), help);
    }
    let digits = number::length(text.trim_start_matches(['+', '-', number::MINUS]));
    let help = if digits > 0 {
        "write the number alone, as 12.5 or 1.25e1; units belong in the header"
    } else {
        "give a number; units belong in the header, comments begin with #"
    };
    (format!("`{text}` is not a number"), help.to_owned())
}
