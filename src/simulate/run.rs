//! Forward run: scene -> mechanism -> plan -> engine -> trajectory.

use super::angle_model::AngleModel;
use super::joint_force_maxima::{self, MOST_FORCE_ROWS};
use super::options::Options;
use super::row::{NoRows, RowSink};
use super::run_setup::RunSetup;
use super::schedule::{self, Schedule};
use super::simulation::Simulation;
use super::warning::Warning;
use super::{clearance, closed_form, forward};
use crate::error::Error;
use crate::plan::Engine;
use crate::scene::{Extent, MotionKind, Scene};

/// Simulates a scene and keeps its dense trajectory.
///
/// # Errors
/// [`Error::Scene`] for impossible values, [`Error::Refused`] for what cannot be computed. A run that ends before its
/// goal is no error: see [`Summary::stopped`](super::Summary::stopped).
///
/// ```
/// use slider_crank::scene::Scene;
/// use slider_crank::simulate::{Options, simulate};
/// let run = simulate(&Scene::duarte(), &Options::default()).unwrap();
/// let (theta, omega) = run.at(0.5).unwrap();
/// assert!((theta - 50.0).abs() < 1.0 && (omega - 100.0).abs() < 5.0);
/// ```
pub fn simulate(scene: &Scene, options: &Options) -> Result<Simulation, Error> {
    run(scene, options, &mut NoRows, usize::MAX)
}

/// Simulates a scene and hands its rows to `rows` as they are computed; memory does not grow with the run.
///
/// # Errors
/// Errors of [`simulate`], and errors of `rows`.
pub fn simulate_rows(
    scene: &Scene,
    options: &Options,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    run(scene, options, rows, 0)
}

/// Simulates a scene, hands its rows to `rows` and keeps its dense trajectory.
///
/// # Errors
/// Errors of [`simulate_rows`].
pub fn simulate_with_rows(
    scene: &Scene,
    options: &Options,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    run(scene, options, rows, usize::MAX)
}

fn run(
    scene: &Scene,
    options: &Options,
    rows: &mut dyn RowSink,
    steps_kept: usize,
) -> Result<Simulation, Error> {
    let mut task = RunSetup::new(scene, options, steps_kept)?;
    let searches_forces = options.reactions && task.plan.engine != Engine::Contact;
    if searches_forces {
        task.steps_kept = steps_kept.max(MOST_FORCE_ROWS);
    }
    if let Some(step) = row_step_of_open_run(&task)
        && rows.wants_rows()
    {
        let end_only = Options {
            estimate: false,
            reactions: false,
            events_kept: 0,
            ..options.clone()
        };
        let end = simulate_rows(scene, &end_only, &mut NoRows)?
            .summary
            .last
            .t_s;
        schedule::check_row_count(end / step, end)?;
    }
    let mut run = match task.plan.engine {
        Engine::ClosedForm => closed_form::run(&task, rows),
        Engine::Contact => clearance::run(&task, rows),
        Engine::Energy | Engine::Angle | Engine::Time => {
            forward::run(&task, &AngleModel::of(&task), rows)
        }
    }?;
    if searches_forces && run.summary.stopped.is_none() {
        let peaks = joint_force_maxima::search(scene, &run);
        if peaks.is_none() {
            run.summary.warnings.push(Warning::NoForceMaxima);
        }
        run.summary.peaks = peaks;
    }
    Ok(run)
}

/// Returns the time between rows, s, of a run of turns whose duration, and with it their number, only its end tells.
fn row_step_of_open_run(task: &RunSetup<'_>) -> Option<f64> {
    let is_free = task.scene.motion.kind == MotionKind::Free;
    match (task.schedule(), task.extent) {
        (Schedule::Times { step, .. }, Extent::Revolutions(_))
            if is_free && task.plan.engine != Engine::Contact =>
        {
            Some(step)
        }
        _ => None,
    }
}
