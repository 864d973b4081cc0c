//! Slider force from a measured motion, on paper.

mod rows;
mod text;

pub use rows::{inverse_rows, residuals};
pub use text::inverse;
