//! Slider force from a measured motion, on paper.

mod plot;
mod rows;
mod text;

pub use rows::{
    inverse_figure, inverse_page, inverse_rows, inverse_table, mean_cycle, residual_table,
    residuals,
};
pub use text::inverse;
