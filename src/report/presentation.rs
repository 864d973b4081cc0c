//! A result for its readers.

use super::curves::View;
use super::key_values::Facts;
use super::look::Look;
use super::output::Output;
use super::page::{self, Origin};
use super::table::Table;
use crate::error::Error;

/// A result for its readers.
pub trait Report {
    /// What there is to say of the result.
    fn facts(&self) -> Facts;

    /// What there is to say, as text.
    fn text(&self) -> String;

    /// The rows by columns.
    fn table(&self) -> Table;

    /// What is seen of the rows.
    fn look(&self) -> Look<'_>;

    /// Writes the rows as CSV.
    ///
    /// # Errors
    /// [`Error::Write`].
    fn csv(&self, output: Output) -> Result<(), Error> {
        self.table().csv(output)
    }

    /// What is to be seen of the rows, as SVG.
    ///
    /// # Errors
    /// [`Error::Refused`] if a column is not there, or no room.
    fn figure(&self, view: &View) -> Result<String, Error> {
        view.svg(&self.table(), self.look())
    }

    /// The result as one HTML page.
    ///
    /// # Errors
    /// [`Error::Write`].
    fn page(&self, origin: &Origin) -> Result<String, Error> {
        page::html(origin, &self.facts(), &self.table(), &self.look())
    }
}

/// A value as one JSON object, with a line break at its end.
pub fn json(value: &impl serde::Serialize) -> Result<String, Error> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| Error::Write {
        target: "JSON".to_owned(),
        source: error.into(),
    })?;
    text.push('\n');
    Ok(text)
}
