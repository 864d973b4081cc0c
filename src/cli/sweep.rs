//! Command `sweep`: computes key figures of many designs.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::streams::{Streams, fill, origin, page};
use super::watch;
use crate::error::Error;
use crate::plan::Method;
use crate::report::{self, SweepSummaryOptions, SweepWriter};
use crate::scene::Varied;
use crate::simulate::{Options, Stop};
use crate::sweep::{Figure, Goal, LatinHypercube, Source, Sweep, SweepOptions};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// A scene key and its values: "geometry.offset=0mm:20mm:41" for 41 from 0 to 20 mm, with ":log" at the end
    /// evenly in the logarithm, or "rod.model=rigid,two-mass" one by one; given again, all combinations
    #[arg(long, value_name = "KEY=VALUES", required_unless_present_any = ["sample", "merge"])]
    vary: Vec<Varied>,
    /// Draws this many designs at random in place of all combinations, as a Latin hypercube: from
    /// "geometry.rod=150mm:160mm" evenly, from "geometry.rod=155.8 +- 0.1 mm" normally; without --vary, from all values of
    /// the scene that are written like this
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    sample: Option<u64>,
    /// Seed of the sample
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "sample")]
    seed: u64,
    /// Key figures to compute, and nothing else, like "stroke,guide_peak,indicated_work"
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    figures: Vec<Figure>,
    /// Writes one row of key figures per design as CSV to this file, `-` for standard output; a sweep that was
    /// cut off goes on from FILE.part
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Looks for the designs with the least of this key figure; with several --least and --most for the Pareto front
    #[arg(long, value_name = "FIGURE", value_parser = Figure::of_number)]
    least: Vec<Figure>,
    /// Looks for the designs with the most of this key figure
    #[arg(long, value_name = "FIGURE", value_parser = Figure::of_number)]
    most: Vec<Figure>,
    /// Adds mean, standard deviation and percentiles of every key figure; samples have them without
    #[arg(long)]
    percentiles: bool,
    /// Computes part K of N only, like "2/8"; the files of all parts, one after the other, are the whole
    #[arg(long, value_name = "K/N", value_parser = shard)]
    shard: Option<[usize; 2]>,
    /// Computes nothing: puts the files of all parts together, in any order, and sums them up
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["scene", "vary", "sample", "shard", "report"])]
    merge: Vec<PathBuf>,
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
    #[arg(long, value_name = "NUMBER")]
    fluctuation: Option<f64>,
    /// auto, closed-form, energy, angle, time, dop853 or dopri5
    #[arg(long, default_value = "auto")]
    method: Method,
    /// Does without the error estimates, which take a second run
    #[arg(long)]
    no_estimate: bool,
    /// Work limit: most evaluations of the equation in one design
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().max_evaluations)]
    max_evaluations: u64,
}

impl Arguments {
    fn goals(&self) -> Vec<Goal> {
        let least = self.least.iter().copied().map(Goal::least);
        let most = self.most.iter().copied().map(Goal::most);
        least.chain(most).collect()
    }

    /// Returns the named figures and those of the goals; empty without named figures, which selects the default ones.
    fn figures(&self) -> Vec<Figure> {
        let mut figures = self.figures.clone();
        if !figures.is_empty() {
            let goals = self.goals().into_iter().map(|goal| goal.figure);
            figures.extend(goals.filter(|figure| !self.figures.contains(figure)));
        }
        figures
    }
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

pub(super) fn run(arguments: &Arguments, stop: &Stop) -> Result<(), Error> {
    if !arguments.merge.is_empty() {
        return merge(arguments);
    }
    let (read, out) = (arguments.scene.as_ref(), arguments.out.as_ref());
    let streams = Streams::new(&[read], out, &[arguments.report.as_ref()], arguments.json)?;
    let draft = streams.draft(read)?;
    let figures = arguments.figures();
    let is_of_motion = |figure: &&Figure| matches!(figure.source, Source::Motion | Source::Peaks);
    if let Some(figure) = figures.iter().find(is_of_motion)
        && arguments.no_motion
    {
        let what = format!("{figure} is a figure of the motion, and --no-motion leaves it out");
        return Err(Error::refused(what, "leave one of both out"));
    }
    let (sample, seed) = (arguments.sample, arguments.seed);
    let options = SweepOptions {
        figures,
        sample: sample.map(|count| LatinHypercube { count, seed }),
        motion: !arguments.no_motion,
        steady: arguments.steady_state,
        fluctuation: arguments.fluctuation,
        run: Options {
            method: arguments.method,
            reactions: arguments.reactions,
            estimate: !arguments.no_estimate,
            max_evaluations: arguments.max_evaluations,
            stop: Some(stop.clone()),
            ..Options::default()
        },
    };
    let varied = match arguments.vary.as_slice() {
        [] => draft.tolerances(),
        varied => varied.to_vec(),
    };
    let sweep = Sweep::new(draft, varied, options)?;
    let part = arguments.shard.unwrap_or([1, 1]);
    let page = page(arguments.report.as_ref())?;
    let asked = SweepSummaryOptions {
        goals: arguments.goals(),
        percentiles: arguments.percentiles,
        kept: page.is_some().then_some(report::MOST_PAGE_DESIGNS),
    };
    let mut writer = SweepWriter::new(out.map(PathBuf::as_path), &sweep, part, &asked)?;
    let begun = Instant::now();
    let (mut done, count) = (writer.missing().start, sweep.len());
    watch::of_designs(count);
    let computed = writer.compute(|next| {
        done = next;
        stop.reach(next as f64 / count as f64);
    });
    if let (Err(Error::Interrupted), Some(file)) = (&computed, out) {
        return Err(Error::Incomplete(format!(
            "interrupted before design {}: the same command goes on from `{}.part`",
            done + 1,
            file.display()
        )));
    }
    computed?;
    let table = writer.table();
    let summary = writer.finish(begun.elapsed().as_secs_f64())?;
    if let Some(table) = table {
        fill(page, || report::sweep_page(&summary, &table, &origin(read)))?;
    }
    streams.show(&summary, || report::sweep_text(&summary))?;
    if !summary.status.contains_key("done") && summary.part[0] <= summary.part[1] {
        let why = "no design could be computed; the notes of each row say why";
        return Err(Error::Incomplete(why.to_owned()));
    }
    Ok(())
}

fn merge(arguments: &Arguments) -> Result<(), Error> {
    let parts: Vec<Option<&PathBuf>> = arguments.merge.iter().map(Some).collect();
    let out = arguments.out.as_ref();
    let streams = Streams::new(&parts, out, &[], arguments.json)?;
    let out = out.map(PathBuf::as_path);
    let goals = arguments.goals();
    let summary = report::merge(&arguments.merge, out, &goals, arguments.percentiles)?;
    streams.show(&summary, || report::sweep_text(&summary))
}
