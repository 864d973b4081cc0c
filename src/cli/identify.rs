//! Command `identify`: estimates values of a scene from a measured motion.

use std::path::PathBuf;

use clap::Args;

use super::reading::ReadingArguments;
use super::streams::{Streams, check_inputs, create, fill};
use crate::error::Error;
use crate::inverse::identify::{FreeKey, identify_keys};
use crate::report;
use crate::scene::{Draft, Measurement};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file; its values are those from which the search sets out
    scene: PathBuf,
    /// Measured motion as CSV, `-` for standard input: time and theta, gamma, x or omega, units in the header
    data: PathBuf,
    /// Keys whose values are looked for, like "torque[1].coefficient, crank.inertia"; sensor.zero is what the sensor shows
    /// where it should show 0
    #[arg(long, value_name = "KEY,KEY", required = true, value_delimiter = ',', value_parser = str::parse::<FreeKey>)]
    free: Vec<FreeKey>,
    #[command(flatten)]
    reading: ReadingArguments,
    /// Writes the values as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints the result as one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let (scene, data) = (Some(&arguments.scene), Some(&arguments.data));
    let streams = Streams::new(&[scene, data], arguments.out.as_ref(), &[], arguments.json)?;
    check_inputs(scene, data)?;
    let measurement = Measurement::load(&arguments.data, &arguments.reading.reading())?;
    let draft = Draft::load(&arguments.scene)?;
    let written = draft.scene()?;
    streams.spare_tables(&written)?;
    let out = create(arguments.out.as_ref())?;
    let result = identify_keys(&draft, &|scene| scene, &arguments.free, &measurement, None)?;
    fill(out, || Ok(report::identification_csv(&result)))?;
    streams.show(&result, || report::identification(&result))
}
