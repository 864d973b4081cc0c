//! What stands above the numbers of a file, or is said in its place.

use super::Reading;
use super::columns::{Columns, Named, is_count};
use super::read::CLOSE_QUOTE;
use crate::scene::csv::cell;
use crate::scene::csv::header::{self, Header};
use crate::scene::csv::lines::{Dialect, OPEN_QUOTE, span};
use crate::scene::number::counted;
use crate::scene::{Problem, unit};

/// Where the names of columns come from.
#[derive(Clone, Copy, PartialEq)]
enum NamedBy {
    Header,
    Option,
    /// The numbers of columns alone.
    Number,
}

/// What stands above the numbers of a file.
pub(super) struct Heading<'a> {
    text: &'a str,
    pub names: Vec<&'a str>,
    /// Units in a row below the names, or none.
    units: Vec<&'a str>,
    by: NamedBy,
    /// The row of the names, or the first one.
    row: &'a str,
    /// The byte at which the rows of numbers begin.
    pub start: usize,
}

impl<'a> Heading<'a> {
    pub fn of(
        text: &'a str,
        dialect: Dialect,
        reading: &'a Reading,
    ) -> Result<Heading<'a>, Problem> {
        let mut rows = dialect.rows(text).peekable();
        let row = rows.next().unwrap_or_default();
        let start = span(text, row).start;
        let located = |part: &str, field, what: &str, help| {
            let mut problem = Problem::new(field, what, help);
            problem.span = Some(span(text, part));
            problem
        };
        if let Some(quote) = Dialect::open_quote(row) {
            return Err(located(quote, "quote", OPEN_QUOTE, CLOSE_QUOTE));
        }
        let mut cells = dialect.list(row);
        // In either notation: a row of numbers is no header.
        let is_number = |cell: &&str| {
            [false, true]
                .into_iter()
                .any(|comma| cell::parse(cell, comma).is_ok())
        };
        let number = cells.iter().copied().find(is_number);
        let heading = |names, by| Heading {
            text,
            names,
            units: Vec::new(),
            by,
            row,
            start,
        };
        if let Some(given) = &reading.columns {
            let separator = [';', '\t'].into_iter().find(|c| given.contains(*c));
            let names = given.split(separator.unwrap_or(',')).map(str::trim);
            let help = "leave --columns out: it is for files without header";
            let with_header = || Problem::new("", "the file has a header", help);
            return number
                .map(|_| heading(names.collect(), NamedBy::Option))
                .ok_or_else(with_header);
        }
        let Some(number) = number else {
            while cells.len() > 1 && cells.last().is_some_and(|name| name.is_empty()) {
                cells.pop();
            }
            let is_bare = cells.iter().all(|cell| header::split(cell).unit.is_empty());
            let is_unit = |cell: &&str| {
                let bare = header::bare(cell);
                bare.is_empty() || unit::is_unit(bare) || is_count(bare)
            };
            let units = rows.next_if(|row| is_bare && dialect.list(row).iter().all(is_unit));
            let start = rows.peek().map_or(text.len(), |row| span(text, row).start);
            return Ok(Heading {
                units: units.map_or_else(Vec::new, |row| dialect.list(row)),
                start,
                ..heading(cells, NamedBy::Header)
            });
        };
        // What numpy and MATLAB write: the header as a comment.
        let mut above = text[..start].lines().rev();
        let comment = above
            .find(|line| !line.trim().is_empty())
            .unwrap_or_default();
        let names = dialect.list(comment.trim_start_matches(['#', '%', ';', ' ']));
        if dialect.is_comment(comment) && names.len() == cells.len() {
            let commented = heading(names, NamedBy::Header);
            if commented.columns(reading).is_ok() {
                return Ok(commented);
            }
        }
        if reading.time.is_some() && reading.motion.is_some() {
            return Ok(heading(vec![""; cells.len()], NamedBy::Number));
        }
        let what = format!("there is no header: `{number}` is a number");
        let help = "put a header above the numbers, as `t [s],theta [deg]`, or say what the columns are: --columns \"t [s],theta [deg]\", or --time \"1[s]\" --motion \"2[deg]\"";
        Err(located(number, "header", &what, help))
    }

    pub fn columns(&self, reading: &Reading) -> Result<Columns, Problem> {
        let named = |(at, raw): (usize, &&str)| {
            let Header { name, unit } = header::split(raw);
            let below = || header::bare(self.units.get(at).unwrap_or(&"")).to_owned();
            Named {
                at,
                raw: match self.by {
                    NamedBy::Number => (at + 1).to_string(),
                    _ => (*raw).to_owned(),
                },
                header: Header {
                    name,
                    unit: if unit.is_empty() { below() } else { unit },
                },
                span: (self.by == NamedBy::Header).then(|| span(self.text, raw)),
            }
        };
        let list: Vec<Named> = self.names.iter().enumerate().map(named).collect();
        Columns::find(&list, reading).map_err(|mut problem| {
            if self.by == NamedBy::Option {
                problem.what = format!("--columns: {}", problem.what);
            } else {
                let row = || span(self.text, self.row);
                problem.span.get_or_insert_with(row);
            }
            problem
        })
    }

    /// How many columns there are, for messages.
    pub fn counted(&self) -> String {
        let who = match self.by {
            NamedBy::Header => "the header",
            NamedBy::Option => "--columns",
            NamedBy::Number => "the first row",
        };
        format!("{who} has {}", counted(self.names.len(), "column"))
    }
}
