//! A torque that repeats every turn, or every two: linear regression on its harmonics beside the filter.

pub(super) mod high_harmonics;
pub(super) mod lines;
pub(super) mod periodic;
pub(super) mod periodogram;
pub(super) mod regression;
pub(super) mod spectra;
pub(super) mod spectrum;
