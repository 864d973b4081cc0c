//! Stretches of a record with another intensity of the process noise.

pub(super) mod intensities;
pub(super) mod parted;
pub(super) mod span;
pub(super) mod stretch_search;
