//! Output of results as text, CSV, figures, web pages and JSON, without mechanics or integrators.
//!
//! A [`Report`] describes a result once, by its facts, rows and views; text, CSV file, picture and page derive from it.

mod compare;
mod csv;
mod curves;
mod decimate;
mod default_view;
mod diagrams;
mod dimensions;
mod explain;
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
mod presentation;
mod quantity;
mod reproduce;
mod rows;
mod run;
mod sketch;
mod statics;
mod sweep;
mod table;
mod text;

pub use compare::{Comparison, Motion};
pub use curves::View;
pub use default_view::DefaultView;
pub use diagrams::Diagram;
pub use explain::explanation;
pub use identify::{identification, identification_csv};
pub use inverse::{InverseReport, inverse_table, mean_cycle_table, residual_table};
pub use key_values::Facts;
pub use motion::{PlotRows, RunReport};
pub use one_turn::{TurnReport, sized};
pub use optimise::{optimum, starts_csv};
pub use output::{Output, extension, is_standard_output, place};
pub use page::Origin;
pub use picture::EXTENSIONS;
pub use precision::{precision, precision_csv, precision_figure, precision_notes, precision_page};
pub use presentation::{Report, json};
pub use reproduce::{ReproductionSummary, drawing_csv, file_name, reproduction, reproduction_csv};
pub use rows::{Preview, RowWriter};
pub use sketch::{Pose, Sketch, animation};
pub use statics::{StaticsReport, calibration};
pub use sweep::{
    FrontDesign, MOST_PAGE_DESIGNS, Spread, SweepExtreme, SweepRange, SweepSummary,
    SweepSummaryOptions, SweepWriter, VariedKey, merge, sweep_page, sweep_text,
};
pub use table::{Cells, Table};
pub use text::{synthesis, synthesis_scene};
