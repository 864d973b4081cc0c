//! Free motion: the engines of the plan take turns in one loop, one recorder takes their pieces, and one conclusion
//! makes the result, the errors and the energy balance.

mod arrived;
mod engine_loop;
mod errors_over_angle;
mod estimate;
mod forward_recorder;
mod in_time;
mod over_angle;
mod stop_reason;

use std::cell::OnceCell;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Instant;

use arrived::{AnglePiece, Arrived};
use engine_loop::Course;
use forward_recorder::ForwardRecorder;

use super::angle_model::AngleModel;
use super::balance::Balance;
use super::configuration_curve::{self, End};
use super::crank_motion::CrankMotion;
use super::outcome::Outcome;
use super::recorder::Record;
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::simulation::Simulation;
use super::warning::Warning;
use crate::engine::Counted;
use crate::engine::time::Finish;
use crate::error::Error;
use crate::numeric::angle::Angle;
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
    let course = Course {
        task,
        model,
        first: task.plan.engine,
        is_second: false,
        extent: task.extent,
        resolution: over_angle::plain(task),
        settings: task.settings(),
        wait: TAU,
        curve: OnceCell::new(),
    };
    let forward = CrankMotion(task.equation());
    // Evaluations for rows and events are counted apart: they do not change how far a run goes.
    let looked_at = Counted::new(&forward);
    let mut recorder = ForwardRecorder::new(task, &looked_at, rows);
    let arrived = course.run(&Counted::new(&forward), &mut recorder)?;
    if matches!(arrived.end, End::Integrator(Finish::NoStart)) && arrived.over_angle == 0 {
        return Err(stop_reason::no_start(task));
    }
    let caught = recorder.caught();
    let record = recorder.finish(&arrived)?;
    let wall_s = record.wall_s(begun);
    let stopped = caught.or_else(|| stop_reason::reason(&course, &arrived));
    let warning = arrived
        .on_curve
        .then(|| configuration_curve::warning(task))
        .flatten();
    let mut warnings: Vec<Warning> = warning.into_iter().collect();
    let mut estimate = None;
    if task.options.estimate && stopped.is_none() {
        estimate = estimate::estimate(&course, &arrived, &record, wants_rows);
        warnings.extend(estimate.is_none().then_some(Warning::NotEstimated));
    }
    let now = arrived.now;
    let outcome = Outcome {
        at: now,
        // An engine over the angle names the run, if any piece was over the angle.
        engine: match &arrived.angle_piece {
            Some(piece) => piece.engine,
            None if arrived.over_angle > 0 => Engine::Angle,
            None => Engine::Time,
        },
        turned: now.angle.minus(task.start()),
        estimate,
        balance: energy_balance(&course, &arrived, &record),
        evaluations: arrived.evaluations,
        steps: arrived.steps,
        wall_s,
        warnings,
        stopped,
        record,
    };
    let outcome = match arrived.over_angle {
        0 => outcome,
        _ => outcome.with_bounded_speeds(task),
    };
    Ok(with_motion(outcome.conclude(task), course, arrived))
}

fn energy_balance(course: &Course<'_>, arrived: &Arrived, record: &Record) -> Balance {
    let equation = course.task.equation();
    let on = course.curve.get().filter(|_| arrived.on_curve);
    match (arrived.last, on) {
        (Some(last), Some(on)) if arrived.over_angle == 0 => {
            on.energy_balance(equation, &last, arrived.work, record.fastest())
        }
        _ => {
            let at = &arrived.now;
            let fastest = match arrived.over_angle {
                0 => equation.kinetic_energy(at.angle.rest, record.fastest()),
                _ => 0.0,
            };
            let largest = arrived.largest_kinetic.max(fastest);
            Balance::of_crank(course.task, at, arrived.work, largest)
        }
    }
}

/// Adds the dense motion to the run: a motion over the angle as it stands, one on a curve converted to the crank.
fn with_motion(mut run: Simulation, course: Course<'_>, arrived: Arrived) -> Simulation {
    let alone = arrived.is_one_piece();
    match (arrived.angle_piece, course.curve.into_inner()) {
        (
            Some(AnglePiece {
                run: motion, to, ..
            }),
            _,
        ) if alone => {
            run.trajectory = Some(Trajectory::orbit(motion.orbit, 0.0, to.t));
        }
        (_, Some(on)) if alone => {
            let seen = on.equation.clone();
            let view = move |angle: Angle, speed: f64| {
                let curve = seen.curve();
                (
                    curve.crank_angle(angle),
                    curve.pose(angle.rest).dtheta * speed,
                )
            };
            run.trajectory = run
                .trajectory
                .map(|motion| motion.mapped_to_crank(Arc::new(view)));
            run.dense.curve = Some(on.equation);
        }
        _ => {}
    }
    run
}
