//! `kinematics`: one turn in closed form.

use std::path::PathBuf;

use clap::Args;

use super::{Outcome, is_standard, print, say, scene, turn_step};
use crate::error::Error;
use crate::report::{self, KinematicsWriter, Output};
use crate::study;

/// Arguments of `kinematics`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// Crank angle between rows, from 0 to 360 degrees inclusive
    #[arg(long, value_name = "ANGLE", default_value = "1 deg", value_parser = turn_step)]
    every: f64,
    /// Writes the rows as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints the summary as one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let rows_on_stdout = is_standard(arguments.out.as_ref());
    if rows_on_stdout && arguments.json {
        return Err(Error::refused(
            "both the rows and the JSON summary would go to standard output",
            "write the rows to a file: --out rows.csv",
        ));
    }
    let result = study::kinematics(&scene(arguments.scene.as_ref())?)?;
    if let Some(path) = &arguments.out {
        let output = Output::create(path)?;
        let mut writer = KinematicsWriter::new(output, result.speed_rad_per_s.is_some())?;
        for row in result.rows(arguments.every) {
            writer.row(&row)?;
        }
        writer.finish()?;
    }
    if arguments.json {
        print(&report::json(&result)?)?;
    } else if rows_on_stdout {
        say(report::kinematics(&result).trim_end());
    } else {
        print(&report::kinematics(&result))?;
    }
    Ok(Outcome::Done)
}
