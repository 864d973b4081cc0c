//! Prescribed constant speed: nothing to integrate, the equation read backwards.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use super::row::RowSink;
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::summary::{ErrorEstimate, Event, Final, Solved, Summary, TorqueRange};
use super::task::Task;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::numeric::gauss;
use crate::scene::{Extent, Variable};
use crate::trajectory::Trajectory;

/// Samples of the driving torque in a turn.
const SAMPLES: usize = 720;

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
    let torque = torque_range(equation, start, speed, end);
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
        energy: energy_residual(equation, start, speed, end),
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

fn impossible(task: &Task<'_>, start: Angle) -> Option<Error> {
    let inside = task.limits.reach.is_empty()
        || task.limits.reach.iter().any(|[from, to]| {
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

fn duration(extent: Extent, speed: f64) -> Result<f64, Error> {
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
    let [from, to] = task
        .limits
        .reach
        .iter()
        .copied()
        .find(|[from, to]| (start.rest - from).rem_euclid(TAU) <= to - from)?;
    let done = (start.rest - from).rem_euclid(TAU);
    let left = if speed > 0.0 { to - from - done } else { done };
    (speed != 0.0).then(|| left / speed.abs())
}

/// Passages of the dead centres, in the order of time.
fn events(task: &Task<'_>, start: Angle, speed: f64, end: f64) -> (Vec<Event>, u64) {
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

/// Smallest, largest and mean driving torque: over one turn if loads do not depend on time and the run is
/// longer, else over the run.
fn torque_range(equation: &Equation, start: Angle, speed: f64, end: f64) -> Option<TorqueRange> {
    let turn = TAU / speed.abs();
    let reads = equation.loads().reads();
    let periodic = !reads.has(Variable::T) && !reads.has(Variable::Theta);
    let span = if periodic && turn < end { turn } else { end };
    let count = if span > 0.0 {
        ((span / turn * SAMPLES as f64).ceil() as usize).clamp(SAMPLES, 100 * SAMPLES)
    } else {
        1
    };
    let torque = |t: f64| {
        let angle = start.plus(speed * t);
        equation.driving_torque(t, angle, speed, 0.0)
    };
    let (mut min, mut max, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for i in 0..=count {
        let value = torque(span * i as f64 / count as f64);
        if !value.is_finite() {
            return None;
        }
        min = min.min(value);
        max = max.max(value);
        sum += if i == 0 || i == count {
            0.5 * value
        } else {
            value
        };
    }
    Some(TorqueRange {
        min_nm: min,
        max_nm: max,
        mean_nm: sum / count as f64,
    })
}

/// Work that the equation asks for on the way, by quadrature, against the energies at its ends: ½ M' and V'
/// against M and V. Whole turns bring nothing.
fn energy_residual(equation: &Equation, start: Angle, speed: f64, end: f64) -> (f64, f64) {
    let travel = (speed * end) % TAU;
    let energy =
        |theta: f64| equation.kinetic_energy(theta, speed) + equation.gravity_energy(theta);
    let work = |theta: f64| {
        let terms = equation.terms(theta);
        equation.generalized_force(&terms, speed, 0.0)
    };
    let (from, to) = (start.rest, start.rest + travel);
    let change = energy(to) - energy(from);
    let mut panels = 64;
    let mut integral = gauss::composite(work, from, to, panels);
    while panels < 1 << 14 {
        panels *= 2;
        let finer = gauss::composite(work, from, to, panels);
        let same = (finer - integral).abs() <= 1e-13 * energy(from).abs();
        integral = finer;
        if same {
            break;
        }
    }
    let residual = integral - change;
    if residual.is_finite() {
        (
            residual,
            energy(from).abs().max(equation.kinetic_energy(from, speed)),
        )
    } else {
        (0.0, 0.0)
    }
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
