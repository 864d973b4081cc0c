//! Results on paper: CSV rows, text, figures, JSON. Knows neither mechanics nor integrators.
//!
//! A [`Report`] describes a result once: what there is to say of it, its rows, and what is seen of these. Text, CSV file,
//! picture and page follow.

mod calibration;
mod columns;
mod compare;
mod csv;
mod curves;
mod decimate;
mod diagrams;
mod drawing;
mod explain;
mod figure;
mod identify;
mod inverse;
mod key_values;
mod motion;
mod one_turn;
mod optimise;
mod output;
mod page;
mod picture;
mod precision;
mod quantity;
mod reproduce;
mod rows;
mod run;
mod sketch;
mod statics;
mod sweep;
mod synthesis;
mod table;
mod text;

pub use calibration::calibration;
pub use compare::{Comparison, Motion};
pub use curves::View;
pub use diagrams::Diagram;
pub use explain::explanation;
pub use figure::{Axis, Figure, Shape, Sheet};
pub use identify::{identification, identification_csv};
pub use inverse::{
    inverse, inverse_figure, inverse_page, inverse_rows, inverse_table, mean_cycle, residual_table,
    residuals,
};
pub use key_values::Facts;
pub use motion::{PlotRows, RunReport};
pub use one_turn::{TurnReport, sized};
pub use optimise::{optimum, starts_csv};
pub use output::{Output, is_standard_output};
pub use page::Origin;
pub use picture::{ENDINGS, Picture};
pub use precision::{precision, precision_csv, precision_figure, precision_notes, precision_page};
pub use reproduce::{ReproductionSummary, file_name, reproduction, reproduction_csv};
pub use reproduce::{drawing_csv, drawing_svg};
pub use rows::{Preview, RowColumns, RowWriter};
pub use sketch::{Pose, Sketch, animation};
pub use statics::StaticsReport;
pub use sweep::{
    FrontDesign, MOST_ON_PAGE, Spread, SweepAsked, SweepExtreme, SweepRange, SweepSummary,
    SweepWriter, VariedKey, merge, sweep_page, sweep_text,
};
pub use synthesis::{synthesis, synthesis_scene};
pub use table::{Cells, Table};

use crate::error::Error;
use crate::scene::Scene;
use crate::simulate::Summary;
use page::Scatter;

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

/// What a picture and a page show of rows by themselves.
#[derive(Default)]
pub struct Look<'a> {
    /// Above a picture.
    title: &'a str,
    /// Columns of a picture.
    show: &'a [&'a str],
    /// Column of the horizontal axis; the crank angle if empty.
    over: &'a str,
    /// Panels of a picture beside each other.
    columns: usize,
    /// Half the width of a band in standard errors.
    band: f64,
    /// Whether curves grow without bound towards dead centres, so that their bulk is shown.
    has_poles: bool,
    /// What a picture has beside the columns, unless columns are chosen.
    beside: Vec<Figure>,
    /// The mechanism that a page shows.
    scene: Option<&'a Scene>,
    /// The run whose terms and events a page lists.
    run: Option<&'a Summary>,
    /// Rows of a page that are no motion: one column over another.
    scatter: Option<Scatter>,
    /// Figures of a page, as SVG, that stand as they are.
    figures: Vec<String>,
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
