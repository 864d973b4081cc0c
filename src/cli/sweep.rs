//! `sweep`: key figures of many designs.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::{Outcome, Streams, fill, origin, page, say};
use crate::error::Error;
use crate::plan::Method;
use crate::report::{self, SweepWriter};
use crate::scene::{Draft, Varied};
use crate::simulate::SteadyOptions;
use crate::sweep::{Sweep, SweepOptions};

/// Arguments of `sweep`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// A scene key and its values: "geometry.offset=0mm:20mm:41" for 41 from 0 to 20 mm, with ":log" at the end
    /// evenly in the logarithm, or "rod.model=rigid,two-mass" one by one; given again, all combinations
    #[arg(long, value_name = "KEY=VALUES", required = true)]
    vary: Vec<Varied>,
    /// Writes one row of key figures per design as CSV to this file, `-` for standard output; a sweep that was
    /// cut off goes on from FILE.part
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Computes part K of N only, like "2/8"; the files of all parts, one after the other, are the whole
    #[arg(long, value_name = "K/N", value_parser = shard)]
    shard: Option<[usize; 2]>,
    /// Writes any key figure over any other as one HTML page to this file
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Prints the summary as one JSON object
    #[arg(long)]
    json: bool,
    /// Does without the forward motion: one turn in closed form only
    #[arg(long)]
    no_motion: bool,
    /// Adds the largest joint, guide and shaking forces of the motion
    #[arg(long)]
    reactions: bool,
    /// Adds speeds, fluctuation and power of the periodic steady state
    #[arg(long)]
    steady_state: bool,
    /// Adds the flywheel for this coefficient of speed fluctuation in the steady state
    #[arg(long, value_name = "NUMBER", requires = "steady_state")]
    fluctuation: Option<f64>,
    /// auto, closed-form, energy, angle, time, dop853 or dopri5
    #[arg(long, default_value = "auto")]
    method: Method,
    /// Does without the error estimates, which take a second run
    #[arg(long)]
    no_estimate: bool,
    /// Work limit: most evaluations of the equation in one design
    #[arg(long, value_name = "COUNT", default_value_t = SweepOptions::default().max_evaluations)]
    max_evaluations: u64,
}

fn shard(text: &str) -> Result<[usize; 2], String> {
    let numbers = text.split_once('/').and_then(|(part, parts)| {
        let (part, parts) = (part.trim().parse().ok()?, parts.trim().parse().ok()?);
        Some([part, parts])
    });
    match numbers {
        Some([part, parts]) if (1..=parts).contains(&part) => Ok([part, parts]),
        _ => Err("write part and number of parts like \"2/8\", from 1/8 to 8/8".to_owned()),
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let (read, out) = (arguments.scene.as_ref(), arguments.out.as_ref());
    let streams = Streams::new(&[read], out, &[arguments.report.as_ref()], arguments.json)?;
    let draft = match read {
        Some(file) => Draft::load(file)?,
        None => Draft::duarte(),
    };
    if let Ok(scene) = draft.scene() {
        streams.spare_tables(&scene)?;
    }
    let options = SweepOptions {
        motion: !arguments.no_motion,
        reactions: arguments.reactions,
        steady: arguments.steady_state.then_some(SteadyOptions {
            fluctuation: arguments.fluctuation,
            max_evaluations: arguments.max_evaluations,
            stop: None,
        }),
        method: arguments.method,
        estimate: !arguments.no_estimate,
        max_evaluations: arguments.max_evaluations,
        stop: None,
    };
    let sweep = Sweep::new(draft, arguments.vary.clone(), options)?;
    let part = arguments.shard.unwrap_or([1, 1]);
    let page = page(arguments.report.as_ref())?;
    let mut writer = SweepWriter::new(out.map(PathBuf::as_path), &sweep, part, page.is_some())?;
    let progress = std::io::stderr().is_terminal();
    let begun = Instant::now();
    let mut said = begun;
    sweep.designs(writer.missing(), |designs| {
        writer.take(&designs)?;
        if progress && said.elapsed().as_secs() >= 2 {
            said = Instant::now();
            let last = designs.last().map_or(0, |design| design.index + 1);
            say(&format!("design {last} of {}", sweep.len()));
        }
        Ok(())
    })?;
    let table = writer.table();
    let summary = writer.finish(begun.elapsed().as_secs_f64())?;
    if let Some(table) = table {
        fill(page, || report::sweep_page(&summary, &table, &origin(read)))?;
    }
    streams.show(&summary, || report::sweep_text(&summary))?;
    Ok(match summary.done() {
        0 if summary.part[0] <= summary.part[1] => Outcome::Incomplete(
            "no design could be computed; the notes of each row say why".to_owned(),
        ),
        _ => Outcome::Done,
    })
}
