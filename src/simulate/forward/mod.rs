//! Free motion: the engines of the plan take turns in one loop, one recorder takes their pieces, one conclusion the result.

mod engine_loop;
mod errors_over_angle;
mod estimate;
mod forward_recorder;
mod in_time;
mod over_angle;
mod second_run_observer;
mod stop_reason;

use std::f64::consts::TAU;
use std::time::Instant;

use engine_loop::{PassResult, PassSettings};
use forward_recorder::ForwardRecorder;

use super::angle_model::AngleModel;
use super::configuration_curve::{self, CurveProblem};
use super::energy_balance::EnergyBalance;
use super::recorder::Record;
use super::row::RowSink;
use super::run_end::RunEnd;
use super::run_setup::RunSetup;
use super::simulation::Simulation;
use super::stop::Why;
use crate::engine::Counted;
use crate::error::Error;
use crate::plan::Engine;
use crate::trajectory::Trajectory;

/// Runs a free motion, with the model of its mechanism over the crank angle.
pub(super) fn run(
    task: &RunSetup<'_>,
    model: &AngleModel<'_>,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let wants_rows = rows.wants_rows();
    let pass = PassSettings {
        task,
        model,
        first_engine: task.plan.engine,
        extent: task.extent,
        resolution: over_angle::run_resolution(task),
        time_settings: task.settings(),
        resume_rotation: TAU,
    };
    // Evaluations for rows and events are not counted: they do not change how far a run goes.
    let mut recorder = ForwardRecorder::new(task, rows);
    let result = pass.run(&Counted::new(task.equation()), &mut recorder)?;
    let caught = recorder.caught();
    let record = recorder.finish(&result)?;
    let wall_s = record.wall_s(begun);
    let stopped = caught.or_else(|| result.stopped.clone());
    let of_curve = result.curve.as_ref();
    let mut warnings = Vec::from_iter(of_curve.and_then(|_| configuration_curve::warning(task)));
    let mut estimate = None;
    let is_exact = stopped.as_ref().is_none_or(Why::is_at_a_place);
    if task.options.estimate && is_exact {
        match estimate::estimate(&pass, &result, &record, wants_rows) {
            Ok(found) => estimate = Some(found),
            Err(warning) => warnings.push(warning),
        }
    }
    let (at, work) = (result.state, Some(result.work));
    let end = RunEnd {
        at,
        // An engine over the angle names the run, if any piece was over the angle.
        engine: match &result.angle_piece {
            Some(piece) => piece.engine,
            None if result.pieces_over_angle > 0 => Engine::Angle,
            None => Engine::Time,
        },
        turned: at.angle.minus(task.start()),
        estimate,
        balance: energy_balance(task, &result, &record),
        evaluations: result.evaluations,
        steps: result.steps,
        wall_s,
        warnings,
        stopped,
        record: with_motion(record, result),
    };
    Ok(Simulation {
        work,
        ..end.conclude(task)
    })
}

fn energy_balance(task: &RunSetup<'_>, result: &PassResult, record: &Record) -> EnergyBalance {
    let equation = task.equation();
    match (result.last_step, &result.curve) {
        (Some(last), Some(curve)) if result.pieces_over_angle == 0 => {
            curve.energy_balance(equation, &last, result.work, record.fastest())
        }
        _ => {
            let at = &result.state;
            let fastest = match result.pieces_over_angle {
                0 => equation.kinetic_energy(at.angle.rest, record.fastest()),
                _ => 0.0,
            };
            let largest = result.largest_kinetic.max(fastest);
            EnergyBalance::of_crank(task, at, result.work, largest)
        }
    }
}

/// Adds the dense motion of a run in one piece: over the angle as it stands, along a curve converted to the crank.
fn with_motion(mut record: Record, result: PassResult) -> Record {
    if !result.is_one_piece() {
        return record;
    }
    if let Some(piece) = result.angle_piece {
        record.trajectory = Some(Trajectory::orbit(piece.run.orbit, 0.0, piece.to.t));
    }
    if let Some(CurveProblem { equation, .. }) = result.curve {
        let motion = record.trajectory;
        record.trajectory = motion.map(|motion| motion.mapped_to_crank(equation));
    }
    record
}
