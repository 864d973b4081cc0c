//! Slider force from a measured motion, on paper.

mod plot;
mod rows;
mod text;

pub use rows::{InverseReport, inverse_table, mean_cycle, residual_table, residuals};
