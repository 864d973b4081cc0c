//! Rows, bands, warnings and summary of a motion that was found.

pub(super) mod bands;
pub(super) mod inverse_dynamics;
pub(super) mod refusals;
pub(super) mod rows;
pub(super) mod shared_errors;
pub(super) mod summary;
pub(super) mod warnings;
