//! Measured motion from files of text.

use std::path::Path;

use super::clock::Decimal;
use super::columns::{ColumnProblem, Columns, columns};
use super::headers::{is_count, named};
use super::lines::{Dialect, span};
use super::listed::{list, more};
use super::number::{Digits, parse, with_point};
use super::source::Source;
use super::{Measurement, Reading};
use crate::numeric::parallel;
use crate::scene::number::counted;
use crate::scene::table::header;
use crate::scene::table::pairs::OPEN_QUOTE;
use crate::scene::text::with_line_feeds;
use crate::scene::{Problem, Problems, unit};

const CLOSE_QUOTE: &str = "write numbers without quotes, and each row on a line of its own";

/// Bytes of a piece of text that a thread reads at a time, about.
const PIECE: usize = 1 << 18;

/// A file's samples, each a number, not yet checked against each other.
pub(super) fn measurement(
    file: &Path,
    text: String,
    reading: &Reading,
) -> Result<Measurement, Problems> {
    let text = with_line_feeds(text);
    let dialect = Dialect::of(&text, reading.skip);
    let failed = |problem: Problem| Problems::in_file(file, &text, vec![problem]);
    if reading.decimal_comma && dialect.delimiter == ',' {
        let help = "separate the columns by semicolon or tab";
        return Err(failed(Problem::new(
            "",
            "commas cannot be decimal and separate the columns",
            help,
        )));
    }
    if dialect.rows(&text).next().is_none() {
        let help = "give rows of time and motion below a header, as `t [s],theta [deg]`";
        return Err(failed(Problem::new("", "the file is empty", help)));
    }
    let (columns, start) = heading(&text, dialect, reading).map_err(failed)?;
    let mut found = samples(&text[start..], dialect, &columns);
    if !found.problems.is_empty() {
        return Err(found.refused(file, &text, start));
    }
    let step = match columns.value.unit.as_str() {
        "counts" => 1.0,
        _ => found.digits.step(),
    };
    let mut measurement = Measurement {
        measured: columns.measured,
        times: found.times,
        elapsed: None,
        origin: 0.0,
        spacing: 0.0,
        values: found.values,
        resolution: columns.value.factor * step,
        notes: columns.notes,
        source: Some(Source {
            file: file.to_owned(),
            dialect: Dialect { start, ..dialect },
            columns: columns.at,
            time: columns.time,
            value: columns.value,
            text,
        }),
    };
    if columns.is_clock {
        measurement.elapsed = measurement.since_first_row();
        measurement.times = measurement.elapsed.take().unwrap_or_default();
    }
    Ok(measurement)
}

/// The columns of a text, and the byte at which their rows begin.
fn heading(text: &str, dialect: Dialect, reading: &Reading) -> Result<(Columns, usize), Problem> {
    let is_value =
        |cell: &str| parse(cell, reading.decimal_comma).is_ok() || Decimal::of(cell).is_some();
    let mut rows = dialect.rows(text).peekable();
    let above = rows.next().unwrap_or_default();
    let mut cells = dialect.list(above);
    let start = span(text, above).start;
    if let Some(quote) = Dialect::open_quote(above) {
        let mut problem = Problem::new("quote", OPEN_QUOTE, CLOSE_QUOTE);
        problem.span = Some(span(text, quote));
        return Err(problem);
    }
    let number = cells.iter().position(|cell| is_value(cell));
    let found = |names: &[&str], units: &[&str], first: &[&str]| {
        columns(&named(names, units, first), reading)
    };
    let placed = |found: ColumnProblem| {
        let mut problem = Problem::new("header", found.what, found.help);
        let part = found
            .column
            .and_then(|at| dialect.list(above).get(at).copied());
        problem.span = Some(span(text, part.unwrap_or(above)));
        problem
    };
    if let Some(given) = &reading.columns {
        let separator = [';', '\t']
            .into_iter()
            .find(|c| given.contains(*c))
            .unwrap_or(',');
        let names: Vec<&str> = given.split(separator).map(str::trim).collect();
        let columns = found(&names, &[], &cells).map_err(|found| {
            Problem::new("header", format!("--columns: {}", found.what), found.help)
        })?;
        let help = "leave --columns out: it is for files without header";
        let with_header = || Problem::new("", "the file has a header", help);
        return number.map(|_| (columns, start)).ok_or_else(with_header);
    }
    let Some(number) = number else {
        while cells.len() > 1 && cells.last().is_some_and(|name| name.is_empty()) {
            cells.pop();
        }
        let is_bare = cells.iter().all(|cell| header::split(cell).unit.is_empty());
        let is_unit = |cell: &&str| {
            unit::is_unit(header::bare(cell)) || cell.is_empty() || is_count(header::bare(cell))
        };
        let units = rows.next_if(|row| is_bare && dialect.list(row).iter().all(is_unit));
        let units = units.map(|row| dialect.list(row)).unwrap_or_default();
        let first = rows.peek().copied();
        let columns =
            found(&cells, &units, &dialect.list(first.unwrap_or_default())).map_err(placed)?;
        return Ok((
            columns,
            first.map_or(text.len(), |row| span(text, row).start),
        ));
    };
    // What numpy and MATLAB write: the header as a comment.
    let comment = text[..start]
        .lines()
        .rfind(|line| !line.trim().is_empty())
        .unwrap_or_default();
    let names = dialect.list(comment.trim_start_matches(['#', '%', ';', ' ']));
    if dialect.is_comment(comment)
        && names.len() == cells.len()
        && let Ok(columns) = found(&names, &[], &cells)
    {
        return Ok((columns, start));
    }
    if reading.time.is_some() && reading.motion.is_some() {
        return Ok((found(&[], &[], &cells).map_err(placed)?, start));
    }
    Err(placed(ColumnProblem {
        column: Some(number),
        what: format!("there is no header: `{}` is a number", cells[number]),
        help: "put a header above the numbers, as `t [s],theta [deg]`, or say what the columns are: --columns \"t [s],theta [deg]\", or --time \"1[s]\" --motion \"2[deg]\"".to_owned(),
    }))
}

