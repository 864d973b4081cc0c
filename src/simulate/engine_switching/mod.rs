//! Runs that the engines hand to one another: over the crank angle while the crank turns, in time where it comes
//! near to rest, and back.

mod arrived;
mod clear;
mod course;
mod estimate;
mod friction;
mod notes;

use std::f64::consts::TAU;
use std::time::Instant;

use arrived::{Arrived, End};
use course::Course;
use estimate::estimate;
use notes::Notes;

use super::angle_model::AngleModel;
use super::angle_motion::balance;
use super::by_angle::{self, First};
use super::configuration_curve;
use super::error_estimate::Forward;
use super::outcome::{Estimate, Outcome};
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::simulation::Simulation;
use super::stop_reason;
use crate::engine::Counted;
use crate::engine::step::{Node, Step};
use crate::engine::time::Finish;
use crate::error::Error;
use crate::plan::{Method, Plan};

/// How far the crank turns in one direction before the angle takes over again, rad.
const WAIT: f64 = TAU;

/// Runs a task; `first` is its first piece over the angle, if it begins with one.
pub(super) fn run(
    task: &mut RunSetup<'_>,
    position: &AngleModel<'_>,
    first: Option<Box<First>>,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let course = Course {
        equation,
        position,
        start: task.first_state(),
        extent: task.extent,
        resolution: by_angle::plain(task),
        settings: task.settings(),
        sliding: task.maker.sliding,
        wait: WAIT,
        max_evaluations: task.options.max_evaluations,
    };
    let (wall_s, places) = first.as_ref().map_or((0.0, 0), |f| (f.wall_s, f.places));
    let forward = Forward(equation);
    let looked_at = Counted::new(&forward);
    let mut notes = Notes::new(task, &looked_at, rows);
    let mut arrived = course.run(first.map(|first| first.driving), &mut notes)?;
    arrived.evaluations += places;
    if arrived.end == End::Integrator(Finish::NoStart) && arrived.now == course.start {
        return Err(stop_reason::no_start(
            course.start.angle,
            course.start.speed,
        ));
    }
    let caught = notes.caught(&arrived);
    let record = notes.finish(&arrived)?;
    let wall_s = wall_s + record.wall_s(begun);
    let stopped = caught.or_else(|| stopped(task, &arrived));
    let mut warnings = Vec::new();
    let second = || estimate(task, &course, &arrived);
    let estimated = task.estimate(stopped.as_ref(), &mut warnings, second);
    name_pieces(task, &arrived)?;
    let now = arrived.now;
    let outcome = Outcome {
        at: now,
        turned: now.angle.minus(task.start()),
        estimate: estimated.map(|(error, cost)| Estimate::of_end(error, Some(cost))),
        balance: balance(task, &now, arrived.work, arrived.largest_kinetic),
        evaluations: arrived.evaluations,
        steps: arrived.steps,
        wall_s,
        warnings,
        stopped,
        record,
    };
    Ok(outcome.with_bounded_speeds(task).conclude(task))
}

/// Why the run ended before its time, if it did.
fn stopped(task: &RunSetup<'_>, arrived: &Arrived) -> Option<String> {
    if let (Some(rubbed), Some(sliding)) = (&arrived.rubbed, task.maker.sliding) {
        return configuration_curve::why(task, rubbed, sliding.equation());
    }
    let End::Integrator(finish) = arrived.end else {
        return None;
    };
    let now = &arrived.now;
    let node = Node {
        t: now.t,
        theta: now.angle.rest,
        omega: now.speed,
        ..Node::default()
    };
    let last = Step::new(now.angle.turns, node, node);
    stop_reason::reason(
        finish,
        task.equation(),
        arrived.impossible,
        &last,
        &task.extent,
    )
}

/// Says in the plan which engines computed the run.
fn name_pieces(task: &mut RunSetup<'_>, arrived: &Arrived) -> Result<(), Error> {
    if arrived.over_angle == 0 {
        task.plan = Plan::new(task.scene, Method::Time)?;
        task.plan.reason = "integration in time, for the crank comes too near to rest".into();
        return Ok(());
    }
    let times = |count: u64| match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        _ => format!("{count} times"),
    };
    let (there, back) = (times(arrived.to_time), times(arrived.to_angle));
    let reason = match (arrived.to_time, arrived.to_angle) {
        (0, 0) => return Ok(()),
        (0, _) => format!(
            "over the crank angle; near to rest in time, from which it was handed back {back}"
        ),
        (_, 0) => format!(
            "over the crank angle; near to rest in time, to which it was handed over {there}"
        ),
        _ => format!(
            "over the crank angle; near to rest in time, to which it was handed over {there}, and back {back}"
        ),
    };
    task.plan.reason = reason.into();
    Ok(())
}
