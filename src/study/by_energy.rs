//! Motion from the energy integral.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use super::in_time;
use super::profile::Position;
use super::row::RowSink;
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::summary::{ErrorEstimate, Event, Final, Solved, Summary};
use super::task::Task;
use crate::engine::energy::{Orbit, Unserved};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::plan::{Engine, Method};
use crate::scene::Extent;
use crate::trajectory::Trajectory;

/// Runs a task; one that the energy cannot serve after all is run in time, and its plan says so.
pub(super) fn run(
    task: &mut Task<'_>,
    rows: &mut dyn RowSink,
    record: bool,
) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let profile = Position::new(task.equation(), &task.limits);
    match solve(task, &profile) {
        Ok((orbit, end)) => finish(task, orbit, end, begun.elapsed(), &profile, rows),
        Err(unserved) if task.options.method == Method::Energy => Err(Error::refused(
            format!(
                "method energy cannot serve this scene: {}",
                reason(unserved)
            ),
            "use --method auto or time",
        )),
        Err(unserved) => {
            task.plan.fall_back_to_time(reason(unserved));
            debug_assert_eq!(task.plan.engine, Engine::Time);
            in_time::run(task, rows, record)
        }
    }
}

fn reason(unserved: Unserved) -> &'static str {
    match unserved {
        Unserved::Equilibrium => "it starts at rest without a force",
        Unserved::NotFinite => {
            "the mechanism reaches the limit of its motion, or a load has no value"
        }
        Unserved::TooLong => "its turns differ from each other, and they are too many to be kept",
    }
}

/// The motion and its last time.
fn solve(task: &Task<'_>, profile: &Position<'_>) -> Result<(Orbit, f64), Unserved> {
    let speed = task.scene.motion.speed;
    match task.extent {
        Extent::Duration(duration) => {
            let orbit = Orbit::new(profile, task.start(), speed, duration)?;
            Ok((orbit, duration))
        }
        Extent::Revolutions(turns) => {
            let radians = turns * TAU;
            // Long enough for the turns: twice as long again and again, unless the motion repeats at once.
            let mut until = if speed == 0.0 {
                1.0
            } else {
                radians / speed.abs()
            };
            for _ in 0..60 {
                let orbit = Orbit::new(profile, task.start(), speed, until)?;
                if let Some(end) = orbit.time_of_turn(radians) {
                    return Ok((orbit, end));
                }
                if orbit.period().is_some() || orbit.turns_back() {
                    break;
                }
                until *= 2.0;
            }
            Err(Unserved::TooLong)
        }
    }
}

fn finish(
    task: &Task<'_>,
    orbit: Orbit,
    end: f64,
    wall: Duration,
    profile: &Position<'_>,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    let (angle, omega) = orbit.state(end);
    let turned = angle.minus(task.start());
    let (events, events_total) = events(task, &orbit, end);
    write_rows(task, &orbit, end, rows)?;
    let solved = Solved {
        last: Final {
            t_s: end,
            theta_rad: angle.radians(),
            omega_rad_per_s: omega,
        },
        turned,
        error_estimate: task.options.estimate.then(|| estimate(task, &orbit, end)),
        energy: energy_residual(task.equation(), profile, task, &orbit, end),
        evaluations: profile.evaluations(),
        steps: orbit.panels() as u64,
        wall_s: wall.as_secs_f64(),
        speed: orbit.speed_range(end),
        events,
        events_total,
        ..Solved::default()
    };
    Ok(Simulation {
        summary: Summary::new(task, solved),
        trajectory: Some(Trajectory::orbit(orbit, end)),
    })
}

/// Times are right to `time_error`; an error of time moves the state along the motion. The angle itself is
/// rounded once more.
fn estimate(task: &Task<'_>, orbit: &Orbit, end: f64) -> ErrorEstimate {
    let (angle, omega) = orbit.state(end);
    let late = orbit.time_error() * end;
    let alpha = task.equation().acceleration(end, angle, omega);
    let rounding = f64::EPSILON * (1.0 + angle.radians().abs());
    ErrorEstimate {
        theta_rad: omega.abs() * late + rounding,
        omega_rad_per_s: alpha.abs() * late + 2.0 * f64::EPSILON * omega.abs(),
    }
}

