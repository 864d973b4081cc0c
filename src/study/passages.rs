//! Events and rows of a motion that is known as a whole.

use std::f64::consts::TAU;

use super::row::RowSink;
use super::schedule::{Schedule, passed};
use super::summary::Event;
use super::task::Task;
use crate::engine::energy::Orbit;
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// Dead centres and turning points in the order of time: those of a period again and again.
pub(super) fn events(task: &Task<'_>, orbit: &Orbit, end: f64) -> (Vec<Event>, u64) {
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
        .filter(|event| event.0 <= end * (1.0 + 1e-14))
        .map(|event| {
            if period.is_finite() {
                ((end - event.0) / period + 1e-9).floor() + 1.0
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
            if t > end * (1.0 + 1e-14) || events.len() >= task.options.events_kept {
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
    let later = later_events(task, orbit, end, &is_dead_centre, &mut events);
    (events, total as u64 + later)
}

/// Adds the dead centres of the turns after the first ones, and says how many there are.
fn later_events(
    task: &Task<'_>,
    orbit: &Orbit,
    end: f64,
    is_dead_centre: &dyn Fn(f64) -> bool,
    events: &mut Vec<Event>,
) -> u64 {
    let kept = task.options.events_kept;
    orbit.later_passages(|passage| {
        if passage.t > end * (1.0 + 1e-14) {
            return false;
        }
        if is_dead_centre(passage.angle.rest) && events.len() < kept {
            events.push(Event {
                kind: "dead-centre",
                t_s: passage.t,
                theta_rad: passage.angle.radians(),
                omega_rad_per_s: passage.speed,
            });
        }
        events.len() < kept
    });
    // Each dead centre is passed once in a turn.
    let Some(begin) = orbit.later_from() else {
        return 0;
    };
    let way = (orbit.state(end).0.minus(task.start()).abs(), begin);
    let direction = task.scene.motion.speed.signum();
    let passes = |dead_centre: &f64| {
        let ahead = (direction * (dead_centre - task.start().rest)).rem_euclid(TAU);
        let until = |way: f64| ((way - ahead) / TAU + 1e-12).floor();
        (until(way.0) - until(way.1)).max(0.0) as u64
    };
    let all = task.limits.dead_centres.iter().map(|dc| dc.theta);
    all.map(|theta| passes(&theta)).sum()
}

/// Rows of the run.
pub(super) fn write_rows(
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
    // The end is a row of its own.
    let last = end * (1.0 - 1e-12);
    let mut from = 0.0;
    let mut turnings = orbit.turning_times(end);
    turnings.push(end);
    for to in turnings {
        for k in passed(turned(from) / step, turned(to) / step) {
            let target = k as f64 * step;
            let t = if orbit.rotates() {
                orbit.time_of_turn(target.abs())
            } else {
                root::bracketed(|t| turned(t) - target, from, to)
            };
            // A turning point may fall short of its angle by rounding.
            let t = t.unwrap_or(to);
            if t < last {
                write(t)?;
            }
        }
        from = to;
    }
    Ok(())
}
