//! Heading of a data file: names and units above the numbers, or those that options give.

use super::Reading;
use super::columns::{Columns, Named, is_count};
use crate::scene::csv::cell;
use crate::scene::csv::header::{self, Header};
use crate::scene::csv::lines::{CLOSE_QUOTE, Dialect, OPEN_QUOTE, span};
use crate::scene::number::counted;
use crate::scene::{Problem, unit};

/// Source of the names of columns.
#[derive(Clone, Copy, PartialEq)]
enum NamedBy {
    Header,
    Option,
    /// Numbers of the columns, in the absence of names.
    Number,
}

/// Heading of a data file.
pub(super) struct Heading<'a> {
    pub text: &'a str,
    /// Division of the text into cells, and the beginning of the rows of numbers.
    pub dialect: Dialect,
    pub names: Vec<&'a str>,
    /// Units in a row below the names; empty without that row.
    units: Vec<&'a str>,
    by: NamedBy,
    /// Row of the names, or the first row.
    row: &'a str,
}

impl<'a> Heading<'a> {
    pub fn of(
        text: &'a str,
        dialect: Dialect,
        reading: &'a Reading,
    ) -> Result<Heading<'a>, Problem> {
        let row = dialect.rows(text).next().unwrap_or_default();
        if let Some(quote) = Dialect::open_quote(row) {
            return Err(Problem::new("quote", OPEN_QUOTE, CLOSE_QUOTE).at(span(text, quote)));
        }
        let cells = dialect.list(row);
        // Either decimal mark counts: a row of numbers is no header.
        let is_number =
            |cell: &&str| cell::parse(cell, false).is_ok() || cell::parse(cell, true).is_ok();
        let number = cells.iter().copied().find(is_number);
        let start = span(text, row).start;
        let mut heading = Heading {
            text,
            dialect: Dialect { start, ..dialect },
            names: cells,
            units: Vec::new(),
            by: NamedBy::Header,
            row,
        };
        match (&reading.columns, number) {
            (None, None) => Ok(heading.in_rows()),
            (None, Some(number)) => heading.above_numbers(number, reading),
            (Some(_), None) => {
                let help = "leave --columns out: it is for files without header";
                Err(Problem::new("", "the file has a header", help))
            }
            (Some(given), Some(_)) => {
                let separator = [';', '\t'].into_iter().find(|c| given.contains(*c));
                let names = given.split(separator.unwrap_or(',')).map(str::trim);
                (heading.names, heading.by) = (names.collect(), NamedBy::Option);
                Ok(heading)
            }
        }
    }

    /// Reads a row of names, and a row of units below it where the names have none.
    fn in_rows(mut self) -> Heading<'a> {
        let (text, dialect) = (self.text, self.dialect);
        let mut rows = dialect.rows(text).skip(1).peekable();
        while self.names.len() > 1 && self.names.last().is_some_and(|name| name.is_empty()) {
            self.names.pop();
        }
        let is_bare = |name: &&str| header::split(name).unit.is_empty();
        let is_unit = |cell: &&str| {
            let bare = header::bare(cell);
            bare.is_empty() || unit::is_unit(bare) || is_count(bare)
        };
        let are_bare = self.names.iter().all(is_bare);
        let units = rows.next_if(|row| are_bare && dialect.list(row).iter().all(is_unit));
        self.units = units.map_or_else(Vec::new, |row| dialect.list(row));
        let start = rows.peek().map(|row| span(text, row).start);
        self.dialect.start = start.unwrap_or(text.len());
        self
    }

    /// Reads a header in a comment above the numbers (numpy, MATLAB), or goes without where options name the columns.
    fn above_numbers(mut self, number: &str, reading: &Reading) -> Result<Heading<'a>, Problem> {
        let (count, dialect) = (self.names.len(), self.dialect);
        let mut above = self.text[..dialect.start].lines().rev();
        let comment = above.find(|line| !line.trim().is_empty());
        let comment = comment.filter(|line| dialect.is_comment(line));
        self.names = comment.map_or_else(Vec::new, |line| {
            dialect.list(line.trim_start_matches(['#', '%', ';', ' ']))
        });
        if self.names.len() == count && self.columns(reading).is_ok() {
            return Ok(self);
        }
        if reading.time.is_some() && reading.motion.is_some() {
            (self.names, self.by) = (vec![""; count], NamedBy::Number);
            return Ok(self);
        }
        let what = format!("there is no header: `{number}` is a number");
        let help = "put a header above the numbers, as `t [s],theta [deg]`, or say what the columns are: --columns \"t [s],theta [deg]\", or --time \"1[s]\" --motion \"2[deg]\"";
        Err(Problem::new("header", what, help).at(span(self.text, number)))
    }

    /// Finds the columns of time and motion.
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

    /// Describes the number of columns, for messages.
    pub fn counted(&self) -> String {
        let who = match self.by {
            NamedBy::Header => "the header",
            NamedBy::Option => "--columns",
            NamedBy::Number => "the first row",
        };
        format!("{who} has {}", counted(self.names.len(), "column"))
    }
}
