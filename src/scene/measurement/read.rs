//! Reads measured motion from text files.

use std::path::Path;

use super::columns::{Columns, MOST_COLUMNS};
use super::heading::Heading;
use super::listed::Listed;
use super::{Beside, BesideColumn, Measured, Measurement, Reading, SampleFile};
use crate::numeric::parallel;
use crate::scene::csv::Column;
use crate::scene::csv::cell::{self, LACKS_VALUE, NotANumber};
use crate::scene::csv::lines::{CLOSE_QUOTE, Dialect, OPEN_QUOTE, line_number, span};
use crate::scene::digits::Digits;
use crate::scene::number::counted;
use crate::scene::text::with_line_feeds;
use crate::scene::{Problem, Problems};

/// Remedy for a cell that lacks a value.
const GAP: &str = "give a number, or take the row out; --missing NaN takes such rows as gaps, --missing \"\" those with empty cells";

/// Reads the samples of a file as numbers, not yet checked against each other.
pub(super) fn measurement(
    file: &Path,
    text: String,
    reading: &Reading,
) -> Result<Measurement, Problems> {
    let text = with_line_feeds(text);
    let dialect = Dialect::of(&text, reading.skip);
    let failed = |problem: Problem| Problems::in_file(file, &text, vec![problem]);
    if reading.decimal_comma && dialect.delimiter == ',' {
        let what = "commas cannot be decimal and separate the columns";
        let help = "separate the columns by semicolon or tab";
        return Err(failed(Problem::new("", what, help)));
    }
    if dialect.rows(&text).next().is_none() {
        let help = "give rows of time and motion below a header, as `t [s],theta [deg]`";
        return Err(failed(Problem::new("", "the file is empty", help)));
    }
    let heading = Heading::of(&text, dialect, reading).map_err(failed)?;
    let columns = heading.columns(reading).map_err(failed)?;
    let dialect = heading.dialect;
    let rows = SampleRows {
        heading: &heading,
        columns: &columns,
        reading,
    };
    let samples = rows.samples();
    let mut notes = columns.notes;
    if let Some(first) = samples.left_out.first() {
        let rows = counted(samples.left_out.len(), "row");
        let (name, line) = (columns.measured.name(), line_number(&text, &text[*first..]));
        notes.push(format!(
            "{rows} without time or {name} left out, the first in line {line}"
        ));
    }
    if let Some(list) = samples.wrong.refused(&text) {
        return Err(Problems::in_file(file, &text, list));
    }
    let (_, value) = columns.others[0].clone();
    let step = match value.is_counts() {
        true => 1.0,
        false => samples.digits.step(&samples.columns[1]),
    };
    let mut lists = samples.columns.into_iter();
    let mut next = |column: &Column, zero: f64| {
        let mut values = lists.next().unwrap_or_default();
        values
            .iter_mut()
            .for_each(|v| *v = *v * column.factor - zero);
        values
    };
    let times = next(&columns.time, 0.0);
    let others = columns.others.into_iter().map(|(beside, column)| {
        let is_x = beside == Beside::Sensor(Measured::X);
        let values = next(&column, if is_x { reading.x_zero } else { 0.0 });
        BesideColumn { beside, values }
    });
    let mut beside: Vec<BesideColumn> = others.collect();
    let values = beside.remove(0).values;
    Ok(Measurement {
        resolution: value.factor * step,
        beside,
        notes,
        time: columns.time,
        value,
        source: Some(SampleFile {
            file: file.to_owned(),
            dialect,
            at: [columns.at[0], columns.at[1]],
            reading: reading.clone(),
            text,
        }),
        ..Measurement::raw(columns.measured, times, values)
    })
}

/// Numbers of each column, precision of the printed values, and problems.
struct Samples {
    columns: Vec<Vec<f64>>,
    digits: Digits,
    /// Begin in the text of each row without time or motion.
    left_out: Vec<usize>,
    wrong: Listed,
}

impl Samples {
    fn with_room_for(count: usize, columns: usize) -> Samples {
        Samples {
            columns: vec![Vec::with_capacity(count); columns],
            digits: Digits::EMPTY,
            left_out: Vec::new(),
            wrong: Listed::default(),
        }
    }
}

