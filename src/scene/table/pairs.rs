//! Two columns of numbers under a header, as text with the lines they stand in.

use crate::scene::csv::cell;
use crate::scene::csv::lines::{Dialect, OPEN_QUOTE, line_number};
use crate::scene::number::counted;

/// A CSV text of two columns.
pub(super) struct Pairs<'a> {
    name: &'a str,
    text: &'a str,
    dialect: Dialect,
}

/// Two numbers and the row they stand in.
pub(super) struct Pair<'a> {
    pub x: f64,
    pub y: f64,
    #[cfg_attr(not(feature = "cli"), expect(dead_code))]
    pub row: &'a str,
}

impl<'a> Pairs<'a> {
    /// A text; `name` begins the messages.
    pub fn new(name: &'a str, text: &'a str) -> Pairs<'a> {
        let dialect = Dialect::of(text, 0);
        Pairs {
            name,
            text,
            dialect,
        }
    }

    fn rows(&self) -> impl Iterator<Item = &'a str> {
        self.dialect.rows(self.text)
    }

    /// The two cells of the header.
    ///
    /// # Errors
    /// What is wrong, with its place.
    pub fn header(&self, expected: &str) -> Result<[&'a str; 2], String> {
        let row = self.rows().next().unwrap_or_default();
        let wrong = |what: String| Err(self.at(row, &what));
        if Dialect::open_quote(row).is_some() {
            return wrong(OPEN_QUOTE.to_owned());
        }
        match self.dialect.list(row)[..] {
            [x, y] if [x, y].iter().all(|cell| cell.parse::<f64>().is_err()) => Ok([x, y]),
            [_, _] => wrong(format!(
                "the first line must name the columns with their units, as `{expected}`"
            )),
            [""] => wrong("the file is empty".to_owned()),
            ref cells => wrong(format!(
                "{} where 2 are expected, as `{expected}`",
                counted(cells.len(), "column")
            )),
        }
    }

    /// What is wrong with a row, after its place.
    pub fn at(&self, row: &str, what: &str) -> String {
        format!("{} line {}: {what}", self.name, line_number(self.text, row))
    }

    /// The numbers below the header.
    ///
    /// # Errors
    /// What is wrong, with its place.
    pub fn numbers(&self) -> Result<Vec<Pair<'a>>, String> {
        self.rows().skip(1).map(|row| self.pair(row)).collect()
    }

    fn pair(&self, row: &'a str) -> Result<Pair<'a>, String> {
        if Dialect::open_quote(row).is_some() {
            return Err(self.at(row, OPEN_QUOTE));
        }
        let cells = self.dialect.list(row);
        let [x, y] = cells[..] else {
            let what = format!("{} where 2 are expected", counted(cells.len(), "value"));
            return Err(self.at(row, &what));
        };
        let number = |column: usize, text: &str| {
            cell::parse(text, false).map_err(|wrong| {
                let line = line_number(self.text, row);
                format!("{} line {line} column {column}: {}", self.name, wrong.what)
            })
        };
        Ok(Pair {
            x: number(1, x)?,
            y: number(2, y)?,
            row,
        })
    }
}
