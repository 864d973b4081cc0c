//! Command `statics`: computes static equilibrium of slider force and crank torque, and calibrations of force sensors.

use std::path::PathBuf;

use clap::Args;

use super::outputs::Outputs;
use super::streams::{Streams, origin};
use super::values::{angle, check_rows_of_turn, length, positive_angle, quantity};
use crate::error::Error;
use crate::report::{self, StaticsReport};
use crate::scene::unit::Quantity;
use crate::statics::{StaticsOptions, calibrate, drum_torque, friction_from_tilt, statics};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine, under 1 N m if no load is given
    scene: Option<PathBuf>,
    /// Crank torque in place of the scene's torques, like "0.26487 N m"; the slider force is sought
    #[arg(long, value_name = "TORQUE", value_parser = |text: &str| quantity(text, Quantity::Torque), allow_hyphen_values = true, conflicts_with = "weight")]
    torque: Option<f64>,
    /// Weight on a cord round a drum on the crank, like "9.81 N": gives the torque
    #[arg(long, value_name = "FORCE", value_parser = |text: &str| quantity(text, Quantity::Force), requires = "drum_radius", allow_hyphen_values = true)]
    weight: Option<f64>,
    /// Radius of the drum, like "27 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length, requires = "weight", allow_hyphen_values = true)]
    drum_radius: Option<f64>,
    /// Slider force in place of the scene's forces, like "-200 N"; the crank torque is sought
    #[arg(long, value_name = "FORCE", value_parser = |text: &str| quantity(text, Quantity::Force), allow_hyphen_values = true, conflicts_with_all = ["torque", "weight"])]
    force: Option<f64>,
    /// Static friction coefficient at the guide, in place of the scene's
    #[arg(
        long,
        value_name = "NUMBER",
        conflicts_with = "tilt",
        allow_hyphen_values = true
    )]
    friction: Option<f64>,
    /// Tilt at which the slider begins to slide, like "45 deg": gives the friction coefficient
    #[arg(long, value_name = "ANGLE", value_parser = tilt, allow_hyphen_values = true)]
    tilt: Option<f64>,
    /// Crank angle between rows, from 0 to 360 degrees inclusive
    #[arg(long, value_name = "ANGLE", default_value = "1 deg", value_parser = positive_angle, allow_hyphen_values = true)]
    every: f64,
    /// Adds the velocity ratio and the angle at the crank pin to the rows
    #[arg(long)]
    details: bool,
    #[command(flatten)]
    outputs: Outputs,
    /// Calibration of a force sensor instead: a CSV file of loads and readings, like `load [N],strain`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "out", "plot", "report", "torque", "weight", "force"])]
    calibration: Option<PathBuf>,
    /// Reading that the calibration takes back to a force; may be given again
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "calibration",
        allow_hyphen_values = true
    )]
    reading: Vec<f64>,
}

fn tilt(text: &str) -> Result<f64, String> {
    let tilt = angle(text)?;
    if (0.0..std::f64::consts::FRAC_PI_2).contains(&tilt) {
        Ok(tilt)
    } else {
        Err("the tilt must be from 0 to below 90 degrees, like \"45 deg\"".to_owned())
    }
}

impl Arguments {
    fn options(&self) -> StaticsOptions {
        let hung = self.weight.zip(self.drum_radius);
        let hung = hung.map(|(weight, radius)| drum_torque(weight, radius));
        let nothing = self.scene.is_none() && self.force.is_none();
        StaticsOptions {
            torque: self.torque.or(hung).or(nothing.then_some(1.0)),
            force: self.force,
            friction: self.friction.or(self.tilt.map(friction_from_tilt)),
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    if let Some(file) = &arguments.calibration {
        let result = calibrate(file, &arguments.reading)?;
        let streams = Streams::new(&[], None, &[], arguments.outputs.json)?;
        return streams.show(&result, || report::calibration(&result));
    }
    let read = arguments.scene.as_ref();
    let streams = arguments.outputs.streams(&[read], &[])?;
    check_rows_of_turn(arguments.every)?;
    let scene = streams.scene(read)?;
    let result = statics(&scene, &arguments.options())?;
    let report = StaticsReport {
        result: &result,
        scene: &scene,
        every: arguments.every,
        details: arguments.details,
    };
    let targets = arguments.outputs.open()?;
    targets.write(&report, &result, &origin(read), &streams)
}
