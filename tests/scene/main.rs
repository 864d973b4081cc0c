//! Scene files: accepted content, refusals, and their messages.

#[path = "../support/mod.rs"]
mod support;

mod bad_scenes;
mod data_files;
mod formulas;
mod odd_files;
mod periods;
mod refusals;
mod scene_files;
mod units;
