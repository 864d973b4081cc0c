//! Common interface of reports: from one result to text, CSV, picture and page.

use super::curves::View;
use super::default_view::DefaultView;
use super::key_values::Facts;
use super::output::Output;
use super::page::{self, Origin};
use super::table::Table;
use crate::error::Error;

/// Result that can be shown as text, CSV, picture and page.
pub trait Report {
    /// Returns the facts of the result.
    fn facts(&self) -> Facts;

    /// Returns the result as text.
    fn text(&self) -> String;

    /// Returns the rows as a table of columns.
    fn table(&self) -> Table;

    /// Returns the default content of picture and page.
    fn default_view(&self) -> DefaultView<'_>;

    /// Writes the rows as CSV.
    fn csv(&self, output: Output) -> Result<(), Error> {
        self.table().csv(output)
    }

    /// Returns the columns of a view as SVG. Refused if a column is missing, or the picture is too small.
    fn figure(&self, view: &View) -> Result<String, Error> {
        view.svg(&self.table(), self.default_view())
    }

    /// Returns the static figures of the page, as SVG.
    fn page_figures(&self) -> Result<Vec<String>, Error> {
        Ok(Vec::new())
    }

    /// Returns the result as one HTML page.
    fn page(&self, origin: &Origin) -> Result<String, Error> {
        let default = DefaultView {
            figures: self.page_figures()?,
            ..self.default_view()
        };
        page::html(origin, &self.facts(), &self.table(), &default)
    }
}

/// Returns a value as indented JSON, with a final line feed.
pub fn json(value: &impl serde::Serialize) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(value).map_err(std::io::Error::from);
    Ok(text.map_err(Error::write("JSON"))? + "\n")
}
