//! Results on paper: CSV rows, text, figures, JSON. Knows neither mechanics nor integrators.

mod atomic_file;
mod calibration;
mod columns;
mod compare;
mod csv;
mod curves;
mod decimate;
mod diagrams;
mod explain;
mod figure;
mod identify;
mod inverse;
mod joint;
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
mod sketch;
mod statics;
mod steady;
mod sweep;
mod synthesis;
mod table;
mod text;

pub use calibration::calibration;
pub use compare::{Comparison, Difference, Motion};
pub use curves::View;
pub use diagrams::Diagram;
pub use explain::explanation;
pub use figure::{Axis, Figure, ScaleKind, Shape, Sheet};
pub use identify::{identification, identification_csv};
pub use inverse::{
    inverse, inverse_figure, inverse_page, inverse_rows, inverse_table, mean_cycle, residual_table,
    residuals,
};
pub use motion::PlotRows;
pub use one_turn::{sized, turn, turn_figure, turn_page, turn_rows, turn_table};
pub use optimise::{optimum, starts_csv};
pub use output::{Output, is_standard_output};
pub use page::{Origin, Page};
pub use picture::{ENDINGS, Picture};
pub use precision::{precision, precision_csv, precision_figure, precision_notes, precision_page};
pub use reproduce::{
    ReproductionSummary, drawing_csv, drawing_svg, file_name, reproduction, reproduction_csv,
};
pub use rows::{Preview, RowColumns, RowWriter};
pub use sketch::{Pose, Sketch, animation};
pub use statics::{statics, statics_figure, statics_page, statics_rows, statics_table};
pub use sweep::{
    FrontDesign, MOST_ON_PAGE, Spread, SweepAsked, SweepExtreme, SweepRange, SweepSummary,
    SweepWriter, VariedKey, merge, sweep_page, sweep_text,
};
pub use synthesis::{synthesis, synthesis_scene};
pub use table::{Cells, Table};
pub use text::summary;

use crate::error::Error;

/// A value as one JSON object, with a line break at its end.
pub fn json(value: &impl serde::Serialize) -> Result<String, Error> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| Error::Write {
        target: "JSON".to_owned(),
        source: error.into(),
    })?;
    text.push('\n');
    Ok(text)
}
