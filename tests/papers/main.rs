//! The numbers and figures of the four source papers.

#[path = "../support/mod.rs"]
mod support;

mod calibration;
mod papers;
mod reproduce;
