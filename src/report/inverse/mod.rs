//! Reports of inverse dynamics, the slider force from a measured motion: rows, text and figures.

mod plot;
mod rows;
mod text;

pub use rows::{InverseReport, inverse_table, mean_cycle_table, residual_table};