/// The energy of the last state against that of the first, J, and the largest kinetic energy.
fn energy_residual(
    equation: &Equation,
    profile: &Position<'_>,
    task: &Task<'_>,
    orbit: &Orbit,
    end: f64,
) -> (f64, f64) {
    let start = task.start();
    let (angle, omega) = orbit.state(end);
    let turns = Angle {
        turns: angle.turns - start.turns,
        rest: angle.rest,
    };
    let begin = equation.kinetic_energy(start.rest, task.scene.motion.speed)
        + equation.potential_energy(start.rest);
    let last = equation.kinetic_energy(angle.rest, omega) + equation.potential_energy(turns);
    let work = profile.work(start.rest, angle.rest);
    let range = orbit.speed_range(end);
    let fastest = range.0.abs().max(range.1.abs());
    let scale = equation.kinetic_energy(angle.rest, fastest);
    (last - begin - work, scale.max(begin.abs()))
}

/// Dead centres and turning points in the order of time: those of a period again and again.
fn events(task: &Task<'_>, orbit: &Orbit, end: f64) -> (Vec<Event>, u64) {
    let dead_centres: Vec<f64> = task.limits.dead_centres.iter().map(|dc| dc.theta).collect();
    let is_dead_centre = |theta: f64| {
        dead_centres.iter().any(|dead_centre| {
            let apart = (theta - dead_centre).rem_euclid(TAU);
            apart.min(TAU - apart) < 1e-12
        })
    };
    let mut once: Vec<(f64, &'static str, Angle, f64)> = Vec::new();
    for passage in orbit.passages() {
        let kind = if passage.turning {
            "turning-point"
        } else if is_dead_centre(passage.angle.rest) {
            "dead-centre"
        } else {
            continue;
        };
        once.push((passage.t, kind, passage.angle, passage.speed));
    }
    let period = orbit.period().map_or(f64::INFINITY, |period| period.0);
    let total = once
        .iter()
        .filter(|event| event.0 <= end)
        .map(|event| {
            if period.is_finite() {
                ((end - event.0) / period).floor() + 1.0
            } else {
                1.0
            }
        })
        .sum::<f64>();
    let mut events = Vec::new();
    let mut round = 0.0;
    'all: loop {
        for (t, kind, angle, speed) in &once {
            let t = if round == 0.0 { *t } else { t + round * period };
            if t > end || events.len() >= task.options.events_kept {
                break 'all;
            }
            let turns = if orbit.rotates() {
                round * task.scene.motion.speed.signum()
            } else {
                0.0
            };
            let angle = Angle {
                turns: angle.turns + turns,
                rest: angle.rest,
            };
            events.push(Event {
                kind,
                t_s: t,
                theta_rad: angle.radians(),
                omega_rad_per_s: *speed,
            });
        }
        round += 1.0;
        if !period.is_finite() || once.is_empty() {
            break;
        }
    }
    (events, total as u64)
}

fn write_rows(
    task: &Task<'_>,
    orbit: &Orbit,
    end: f64,
    rows: &mut dyn RowSink,
) -> Result<(), Error> {
    if !rows.wants_rows() {
        return Ok(());
    }
    let mut write = |t: f64| {
        let (angle, omega) = orbit.state(t);
        rows.row(&task.maker.row(t, angle, omega, None))
    };
    let schedule = Schedule::new(task.scene.run.output_every, task.extent);
    if let Some(step) = schedule.angle_step() {
        write(0.0)?;
        each_angle(task, orbit, end, step, &mut write)?;
    } else {
        let mut index = 0;
        while let Some(t) = schedule.time(index).filter(|t| *t < end) {
            write(t)?;
            index += 1;
        }
    }
    write(end)
}

/// Times at which the angle from the start passes multiples of `step`.
fn each_angle(
    task: &Task<'_>,
    orbit: &Orbit,
    end: f64,
    step: f64,
    write: &mut impl FnMut(f64) -> Result<(), Error>,
) -> Result<(), Error> {
    let turned = |t: f64| orbit.state(t).0.minus(task.start());
    let mut from = 0.0;
    let mut turnings = orbit.turning_times(end);
    turnings.push(end);
    for to in turnings {
        let (a, b) = (turned(from) / step, turned(to) / step);
        let count = (b.abs().floor() - a.abs().floor()).abs() as u64;
        if orbit.rotates() {
            for k in 1..=count {
                if let Some(t) = orbit.time_of_turn((a.abs().floor() + k as f64) * step)
                    && t < end
                {
                    write(t)?;
                }
            }
        } else {
            let (low, high) = (a.min(b).floor() as i64 + 1, a.max(b).floor() as i64);
            let mut targets: Vec<i64> = (low..=high).collect();
            if b < a {
                targets.reverse();
            }
            for k in targets {
                let target = k as f64 * step;
                if let Some(t) = root::bracketed(|t| turned(t) - target, from, to)
                    && t < end
                {
                    write(t)?;
                }
            }
        }
        from = to;
    }
    Ok(())
}
