//! Command `synthesis`: finds the lengths for a wanted stroke and time ratio.

use std::path::PathBuf;

use clap::Args;

use super::streams::{Streams, create, fill};
use super::values::length;
use crate::error::Error;
use crate::kinematics::{Choice, synthesis};
use crate::report;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Wanted stroke, like "90 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    stroke: f64,
    /// Wanted crank angle of the outward stroke over that of the inward stroke, between 1/3 and 3
    #[arg(long, value_name = "NUMBER")]
    time_ratio: f64,
    /// With this crank, like "45 mm"; without this and the next three the best least transmission angle
    #[arg(long, value_name = "LENGTH", value_parser = length, group = "choice")]
    crank: Option<f64>,
    /// With this rod
    #[arg(long, value_name = "LENGTH", value_parser = length, group = "choice")]
    rod: Option<f64>,
    /// With this size of the offset
    #[arg(long, value_name = "LENGTH", value_parser = length, group = "choice")]
    offset: Option<f64>,
    /// With a rod of so many cranks
    #[arg(long, value_name = "NUMBER", group = "choice")]
    rod_ratio: Option<f64>,
    /// Writes the lengths as a scene file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints the result as one JSON object
    #[arg(long)]
    json: bool,
}

impl Arguments {
    fn choice(&self) -> Choice {
        let lengths = [
            self.crank.map(Choice::Crank),
            self.rod.map(Choice::Rod),
            self.offset.map(Choice::Offset),
            self.rod_ratio.map(Choice::RodRatio),
        ];
        let named = lengths.into_iter().flatten().next();
        named.unwrap_or(Choice::BestTransmission)
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let out = arguments.out.as_ref();
    let streams = Streams::new(&[], out, &[], arguments.json)?;
    let found = synthesis(arguments.stroke, arguments.time_ratio, arguments.choice())?;
    fill(create(out)?, || Ok(report::synthesis_scene(&found)))?;
    streams.show(&found, || report::synthesis(&found))
}
