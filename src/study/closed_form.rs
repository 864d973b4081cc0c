//! Prescribed constant speed: nothing to integrate, the equation read backwards.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use super::drive::Drive;
use super::row::RowSink;
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::stopped;
use super::summary::{ErrorEstimate, Event, Final, Solved, Summary};
use super::task::Task;
use crate::error::Error;
use crate::mechanism::{Class, Limits, Linkage};
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
        maker: &task.maker,
        start,
        speed,
        end,
    };
    // Towards a limit, or where the guide locks itself, torque and energy grow without bound.
    let (torque, energy) = match blocked {
        Some(_) => (None, (f64::NAN, f64::NAN)),
        None => (Some(drive.torque_range()), drive.energy_residual()),
    };
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
        energy,
        wall_s: Duration::as_secs_f64(&wall_s),
        speed: (speed, speed),
        driving_torque: torque.and_then(Result::ok),
        warnings: torque
            .and_then(Result::err)
            .map(str::to_owned)
            .into_iter()
            .collect(),
        events,
        events_total,
        stopped: blocked.map(|t| {
            let what = match lock(task) {
                Some(_) => "the guide locks itself from here on, as the coefficient of friction times tan phi reaches 1: no crank torque keeps up the speed",
                None => "the crank reaches the limit of its motion: the rod stands normal to the guide there and no constant speed passes it",
            };
            format!("{what}; stopped at t = {t} s, theta = {} rad", last.radians())
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
    if let Some(shorter) = lock(task) {
        return Limits::new(&shorter, 0.0).reach;
    }
    match task.limits.class {
        Class::ChangePoint => Limits::clear_reach(task.equation().linkage()),
        _ => task.limits.reach.clone(),
    }
}

/// The linkage that reaches as far as the guide with its friction does not lock itself, if there are positions
/// in which it does: μ |tan φ| = 1 where |e + r sin θ| = l/sqrt(1 + μ²).
fn lock(task: &Task<'_>) -> Option<Linkage> {
    let guide = task.maker.guide.as_ref()?;
    let mu = guide.friction()?.coefficient;
    let linkage = task.equation().linkage();
    let shorter = linkage.with_rod(linkage.l / mu.hypot(1.0));
    (shorter.margin() <= 0.0).then_some(shorter)
}

fn impossible(task: &Task<'_>, start: Angle) -> Option<Error> {
    let reach = reach(task);
    let inside = reach.is_empty()
        || reach.iter().any(|[from, to]| {
            let turned = (start.rest - from).rem_euclid(TAU);
            turned <= to - from
        });
    (!inside).then(|| {
        let theta = start.radians();
        match lock(task) {
            Some(_) => Error::refused(
                format!(
                    "motion.angle: at crank angle {theta} rad the guide locks itself, as the coefficient of friction times tan phi is 1 or more: no crank torque moves it at constant speed"
                ),
                "start where |e + r sin(theta)| is less than l/sqrt(1 + coefficient^2), or reduce the friction",
            ),
            None => Error::refused(
                format!("motion.angle: the rod does not reach the guide at crank angle {theta} rad"),
                "give an angle that `kinematics` shows as reachable",
            ),
        }
    })
}

pub(super) fn duration(extent: Extent, speed: f64) -> Result<f64, Error> {
    match extent {
        Extent::Duration(duration) => Ok(duration),
        Extent::Revolutions(turns) if speed != 0.0 => Ok(turns * TAU / speed.abs()),
        Extent::Revolutions(turns) => Err(stopped::never_turns(turns)),
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
    let scene = || Schedule::new(every, Extent::Duration(end));
    let schedule = match task.looked_at.unwrap_or_else(scene) {
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