/// Times, values, how finely these are printed, and what is wrong.
#[derive(Default)]
struct Samples {
    times: Vec<f64>,
    values: Vec<f64>,
    digits: Digits,
    /// With places in the text of the rows.
    problems: Vec<Problem>,
    /// All problems, listed or not.
    wrong: usize,
}

/// The samples of rows, read in pieces of whole lines side by side.
fn samples(rows: &str, dialect: Dialect, columns: &Columns) -> Samples {
    let mut pieces = Vec::new();
    let mut rest = rows;
    while !rest.is_empty() {
        let from = PIECE.min(rest.len());
        let end = rest.as_bytes()[from..]
            .iter()
            .position(|byte| *byte == b'\n');
        let (piece, after) = rest.split_at(end.map_or(rest.len(), |at| from + at + 1));
        pieces.push(piece);
        rest = after;
    }
    let count = rows.len() / 16;
    let mut all = Samples {
        times: Vec::with_capacity(count),
        values: Vec::with_capacity(count),
        ..Samples::default()
    };
    for found in parallel::map(pieces.into_iter(), |piece| {
        samples_of(rows, piece, dialect, columns)
    }) {
        all.times.extend(found.times);
        all.values.extend(found.values);
        all.digits.join(&found.digits);
        all.wrong += found.wrong;
        for problem in found.problems {
            list(&mut all.problems, problem);
        }
    }
    all
}

fn samples_of(rows: &str, piece: &str, dialect: Dialect, columns: &Columns) -> Samples {
    let mut samples = Samples::default();
    for row in dialect.rows_of(piece) {
        let (mut pair, mut count, mut excess) = ([""; 2], 0, false);
        for (at, cell) in dialect.cells(row).enumerate() {
            for (mine, wanted) in pair.iter_mut().zip(columns.at) {
                if at == wanted {
                    *mine = cell;
                }
            }
            count = at + 1;
            excess |= count > columns.count && !cell.is_empty();
        }
        let mut wrong = |field: &str, part: &str, what: String, help: &str| {
            samples.wrong += 1;
            let mut problem = Problem::new(field, what, help);
            problem.span = Some(span(rows, part));
            list(&mut samples.problems, problem);
        };
        if let Some(quote) = Dialect::open_quote(row) {
            wrong("quote", quote, OPEN_QUOTE.to_owned(), CLOSE_QUOTE);
            continue;
        }
        if count < columns.count || excess {
            let what = format!("{} where {}", counted(count, "value"), columns.counted);
            let help = match dialect.delimiter {
                ',' if excess => {
                    "give one value for each column; where numbers have decimal commas, separate the columns by semicolon or tab"
                }
                _ => "give one value for each column; leave no quote open",
            };
            wrong("row", row, what, help);
            continue;
        }
        let time = match columns.is_clock {
            true => Decimal::of(pair[0]).map(|_| 0.0).ok_or_else(|| {
                (
                    format!("`{}` is no time", pair[0]),
                    "give a date and an hour, as the rows above",
                )
            }),
            false => {
                parse(pair[0], columns.decimal_comma).map_err(|wrong| (wrong.what, wrong.help))
            }
        };
        let value = parse(pair[1], columns.decimal_comma);
        match (time, value) {
            (Ok(time), Ok(value)) => {
                samples.times.push(time * columns.time.factor);
                samples
                    .values
                    .push(value * columns.value.factor - columns.zero);
                let text = with_point(pair[1], columns.decimal_comma);
                samples.digits.take(value, &text.unwrap_or_default());
            }
            (time, value) => {
                if let Err((what, help)) = time {
                    wrong("time", pair[0], what, help);
                }
                if let Err(found) = value {
                    wrong(columns.measured.name(), pair[1], found.what, found.help);
                }
            }
        }
    }
    samples
}

impl Samples {
    /// All problems of rows that begin at a byte of a text.
    fn refused(&mut self, file: &Path, text: &str, rows: usize) -> Problems {
        let mut problems = std::mem::take(&mut self.problems);
        for span in problems
            .iter_mut()
            .filter_map(|problem| problem.span.as_mut())
        {
            *span = span.start + rows..span.end + rows;
        }
        problems.extend(more(self.wrong - problems.len(), text));
        Problems::in_file(file, text, problems)
    }
}
