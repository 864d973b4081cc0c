//! `compare`: several motions over each other.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Outcome, PlotOfRows, check_files, create, draw, fill, page, print, say};
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
    /// Writes values and differences as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Adds joint, guide and shaking forces of scenes
    #[arg(long)]
    reactions: bool,
    /// Writes the curves over each other as one HTML page to this file
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Prints the differences as one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plot: PlotOfRows,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let read: Vec<&Path> = arguments.motions.iter().map(PathBuf::as_path).collect();
    let written = [
        arguments.out.as_ref(),
        arguments.plot.path(),
        arguments.report.as_ref(),
    ];
    let written: Vec<PathBuf> = written.into_iter().flatten().cloned().collect();
    check_files(&read, &written)?;
    let options = Options {
        reactions: arguments.reactions,
        estimate: false,
        ..Options::default()
    };
    let mut motions: Vec<Motion> = Vec::new();
    for file in read {
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
    let out = create(arguments.out.as_ref())?;
    let plot = arguments.plot.open()?;
    let page = page(arguments.report.as_ref())?;
    draw(plot, || result.figure(&arguments.plot.view()))?;
    fill(page, || {
        let origin = Origin {
            scene: None,
            command: super::command_line(),
        };
        result.page(&origin)
    })?;
    let to_stdout = super::is_standard(arguments.out.as_ref());
    if let Some(output) = out {
        result.rows(output)?;
    }
    match (arguments.json, to_stdout) {
        (true, _) => print(&result.json()?)?,
        (false, true) => say(result.text().trim_end()),
        (false, false) => print(&result.text())?,
    }
    Ok(Outcome::Done)
}

/// Whether a file holds rows and no scene.
fn is_data(file: &Path) -> bool {
    let ending = file.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("toml"))
}

/// Rows of a scene: at these times if the motion is known at any time, else at those of its output.
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
