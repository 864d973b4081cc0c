//! Command `schema`: prints the JSON Schema of scene files.

use clap::Args;

use super::streams::Outcome;
use super::watch::print;
use crate::error::Error;
use crate::{report, scene};

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub(super) struct Arguments {}

pub(super) fn run(_: &Arguments) -> Result<Outcome, Error> {
    print(&report::json(&scene::schema())?)?;
    Ok(Outcome::Done)
}
