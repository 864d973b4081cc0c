//! Command `compare`: reports the differences of several motions from the first.

use std::path::{Path, PathBuf};

use clap::Args;

use super::outputs::Outputs;
use super::streams::command_line;
use crate::error::Error;
use crate::report::{Comparison, Motion, Origin};
use crate::scene::Scene;
use crate::simulate::{Options, Row, Simulation, simulate, simulate_rows};

/// Arguments of `compare`.
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
        ..Options::default()
    };
    let mut motions: Vec<Motion> = Vec::new();
    for file in &arguments.motions {
        let times = motions.first().map(Motion::times);
        motions.push(match is_data(file) {
            true => Motion::of_file(file)?,
            false => {
                let rows = rows(&Scene::load(file)?, &options, times)?;
                Motion::of_rows(&file.display().to_string(), &rows)
            }
        });
    }
    let result = Comparison::new(&motions)?;
    let origin = Origin {
        scene: None,
        command: command_line(),
    };
    let targets = arguments.outputs.open()?;
    targets.write(&result, &result, &origin, &streams)
}

/// Whether a file is data rather than a scene, by its extension.
fn is_data(file: &Path) -> bool {
    let ending = file.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("toml"))
}

/// Simulates a scene; returns rows at `times` if the motion can be evaluated there, else at its output times.
fn rows(scene: &Scene, options: &Options, times: Option<&[f64]>) -> Result<Vec<Row>, Error> {
    if let Some(times) = times {
        let run: Simulation = simulate(scene, options)?;
        let rows: Vec<Row> = times.iter().filter_map(|t| run.row(*t)).collect();
        if !rows.is_empty() {
            return Ok(rows);
        }
    }
    let mut rows = Vec::new();
    simulate_rows(scene, options, &mut rows)?;
    Ok(rows)
}
