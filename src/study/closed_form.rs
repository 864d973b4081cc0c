//! Prescribed constant speed: nothing to integrate, the equation read backwards.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use super::drive::Drive;
use super::row::RowSink;
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::summary::{ErrorEstimate, Event, Final, Solved, Summary};
use super::task::Task;
use crate::error::Error;
use crate::mechanism::{Class, Limits};
use crate::numeric::angle::Angle;
use crate::scene::Extent;
use crate::trajectory::Trajectory;

pub(super) fn run(task: &Task<'_>, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let start = task.start();
    let speed = task.scene.motion.speed;
    if let Some(reason) = impossible(task, start) {
        return Err(reason);
    }
    let asked = duration(task.extent, speed)?;
    let blocked = time_to_limit(task, start, speed).filter(|t| *t < asked);
    let end = blocked.unwrap_or(asked);
    let last = start.plus(speed * end);
    let (events, events_total) = events(task, start, speed, end);
    let drive = Drive {
        equation,
        start,
        speed,
        end,
    };
    let torque = drive.torque_range();
    let wall_s = begun.elapsed();
    write_rows(task, rows, start, speed, end, blocked.is_some())?;
    let solved = Solved {
        last: Final {
            t_s: end,
            theta_rad: last.radians(),
            omega_rad_per_s: speed,
        },
        turned: speed * end,
        error_estimate: Some(ErrorEstimate {
            theta_rad: 2.0 * f64::EPSILON * last.radians().abs(),
            omega_rad_per_s: 0.0,
        }),
        energy: drive.energy_residual(),
        wall_s: Duration::as_secs_f64(&wall_s),
        speed: (speed, speed),
        driving_torque: torque,
        events,
        events_total,
        stopped: blocked.map(|t| {
            format!(
                "the crank reaches the limit of its motion at t = {t} s, theta = {} rad: the rod stands normal to the guide there and no constant speed passes it",
                last.radians()
            )
        }),
        ..Solved::default()
    };
    Ok(Simulation {
        summary: Summary::new(task, solved),
        trajectory: Some(Trajectory::uniform(start, speed, end)),
    })
}

/// Crank angles that can be reached. A change point is not passed: the slider's velocity would jump there.
fn reach(task: &Task<'_>) -> Vec<[f64; 2]> {
    match task.limits.class {
        Class::ChangePoint => Limits::clear_reach(task.equation().linkage()),
        _ => task.limits.reach.clone(),
    }
}

fn impossible(task: &Task<'_>, start: Angle) -> Option<Error> {
    let reach = reach(task);
    let inside = reach.is_empty()
        || reach.iter().any(|[from, to]| {
            let turned = (start.rest - from).rem_euclid(TAU);
            turned <= to - from
        });
    (!inside).then(|| {
        Error::refused(
            format!(
                "motion.angle: the rod does not reach the guide at crank angle {} rad",
                start.radians()
            ),
            "give an angle that `kinematics` shows as reachable",
        )
    })
}

pub(super) fn duration(extent: Extent, speed: f64) -> Result<f64, Error> {
    match extent {
        Extent::Duration(duration) => Ok(duration),
        Extent::Revolutions(turns) if speed != 0.0 => Ok(turns * TAU / speed.abs()),
        Extent::Revolutions(0.0) => Ok(0.0),
        Extent::Revolutions(turns) => Err(Error::refused(
            format!("a crank at rest never completes {turns} turns"),
            "give motion.speed, or run.duration",
        )),
    }
}

/// When the crank reaches the end of the angles it can take, if there is one.
fn time_to_limit(task: &Task<'_>, start: Angle, speed: f64) -> Option<f64> {
    let [from, to] = reach(task)
        .into_iter()
        .find(|[from, to]| (start.rest - from).rem_euclid(TAU) <= to - from)?;
    let done = (start.rest - from).rem_euclid(TAU);
    let left = if speed > 0.0 { to - from - done } else { done };
    (speed != 0.0).then(|| left / speed.abs())
}

/// Passages of the dead centres, in the order of time.
pub(super) fn events(task: &Task<'_>, start: Angle, speed: f64, end: f64) -> (Vec<Event>, u64) {
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
    task: &Task<'_>,
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
        Schedule::Angles { step } if speed != 0.0 => Schedule::Times {
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
