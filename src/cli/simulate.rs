//! Command `simulate`: computes the forward motion of a scene.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;

use super::outputs::Outputs;
use super::streams::origin;
use crate::error::Error;
use crate::plan::Method;
use crate::report::{PlotRows, Preview, RowWriter, RunReport};
use crate::scene::Scene;
use crate::simulate::{Options, Row, RowSink, Stop, simulate_rows, steady_state};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    #[command(flatten)]
    outputs: Outputs,
    /// Adds joint, guide and shaking forces to the rows, and the largest of them to the summary
    #[arg(long)]
    reactions: bool,
    /// Adds the torque that drives a crank of prescribed speed to the rows
    #[arg(long)]
    torque: bool,
    /// auto, closed-form, energy, angle, time, dop853 or dopri5
    #[arg(long, default_value = "auto")]
    method: Method,
    /// Local error target, in place of the scene's
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Does without the error estimate, which takes a second run
    #[arg(long)]
    no_estimate: bool,
    /// Starts the run in the periodic steady state, one cycle if the scene gives no run, and adds its key figures
    #[arg(long)]
    steady_state: bool,
    /// Adds the flywheel for this coefficient of speed fluctuation in the steady state
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "steady_state",
        allow_hyphen_values = true
    )]
    fluctuation: Option<f64>,
    /// Work limit: most evaluations of the equation
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().max_evaluations)]
    max_evaluations: u64,
    /// Most events that are listed
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().events_kept)]
    max_events: usize,
}

/// Grace period after a request to stop, in which an engine ends with a summary; longer output of rows of a computed
/// motion is cut off.
const GRACE: Duration = Duration::from_millis(500);

/// Sink of the rows of a run: file, preview and plot.
struct Rows<'a> {
    stop: &'a Stop,
    /// Time at which the request to stop was first seen.
    seen: Option<Instant>,
    /// Time of the last row, s.
    t: f64,
    writer: Option<RowWriter>,
    preview: Option<Preview>,
    /// Whether a picture or a page needs rows.
    plots: bool,
    plot: PlotRows,
    /// Whether the scene has a loose joint.
    loose: bool,
}

impl RowSink for Rows<'_> {
    fn wants_rows(&self) -> bool {
        self.writer.is_some() || self.preview.is_some() || self.plots
    }

    fn row(&mut self, row: &Row) -> Result<(), Error> {
        if self.stop.is_requested() && self.seen.get_or_insert_with(Instant::now).elapsed() > GRACE
        {
            return Err(Error::Interrupted);
        }
        self.t = row.t;
        if let Some(preview) = &mut self.preview {
            preview.take(row);
        }
        if self.plots {
            self.plot.take(row)?;
        }
        match &mut self.writer {
            Some(writer) => writer.row(row),
            None => Ok(()),
        }
    }

    fn wants_steps(&self) -> bool {
        self.loose && self.plots
    }

    fn step(&mut self, row: &Row) -> Result<(), Error> {
        self.plot.take(row)
    }
}

pub(super) fn run(arguments: &Arguments, stop: &Stop) -> Result<(), Error> {
    let read = arguments.scene.as_ref();
    let streams = arguments.outputs.streams(&[read], &[])?;
    let mut scene = streams.scene(read)?;
    let origin = origin(read);
    if let Some(tolerance) = arguments.tolerance {
        // Checked on a scene of its own: an error must not point into the file.
        Scene::new(1.0, 2.0).tolerance(tolerance).check()?;
        scene.run.tolerance = tolerance;
    }
    let options = Options {
        method: arguments.method,
        reactions: arguments.reactions,
        driving_torque: arguments.torque,
        estimate: !arguments.no_estimate,
        max_evaluations: arguments.max_evaluations,
        events_kept: arguments.max_events,
        stop: Some(stop.clone()),
    };
    let found = || steady_state(&scene, arguments.fluctuation, &options);
    let steady = arguments.steady_state.then(found).transpose()?;
    if let Some(steady) = &steady {
        scene = steady.start(&scene);
    }
    let mut targets = arguments.outputs.open()?;
    let mut rows = Rows {
        stop,
        seen: None,
        t: f64::NAN,
        plots: targets.picture.is_some() || targets.page.is_some(),
        plot: PlotRows::new(arguments.outputs.plot.view()),
        writer: targets.rows.take().map(RowWriter::new),
        preview: streams.text_on_stdout().then(Preview::default),
        loose: scene.clearance.is_some(),
    };
    let result = simulate_rows(&scene, &options, &mut rows);
    let keeps = matches!(&result, Ok(_) | Err(Error::Interrupted));
    if let Some(writer) = rows.writer.filter(|_| keeps) {
        writer.finish()?;
    }
    let result = match result {
        Err(Error::Interrupted) if rows.t.is_finite() => {
            return Err(Error::Incomplete(format!(
                "interrupted: the rows end at t = {} s, and there is no summary",
                rows.t
            )));
        }
        result => result?,
    };
    let mut summary = result.summary;
    summary.steady_state = steady;
    let preview = rows.preview.map_or(Vec::new(), |preview| preview.rows());
    let report = RunReport {
        summary: &summary,
        scene: &scene,
        plot: &rows.plot,
        preview: &preview,
    };
    targets.write(&report, &summary, &origin, &streams)?;
    match summary.stopped {
        Some(stopped) => Err(Error::Incomplete(stopped.to_string())),
        None => Ok(()),
    }
}
