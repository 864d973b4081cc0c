//! Tones in a record: the likeliest motion beside them, and its errors by theirs.

pub(super) mod choice;
mod effects;
mod errors;
mod search;
mod sinusoid;
