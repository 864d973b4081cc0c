//! `identify`: values of a scene from a measured motion.

use std::path::PathBuf;

use clap::Args;

use super::reading::ReadingArguments;
use super::{Outcome, Streams, create, is_standard};
use crate::error::Error;
use crate::inverse::identify::{FreeValue, identify};
use crate::report;
use crate::scene::{Assigned, Draft, Measured, Measurement, NumberKey};

/// Arguments of `identify`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file; its values are those from which the search sets out
    scene: PathBuf,
    /// Measured motion as CSV, `-` for standard input: time and theta, gamma or x, units in the header
    data: PathBuf,
    /// Keys whose values are looked for, like "torque[1].coefficient, crank.inertia"; sensor.zero is what the sensor shows
    /// where it should show 0
    #[arg(long, value_name = "KEY,KEY", required = true, value_delimiter = ',', value_parser = free)]
    free: Vec<Free>,
    #[command(flatten)]
    reading: ReadingArguments,
    /// Writes the values as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints the result as one JSON object
    #[arg(long)]
    json: bool,
}

/// What is free.
#[derive(Clone, Copy, Debug)]
enum Free {
    Key(NumberKey),
    SensorZero,
}

const SENSOR_ZERO: &str = "sensor.zero";

fn free(text: &str) -> Result<Free, String> {
    match text.trim() {
        SENSOR_ZERO => Ok(Free::SensorZero),
        key => key.parse().map(Free::Key),
    }
}

impl Free {
    fn value(self, draft: &Draft, crank: f64, measured: Measured) -> Result<FreeValue, Error> {
        Ok(match self {
            Free::Key(key) => {
                let start = draft.number(&key)?;
                let scale = match (start, key.unit()) {
                    (_, "m") => crank.max(start.abs()),
                    (0.0, _) => 1.0,
                    _ => start.abs(),
                };
                FreeValue {
                    key: key.to_string(),
                    unit: key.unit().to_owned(),
                    start,
                    scale,
                    is_sensor_zero: false,
                }
            }
            Free::SensorZero => {
                let is_length = measured == Measured::X;
                FreeValue {
                    key: SENSOR_ZERO.to_owned(),
                    unit: if is_length { "m" } else { "rad" }.to_owned(),
                    start: 0.0,
                    scale: if is_length { crank } else { 1.0 },
                    is_sensor_zero: true,
                }
            }
        })
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let (scene, data) = (Some(&arguments.scene), Some(&arguments.data));
    let streams = Streams::new(&[scene, data], arguments.out.as_ref(), &[], arguments.json)?;
    if is_standard(scene) && is_standard(data) {
        return Err(Error::refused(
            "scene and data cannot both come from standard input",
            "give one of them as a file",
        ));
    }
    let measurement = Measurement::load(&arguments.data, &arguments.reading.reading())?;
    let draft = Draft::load(&arguments.scene)?;
    let written = draft.scene()?;
    streams.spare_tables(&written)?;
    let free = arguments.free.iter();
    let values = free
        .map(|one| one.value(&draft, written.geometry.crank, measurement.measured()))
        .collect::<Result<Vec<_>, Error>>()?;
    let scene_at = |values: &[f64]| {
        let numbers = arguments.free.iter().zip(values);
        let numbers = numbers.filter_map(|(free, value)| match free {
            Free::Key(key) => Some(Assigned {
                key: *key,
                value: *value,
            }),
            Free::SensorZero => None,
        });
        draft.with_numbers(&numbers.collect::<Vec<_>>())
    };
    let out = create(arguments.out.as_ref())?;
    let result = identify(&scene_at, &values, &measurement)
        .map_err(|error| error.with_notes(measurement.notes()))?;
    if let Some(output) = out {
        report::identification_csv(&result, output)?;
    }
    streams.show(&result, || report::identification(&result))?;
    Ok(Outcome::Done)
}
