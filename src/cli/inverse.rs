//! Command `inverse`: computes slider force and crank torque from a measured motion.

use std::path::{Path, PathBuf};

use clap::Args;

use super::outputs::Outputs;
use super::reading::ReadingArguments;
use super::streams::{check_inputs, create, draft, origin};
use crate::error::Error;
use crate::inverse::{self, AsPrinted, FitKind, InverseOptions};
use crate::report::{self, InverseReport};
use crate::scene::{Measurement, Reading};
use crate::simulate::Stop;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// Measured motion as CSV, `-` for standard input: time and theta, gamma, x or omega, units in the header; of several of these
    /// each counts by its own noise; without it (and without a scene) the motion of Duarte et al.
    data: Option<PathBuf>,
    /// How the motion is estimated: smoother (through the equation of motion), polynomial, or auto: a polynomial where it
    /// leaves nothing but noise within one turn, else the smoother
    #[arg(long, value_name = "KIND", default_value = "auto", value_parser = kind)]
    fit: FitKind,
    /// Degree of a polynomial; `auto` chooses it from the samples
    #[arg(long, value_name = "NUMBER", default_value = "auto", value_parser = degree, allow_hyphen_values = true)]
    degree: Degree,
    #[command(flatten)]
    reading: ReadingArguments,
    /// Gives the force that acts beside the forces of the scene, not the whole force on the slider
    #[arg(long)]
    beside_forces: bool,
    #[command(flatten)]
    outputs: Outputs,
    /// Adds joint, guide and shaking forces to the rows
    #[arg(long)]
    reactions: bool,
    /// Adds the slider force by the energies that Duarte et al. print, and by their equation (9) as printed, to rows, text
    /// and figure
    #[arg(long)]
    as_printed: bool,
    /// Writes samples, fit and residuals as CSV to this file
    #[arg(long, value_name = "FILE")]
    residuals: Option<PathBuf>,
    /// Writes the mean of the cycles as CSV to this file: force and torque for each degree of the crank angle, with their
    /// standard errors and their scatter from cycle to cycle
    #[arg(long, value_name = "FILE")]
    mean_cycle: Option<PathBuf>,
}

fn kind(text: &str) -> Result<FitKind, String> {
    FitKind::named(text).ok_or_else(|| "the fit is auto, polynomial or smoother".to_owned())
}

/// Degree of a polynomial, none for `auto`; clap takes a plain `Option` for an option that may be left out.
type Degree = Option<usize>;

fn degree(text: &str) -> Result<Degree, String> {
    if text == "auto" {
        return Ok(None);
    }
    // Larger ones are typing errors.
    let highest = 10_000;
    match text.parse() {
        Ok(degree) if degree <= highest => Ok(Some(degree)),
        Ok(_) => Err(format!("the degree is `auto` or at most {highest}")),
        Err(_) => Err("the degree is a whole number or `auto`".to_owned()),
    }
}

/// Whether a file is a scene: one has a table `[geometry]`.
fn is_scene(file: &Path) -> bool {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    text.lines()
        .any(|line| line.trim_start().starts_with("[geometry]"))
}

fn measurement(arguments: &Arguments) -> Result<Measurement, Error> {
    let reading = arguments.reading.reading();
    match (&arguments.scene, &arguments.data) {
        (_, Some(data)) => Measurement::load(data, &reading).map_err(|error| {
            if is_scene(data) {
                Error::refused(
                    format!(
                        "{} is a scene, and stands where the data of a motion are expected",
                        data.display()
                    ),
                    "the scene comes first: slider-crank inverse SCENE DATA.csv",
                )
            } else {
                error
            }
        }),
        (None, None) if reading != Reading::default() => Err(Error::refused(
            "options such as --column, --time and --decimal say how measured motion is read, and no file is given",
            "slider-crank inverse SCENE DATA.csv",
        )),
        (None, None) => Ok(Measurement::duarte()),
        (Some(_), None) => Err(Error::refused(
            "inverse needs a scene and the data of a motion",
            "slider-crank inverse SCENE DATA.csv",
        )),
    }
}

pub(super) fn run(arguments: &Arguments, stop: &Stop) -> Result<(), Error> {
    let (file, data) = (arguments.scene.as_ref(), arguments.data.as_ref());
    let others = [arguments.residuals.as_ref(), arguments.mean_cycle.as_ref()];
    let streams = arguments.outputs.streams(&[file, data], &others)?;
    check_inputs(file, data)?;
    // Data first: without data, a data file may stand in the place of the scene.
    let measurement = measurement(arguments)?;
    let draft = draft(file)?;
    let scene = draft.scene()?;
    streams.spare_tables(&scene)?;
    let options = InverseOptions {
        fit: arguments.fit,
        degree: arguments.degree,
        reactions: arguments.reactions,
        beside_forces: arguments.beside_forces,
        stop: Some(stop.clone()),
    };
    let printed = arguments.as_printed.then(|| AsPrinted::new(&scene));
    let printed = printed.transpose()?;
    let targets = arguments.outputs.open()?;
    let residuals = create(arguments.residuals.as_ref())?;
    let mean = create(arguments.mean_cycle.as_ref())?;
    // Notes on the data may explain a refusal.
    let uncertain = draft.uncertain()?;
    let mut result = inverse::inverse_of_uncertain(&scene, &uncertain, &measurement, &options)
        .map_err(|error| error.with_notes(measurement.notes()))?;
    let of_printed = printed.as_ref().and_then(AsPrinted::warning);
    result.summary.warnings.extend(of_printed);
    if let Some(output) = residuals {
        report::residual_table(&result).csv(output)?;
    }
    if let Some(output) = mean {
        report::mean_cycle_table(&result).csv(output)?;
    }
    let report = InverseReport {
        result: &result,
        scene: &scene,
        printed: printed.as_ref(),
    };
    targets.write(&report, &result.summary, &origin(file), &streams)
}
