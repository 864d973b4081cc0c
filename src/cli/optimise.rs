//! Command `optimise`: finds the best design between bounds, subject to limits.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::streams::{Streams, create, fill};
use crate::error::Error;
use crate::optimise::{Constraint, Problem, optimise};
use crate::plan::Method;
use crate::report;
use crate::scene::Varied;
use crate::simulate::{Options, Stop};
use crate::sweep::{Figure, Goal, SweepOptions};

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("goal").required(true).args(["least", "most"])))]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// A scene key and its bounds, like "geometry.rod=100mm:200mm"; given again, several keys
    #[arg(long, value_name = "KEY=LOW:HIGH", required = true)]
    vary: Vec<Varied>,
    /// Looks for the design with the least of this key figure
    #[arg(long, value_name = "FIGURE", value_parser = Figure::of_number)]
    least: Option<Figure>,
    /// Looks for the design with the most of this key figure
    #[arg(long, value_name = "FIGURE", value_parser = Figure::of_number)]
    most: Option<Figure>,
    /// A limit that the design has to keep, like "transmission_min >= 40 deg"; given again, all of them
    #[arg(long, value_name = "FIGURE >= VALUE")]
    subject: Vec<Constraint>,
    /// Seed of the samples
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Writes the scene with the best values to this file, which belongs beside the scene if that names tables
    #[arg(long, value_name = "FILE")]
    best: Option<PathBuf>,
    /// Writes a row for each local search as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints the result as one JSON object
    #[arg(long)]
    json: bool,
    /// Coefficient of speed fluctuation of the flywheel, for its figure
    #[arg(long, value_name = "NUMBER")]
    fluctuation: Option<f64>,
    /// auto, closed-form, energy, angle, time, dop853 or dopri5
    #[arg(long, default_value = "auto")]
    method: Method,
    /// Work limit: most evaluations of the equation in one design
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().max_evaluations)]
    max_evaluations: u64,
}

pub(super) fn run(arguments: &Arguments, stop: &Stop) -> Result<(), Error> {
    let [read, out, best] = [&arguments.scene, &arguments.out, &arguments.best].map(Option::as_ref);
    let streams = Streams::new(&[read], out, &[best], arguments.json)?;
    let draft = streams.draft(read)?;
    let least = arguments.least.map(Goal::least);
    let goal = least.or(arguments.most.map(Goal::most));
    let goal = goal
        .ok_or_else(|| Error::refused("there is no goal", "say which, like --least guide_peak"))?;
    let problem = Problem {
        goal,
        constraints: arguments.subject.clone(),
        seed: arguments.seed,
    };
    let (out, best) = (create(out)?, create(best)?);
    let options = SweepOptions {
        fluctuation: arguments.fluctuation,
        run: Options {
            method: arguments.method,
            max_evaluations: arguments.max_evaluations,
            stop: Some(stop.clone()),
            ..Options::default()
        },
        ..SweepOptions::default()
    };
    let varied = arguments.vary.clone();
    let found = optimise(draft.clone(), varied, &problem, options)?;
    fill(out, || Ok(report::starts_csv(&found)))?;
    fill(best, || {
        let values = arguments.vary.iter().zip(&found.values);
        let values = values.map(|(varied, value)| (varied, value.text.as_str()));
        Ok(draft.text_with(values)?)
    })?;
    streams.show(&found, || report::optimum(&found))?;
    let why = if found.interrupted {
        "interrupted: this is the best design so far"
    } else if !found.meets_subjects {
        "no design was found that keeps all limits: this one misses them least"
    } else {
        return Ok(());
    };
    Err(Error::Incomplete(why.to_owned()))
}
