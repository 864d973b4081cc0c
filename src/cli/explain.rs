//! Command `explain`: shows equation, modelled terms and plan of computation of a scene.

use std::path::PathBuf;

use clap::Args;

use super::streams::{Streams, scene};
use super::values::angle;
use crate::error::Error;
use crate::plan::Method;
use crate::report;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// Crank angle at which every term is evaluated, like "30 deg"
    #[arg(long, value_name = "ANGLE", value_parser = angle, allow_hyphen_values = true)]
    at: Option<f64>,
    /// auto, closed-form, energy, angle, time, dop853 or dopri5
    #[arg(long, default_value = "auto")]
    method: Method,
    /// Prints one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let scene = scene(arguments.scene.as_ref())?;
    let result = crate::explain::explain(&scene, arguments.method, arguments.at)?;
    let streams = Streams::new(&[], None, &[], arguments.json)?;
    streams.show(&result, || report::explanation(&result))
}
