//! Command `kinematics`: computes one turn in closed form.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::outputs::Outputs;
use super::streams::origin;
use super::values::{any_length, check_rows_of_turn, length, positive_angle};
use super::watch::say;
use crate::error::Error;
use crate::kinematics::{Length, TurnOptions, one_turn, size_from_stroke};
use crate::report::{self, Diagram, TurnReport};

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("analysis").args(["forces", "diagram"]).multiple(true)))]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// Crank angle between rows, from 0 to 360 degrees inclusive, with --forces to the end of the cycle of the loads
    #[arg(long, value_name = "ANGLE", default_value = "1 deg", value_parser = positive_angle, allow_hyphen_values = true)]
    every: f64,
    #[command(flatten)]
    outputs: Outputs,
    /// Adds the forces at the scene's speed, taken as constant: torque, inertia forces, joint and shaking forces
    #[arg(long)]
    forces: bool,
    /// Part of the reciprocating mass that the counterweight of the diagrams of the forces balances
    #[arg(
        long,
        value_name = "NUMBER",
        default_value_t = 0.5,
        requires = "analysis",
        allow_hyphen_values = true
    )]
    balance: f64,
    /// Adds the derivatives of motion and driving torque with respect to crank, rod and offset
    #[arg(long)]
    sensitivity: bool,
    /// Compares with a changed length, like "crank=150 mm"; keys crank, rod, offset; may be given again
    #[arg(long, value_name = "KEY=LENGTH", value_parser = change)]
    change: Vec<(Length, f64)>,
    /// Sizes crank and rod for this stroke, like "80 mm", at the scene's offset
    #[arg(long, value_name = "LENGTH", value_parser = length, requires = "rod_ratio", allow_hyphen_values = true)]
    stroke: Option<f64>,
    /// Rod length over crank length for --stroke, like 1.6
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "stroke",
        allow_hyphen_values = true
    )]
    rod_ratio: Option<f64>,
    /// Draws a diagram of the forces in place of columns: turning-moment, pressure-volume, polar, orders or balance
    #[arg(long, value_name = "NAME", value_parser = diagram, requires = "plot", conflicts_with_all = ["show", "over"])]
    diagram: Option<Diagram>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let read = arguments.scene.as_ref();
    let streams = arguments.outputs.streams(&[read], &[])?;
    check_rows_of_turn(arguments.every)?;
    let mut scene = streams.scene(read)?;
    if let Some((stroke, ratio)) = arguments.stroke.zip(arguments.rod_ratio) {
        let (crank, rod) = size_from_stroke(stroke, ratio, scene.geometry.offset)?;
        (scene.geometry.crank, scene.geometry.rod) = (crank, rod);
        say(&report::sized(crank, rod));
    }
    let options = TurnOptions {
        forces: arguments.forces || arguments.diagram.is_some(),
        balance: Some(arguments.balance),
        sensitivity: arguments.sensitivity,
        change: arguments.change.clone(),
    };
    let result = one_turn(&scene, &options)?;
    let report = TurnReport {
        result: &result,
        scene: &scene,
        every: arguments.every,
        diagram: arguments.diagram,
    };
    let targets = arguments.outputs.open()?;
    targets.write(&report, &result, &origin(read), &streams)
}

fn diagram(text: &str) -> Result<Diagram, String> {
    Diagram::named(text).ok_or_else(|| format!("known are {}", Diagram::NAMES.join(", ")))
}

/// Parses a length and its new value, m.
fn change(text: &str) -> Result<(Length, f64), String> {
    let help = "write it like \"crank=150 mm\"; the keys are crank, rod and offset";
    let (key, value) = text.split_once('=').ok_or(help)?;
    let (length, value) = (Length::named(key.trim()), any_length(value.trim())?);
    Ok((length.ok_or(help)?, value))
}