struct SampleRows<'a> {
    heading: &'a Heading<'a>,
    columns: &'a Columns,
    reading: &'a Reading,
}

impl SampleRows<'_> {
    /// Reads the samples of all rows, in pieces of whole lines in parallel.
    fn samples(&self) -> Samples {
        let piece_bytes = 1 << 18;
        let Heading { text, dialect, .. } = self.heading;
        let mut rest = &text[dialect.start..];
        let mut all = Samples::with_room_for(rest.len() / 16, self.columns.at.len());
        let pieces = std::iter::from_fn(|| {
            let from = rest.len().min(piece_bytes);
            let end = rest.bytes().skip(from).position(|byte| byte == b'\n');
            let (piece, after) = rest.split_at(end.map_or(rest.len(), |at| from + at + 1));
            rest = after;
            (!piece.is_empty()).then_some(piece)
        });
        let samples_of = |piece: &str| {
            let mut samples = Samples::with_room_for(0, self.columns.at.len());
            let rows = dialect.rows_of(piece);
            rows.for_each(|row| self.read(row, &mut samples));
            samples
        };
        for found in parallel::map(pieces, samples_of) {
            for (all, more) in all.columns.iter_mut().zip(found.columns) {
                all.extend(more);
            }
            all.digits = all.digits.or(found.digits);
            all.left_out.extend(found.left_out);
            all.wrong.join(found.wrong);
        }
        all
    }

    fn read(&self, row: &str, samples: &mut Samples) {
        let (mut found, mut count, mut excess) = ([""; MOST_COLUMNS], 0, false);
        let (wanted, expected) = (&self.columns.at, self.heading.names.len());
        let Heading { text, dialect, .. } = self.heading;
        let found = &mut found[..wanted.len()];
        for (at, cell) in dialect.cells(row).enumerate() {
            for (mine, wanted) in found.iter_mut().zip(wanted) {
                if at == *wanted {
                    *mine = cell;
                }
            }
            count = at + 1;
            excess |= count > expected && !cell.is_empty();
        }
        let mut wrong = |field: &str, part: &str, what: String, help: &str| {
            let problem = Problem::new(field, what, help).at(span(text, part));
            samples.wrong.push(problem);
        };
        if let Some(quote) = Dialect::open_quote(row) {
            return wrong("quote", quote, OPEN_QUOTE.to_owned(), CLOSE_QUOTE);
        }
        if count < expected || excess {
            let values = counted(count, "value");
            let what = format!("{values} where {}", self.heading.counted());
            let help = if excess && dialect.delimiter == ',' {
                "give one value for each column; where numbers have decimal commas, separate the columns by semicolon or tab"
            } else {
                "give one value for each column; leave no quote open"
            };
            return wrong("row", row, what, help);
        }
        let is_missing = |cell: &&str| self.reading.is_missing(cell);
        if found[..2].iter().any(is_missing) {
            return samples.left_out.push(span(text, row).start);
        }
        let mut numbers = [f64::NAN; MOST_COLUMNS];
        let mut is_right = true;
        let decimal_comma = self.reading.decimal_comma;
        for (k, cell) in found.iter().enumerate() {
            let parsed = match is_missing(cell) {
                // Time and motion are there.
                true if matches!(self.columns.others[k - 1].0, Beside::Sensor(_)) => continue,
                true => Err(NotANumber {
                    what: "the value is missing".to_owned(),
                    help: "give a known torque or force in every row",
                }),
                false => cell::parse(cell, decimal_comma),
            };
            match parsed {
                Ok(number) => numbers[k] = number,
                Err(NotANumber { what, help }) => {
                    let name = ["time", self.columns.measured.name(), "value"][k.min(2)];
                    let help = if help == LACKS_VALUE { GAP } else { help };
                    wrong(name, cell, what, help);
                    is_right = false;
                }
            }
        }
        if is_right {
            for (list, number) in samples.columns.iter_mut().zip(numbers) {
                list.push(number);
            }
            let text = cell::with_point(found[1], decimal_comma);
            samples.digits = samples.digits.or(Digits::of(&text.unwrap_or_default()));
        }
    }
}
