//! Prescribed constant speed: nothing to integrate, the equation read backwards.

use std::f64::consts::TAU;
use std::time::Instant;

use super::driving_torque::Drive;
use super::outcome::{Balance, Estimate, Outcome};
use super::record::Record;
use super::result::{ErrorEstimate, Event};
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::schedule::Schedule;
use super::simulation::Simulation;
use super::stop::Why;
use crate::engine::time::Start;
use crate::error::Error;
use crate::mechanism::{CurveEquation, Limits};
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::scene::Extent;
use crate::trajectory::Trajectory;

pub(super) fn run(task: &RunSetup<'_>, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let start = task.start();
    let speed = task.scene.motion.speed;
    let asked = duration(task.extent, speed);
    let blocked = time_to_limit(task, start, speed).filter(|t| *t < asked);
    let end = blocked.unwrap_or(asked);
    let last = start.plus(speed * end);
    let (events, events_total) = events(task, start, speed, end);
    let drive = Drive {
        equation,
        maker: &task.maker,
        start,
        speed,
        end,
    };
    // Towards a limit, or where the guide locks itself, torque and energy grow without bound.
    let unbounded = Balance {
        residual: f64::NAN,
        largest: f64::NAN,
    };
    let (torque, warning, balance) = match blocked.is_none().then(|| drive.torque_range()) {
        Some(Ok(range)) => (Some(range), None, drive.energy_balance()),
        Some(Err(why)) => (None, Some(why), drive.energy_balance()),
        None => (None, None, unbounded),
    };
    let wall_s = begun.elapsed().as_secs_f64();
    write_rows(task, rows, start, speed, end, blocked.is_some())?;
    let stopped = blocked.map(|_| match equation.linkage().unlocked(friction(task)) {
        Some(_) => Why::Locked,
        None => Why::DrivenToLimit,
    });
    let outcome = Outcome {
        at: Start {
            t: end,
            angle: last,
            speed,
        },
        engine: Engine::ClosedForm,
        turned: speed * end,
        estimate: Some(Estimate::of_end(
            ErrorEstimate {
                theta_rad: 2.0 * f64::EPSILON * last.radians().abs(),
                omega_rad_per_s: 0.0,
            },
            None,
        )),
        balance,
        evaluations: 0,
        steps: 0,
        wall_s,
        warnings: warning.into_iter().collect(),
        stopped,
        record: Record {
            events,
            events_total,
            ..Record::new(speed)
        },
    };
    let mut run = outcome.conclude(task);
    run.summary.driving_torque = torque;
    run.trajectory = Some(Trajectory::uniform(start, speed, end));
    Ok(run)
}

/// The coefficient of friction of the guide.
fn friction(task: &RunSetup<'_>) -> f64 {
    let friction = task.maker.guide.and_then(CurveEquation::friction);
    friction.map_or(0.0, |friction| friction.coefficient)
}

fn reach(task: &RunSetup<'_>) -> Vec<[f64; 2]> {
    Limits::driven_reach(task.equation().linkage(), friction(task))
}

/// How long a run at constant speed (rad/s) takes, s.
pub(super) fn duration(extent: Extent, speed: f64) -> f64 {
    match extent {
        Extent::Duration(duration) => duration,
        Extent::Revolutions(turns) => turns * TAU / speed.abs(),
    }
}

/// When the crank reaches the end of the angles it can take, if there is one.
fn time_to_limit(task: &RunSetup<'_>, start: Angle, speed: f64) -> Option<f64> {
    let [from, to] = reach(task)
        .into_iter()
        .find(|[from, to]| (start.rest - from).rem_euclid(TAU) <= to - from)?;
    let done = (start.rest - from).rem_euclid(TAU);
    let left = if speed > 0.0 { to - from - done } else { done };
    (speed != 0.0).then(|| left / speed.abs())
}

/// Passages of the dead centres, in the order of time.
pub(super) fn events(task: &RunSetup<'_>, start: Angle, speed: f64, end: f64) -> (Vec<Event>, u64) {
    if speed == 0.0 {
        return (Vec::new(), 0);
    }
    let first: Vec<f64> = task
        .limits
        .dead_centres
        .iter()
        .map(|dead_centre| {
            let ahead = (speed.signum() * (dead_centre.theta - start.rest)).rem_euclid(TAU);
            if ahead == 0.0 { TAU } else { ahead }
        })
        .collect();
    let turned = speed.abs() * end;
    let passages = |ahead: f64| {
        if turned < ahead {
            0.0
        } else {
            ((turned - ahead) / TAU).floor() + 1.0
        }
    };
    let total: f64 = first.iter().map(|ahead| passages(*ahead)).sum();
    let mut angles: Vec<f64> = first
        .iter()
        .flat_map(|ahead| {
            let count = passages(*ahead).min(task.options.events_kept as f64) as usize;
            (0..count).map(move |turn| ahead + turn as f64 * TAU)
        })
        .collect();
    angles.sort_by(f64::total_cmp);
    angles.truncate(task.options.events_kept);
    let events = angles
        .into_iter()
        .map(|ahead| Event {
            kind: "dead-centre",
            t_s: ahead / speed.abs(),
            theta_rad: start.plus(speed.signum() * ahead).radians(),
            omega_rad_per_s: speed,
        })
        .collect();
    (events, total as u64)
}

fn write_rows(
    task: &RunSetup<'_>,
    rows: &mut dyn RowSink,
    start: Angle,
    speed: f64,
    end: f64,
    blocked: bool,
) -> Result<(), Error> {
    if !rows.wants_rows() {
        return Ok(());
    }
    let every = task.scene.run.output_every;
    let schedule = match Schedule::new(every, Extent::Duration(end)) {
        // A crank at rest passes no angles: its first state and its last are the rows.
        Schedule::Angles { .. } if speed == 0.0 => Schedule::Times { step: end, end },
        Schedule::Angles { step } => Schedule::Times {
            step: step / speed.abs(),
            end,
        },
        schedule => schedule,
    };
    let mut write = |t: f64| rows.row(&task.maker.row(t, start.plus(speed * t), speed, Some(0.0)));
    let mut index = 0;
    while let Some(t) = schedule.time(index) {
        write(t)?;
        index += 1;
    }
    // The limit itself has no finite velocity.
    if blocked { Ok(()) } else { write(end) }
}
