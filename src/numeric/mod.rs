//! Small numerical tools, each with its source.

pub mod angle;
pub mod chebyshev;
pub mod double_double;
pub mod exact;
pub mod gauss;
pub mod interpolate;
pub mod root;
pub mod trigonometry;
