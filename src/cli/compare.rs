//! Command `compare`: reports the differences of several motions from the first.

use std::path::PathBuf;

use clap::Args;

use super::outputs::Outputs;
use super::streams::command_line;
use crate::error::Error;
use crate::report::{Comparison, Motion, Origin, extension};
use crate::scene::Scene;
use crate::simulate::{Options, Row, Simulation, Summary, simulate, simulate_rows};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene files, which are simulated, and CSV files: rows of `simulate` or `inverse`, or measured motions
    #[arg(required = true, num_args = 2..)]
    motions: Vec<PathBuf>,
    #[command(flatten)]
    outputs: Outputs,
    /// Adds joint, guide and shaking forces of scenes
    #[arg(long)]
    reactions: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let read: Vec<Option<&PathBuf>> = arguments.motions.iter().map(Some).collect();
    let streams = arguments.outputs.streams(&read, &[])?;
    let options = Options {
        reactions: arguments.reactions,
        estimate: false,
        events_kept: 0,
        ..Options::default()
    };
    let mut motions: Vec<Motion> = Vec::new();
    let (mut warnings, mut stopped) = (Vec::new(), Vec::new());
    for file in &arguments.motions {
        let times = motions.first().map(Motion::times);
        let is_data = file.extension().is_some() && extension(file) != "toml";
        motions.push(match is_data {
            true => Motion::of_file(file)?,
            false => {
                let (rows, summary) = rows(&Scene::load(file)?, &options, times)?;
                let name = file.display().to_string();
                let told = summary
                    .warnings
                    .iter()
                    .map(|what| format!("{name}: {what}"));
                warnings.extend(told);
                stopped.extend(summary.stopped.map(|why| format!("{name}: {why}")));
                Motion::of_rows(&name, &rows)
            }
        });
    }
    let found = Comparison::new(&motions);
    let mut result = found.map_err(|error| error.with_notes(&stopped))?;
    warnings.extend(stopped.clone());
    result.warnings.splice(0..0, warnings);
    let origin = Origin {
        scene: None,
        command: command_line(),
    };
    let targets = arguments.outputs.open()?;
    targets.write(&result, &result, &origin, &streams)?;
    match stopped.is_empty() {
        true => Ok(()),
        false => Err(Error::Incomplete(stopped.join("\n"))),
    }
}

/// Simulates a scene; returns its summary and rows at `times` if the motion can be evaluated there, else at its output
/// times.
fn rows(
    scene: &Scene,
    options: &Options,
    times: Option<&[f64]>,
) -> Result<(Vec<Row>, Summary), Error> {
    if let Some(times) = times {
        let run: Simulation = simulate(scene, options)?;
        let rows: Vec<Row> = times.iter().filter_map(|t| run.row(*t)).collect();
        if !rows.is_empty() {
            return Ok((rows, run.summary));
        }
    }
    let mut rows = Vec::new();
    let run = simulate_rows(scene, options, &mut rows)?;
    Ok((rows, run.summary))
}
