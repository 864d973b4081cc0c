//! Small numerical tools, each with its source.

pub mod angle;
pub mod exact;
pub mod interpolate;
pub mod root;
