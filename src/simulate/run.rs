//! Forward motion: scene -> mechanism -> plan -> engine -> trajectory.

use std::sync::Arc;

use super::guide_friction::Sliding;
use super::options::Options;
use super::row::{NoRows, RowSink};
use super::row_maker::RowMaker;
use super::run_setup::RunSetup;
use super::schedule::{self, Schedule};
use super::simulation::Simulation;
use super::warning::Warning;
use super::{clearance, closed_form, forward, joint_force_maxima};
use crate::error::Error;
use crate::mechanism::{Curve, CurveEquation, Equation, Limits, Reactor};
use crate::plan::{self, Engine, Plan};
use crate::scene::{Extent, MotionKind, Scene};

/// Simulates a scene and keeps its dense trajectory.
///
/// # Errors
/// [`Error::Scene`] for impossible values, [`Error::Refused`] for what cannot be computed. A run that ends
/// before its time is no error: see [`Summary::stopped`](super::Summary::stopped).
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
/// As [`simulate`], and the errors of `rows`.
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
/// As [`simulate_rows`].
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
    kept: usize,
) -> Result<Simulation, Error> {
    let kept = if options.reactions && scene.clearance.is_none() {
        kept.max(joint_force_maxima::MOST_ROWS)
    } else {
        kept
    };
    let mut run = run_keeping(kept, scene, options, rows)?;
    let summary = &run.summary;
    if options.reactions && summary.stopped.is_none() && summary.clearance.is_none() {
        let peaks = joint_force_maxima::search(scene, &run);
        if peaks.is_none() {
            run.summary.warnings.push(Warning::NoForceMaxima);
        }
        run.summary.peaks = peaks;
    }
    Ok(run)
}

/// A run that keeps so many steps or pieces of its motion.
fn run_keeping(
    kept: usize,
    scene: &Scene,
    options: &Options,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    plan::refuse(scene)?;
    let plan = Plan::of_modelled(scene, options.method)?;
    let extent = match scene.run.extent {
        None | Some(Extent::Revolutions(0.0)) => Extent::Duration(0.0),
        Some(extent) => extent,
    };
    let equation = Equation::new(scene);
    let free = scene.motion.kind == MotionKind::Free;
    let sliding = Sliding::new(scene, &equation).filter(|_| free);
    let task = RunSetup {
        scene,
        options,
        plan,
        extent,
        kept,
        limits: Limits::new(equation.linkage(), scene.motion.speed),
        maker: RowMaker {
            reactor: match options.reactions {
                true => Some(Arc::new(Reactor::new(scene)?)),
                false => None,
            },
            driving_torque: options.driving_torque,
            guide: guide(scene, &equation).map(Arc::new),
            sliding: sliding.map(Arc::new),
            equation: Arc::new(equation),
        },
    };
    if is_open(&task) && rows.wants_rows() {
        let blind = Options {
            estimate: false,
            reactions: false,
            events_kept: 0,
            ..options.clone()
        };
        let seen = run_keeping(0, scene, &blind, &mut NoRows)?.summary;
        let end = seen.last.t_s;
        schedule::refuse_rows(task.schedule().rows_until(end), end)?;
    }
    let mut run = match task.plan.engine {
        Engine::ClosedForm => closed_form::run(&task, rows),
        Engine::Contact => clearance::run(&task, rows),
        Engine::Energy | Engine::Angle | Engine::Time => forward::run(&task, rows),
    }?;
    if run.summary.clearance.is_none() {
        run.dense.maker = Some(task.maker);
        run.dense.alpha = (!free).then_some(0.0);
    }
    Ok(run)
}

/// Whether how long a run of turns takes, and so how many rows at times it has, is known at its end only.
fn is_open(task: &RunSetup<'_>) -> bool {
    let at_times = matches!(task.schedule(), Schedule::Times { .. });
    let of_turns = matches!(task.extent, Extent::Revolutions(_));
    task.plan.engine != Engine::Contact
        && at_times
        && of_turns
        && task.scene.motion.kind == MotionKind::Free
}

/// The guide of a prescribed motion, if it has friction.
fn guide(scene: &Scene, equation: &Equation) -> Option<CurveEquation> {
    if scene.motion.kind != MotionKind::ConstantSpeed || scene.friction.is_none() {
        return None;
    }
    let guide = CurveEquation::new(scene, Curve::on_crank(equation.linkage()));
    guide.friction().is_some().then_some(guide)
}
