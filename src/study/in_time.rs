//! Motion by integration in time.

use std::f64::consts::TAU;
use std::time::Instant;

use super::forward;
use super::row::RowSink;
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::summary::{Final, Solved, Summary};
use super::task::Task;
use super::watch::{Seen, Watch, radians};
use crate::engine::Counted;
use crate::engine::library;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::mechanism::{Equation, Limits, Obstacle};
use crate::numeric::angle::Angle;
use crate::plan::Stepper;
use crate::scene::Extent;
use crate::trajectory::Trajectory;

/// Runs a task.
pub(super) fn run(
    task: &Task<'_>,
    rows: &mut dyn RowSink,
    record: bool,
) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let forward = forward::Forward(equation);
    let motion = Counted::new(&forward);
    let start = Start {
        t: 0.0,
        angle: task.start(),
        speed: task.scene.motion.speed,
    };
    let settings = settings(task, equation);
    let reach = Limits::clear_reach(equation.linkage());
    if !inside(&reach, start.angle.rest) {
        return Err(no_start(equation, start, &task.limits));
    }
    let dead_centres = task.limits.dead_centres.iter().map(|dc| dc.theta);
    let guards = reach.iter().flatten().map(|angle| angle.rem_euclid(TAU));
    let watched = dead_centres.chain(guards).collect();
    let mut watch = Watch {
        motion: &motion,
        maker: &task.maker,
        rows,
        schedule: Schedule::new(task.scene.run.output_every, task.extent),
        start,
        dead_centres: task.limits.dead_centres.len(),
        watched,
        turn_limit: match task.extent {
            Extent::Revolutions(turns) => Some(radians(turns)),
            Extent::Duration(_) => None,
        },
        events_kept: task.options.events_kept,
        seen: Seen::new(start.speed),
        recorded: record.then(Vec::new),
    };
    let (mut finish, mut last, steps) =
        time::run(&motion, start, &settings, &mut |step| watch.step(step));
    if let Some(error) = watch.seen.error.take() {
        return Err(error);
    }
    if finish == Finish::NoStart {
        return Err(no_start(equation, start, &task.limits));
    }
    if let Some(t) = watch.seen.ends_at {
        last = shortened(&motion, &last, t, &settings);
        finish = Finish::AtEnd;
    }
    watch.write_last_row(&last)?;
    let (seen, recorded) = (watch.seen, watch.recorded);
    let wall_s = (begun.elapsed() - seen.row_time).as_secs_f64();
    let evaluations = motion.evaluations();
    let stopped = if seen.at_limit {
        Some(at_limit(&last))
    } else {
        stopped(finish, equation, &motion, &last, &task.extent)
    };
    let largest_speed = seen.speed.0.abs().max(seen.speed.1.abs());
    let estimate = if task.options.estimate && stopped.is_none() {
        forward::estimate(equation, start, &settings, &last, steps, largest_speed)
    } else {
        None
    };
    let angle = last.angle(last.end.theta);
    let mut warnings = Vec::new();
    if task.options.estimate && stopped.is_none() && estimate.is_none() {
        let why = "the error could not be estimated: the second, tighter run did not finish";
        warnings.push(why.to_owned());
    }
    let t_end = last.end.t;
    let solved = Solved {
        last: Final {
            t_s: t_end,
            theta_rad: angle.radians(),
            omega_rad_per_s: last.end.omega,
        },
        turned: angle.minus(start.angle),
        error_estimate: estimate.map(|(error, _)| error),
        energy: energy_residual(equation, start, &last, largest_speed),
        evaluations,
        steps,
        wall_s,
        estimate_cost: estimate.map(|(_, cost)| cost),
        speed: seen.speed,
        driving_torque: None,
        events: seen.events,
        events_total: seen.events_total,
        warnings,
        stopped,
    };
    Ok(Simulation {
        summary: Summary::new(task, solved),
        trajectory: recorded.map(|steps| Trajectory::from_steps(steps, t_end)),
    })
}

/// A run that ends after a number of turns has no last time of its own.
const FAR: f64 = 1e9;

fn settings(task: &Task<'_>, equation: &Equation) -> Settings {
    let motion = &task.scene.motion;
    let inertia = equation.terms(motion.angle).inertia.m;
    let unit = 0.5 * inertia * motion.speed.powi(2).max(1.0);
    Settings {
        method: match task.plan.stepper {
            Some(Stepper::Dopri5) => library::Method::Dopri5,
            _ => library::Method::Dop853,
        },
        tolerance: task.scene.run.tolerance,
        t_end: match task.extent {
            Extent::Duration(duration) => duration,
            Extent::Revolutions(_) => FAR,
        },
        max_evaluations: task.options.max_evaluations,
        work_unit: if unit > 0.0 { unit } else { 1.0 },
    }
}

/// The step ended at time `t` inside it, integrated anew.
fn shortened(motion: &Counted<'_>, step: &Step, t: f64, settings: &Settings) -> Step {
    let start = Start {
        t: step.start.t,
        angle: step.angle(step.start.theta),
        speed: step.start.omega,
    };
    let settings = Settings {
        t_end: t,
        max_evaluations: u64::MAX,
        ..*settings
    };
    let (_, mut end, _) = time::run(motion, start, &settings, &mut |_| false);
    end.end.work += step.start.work;
    end
}

/// Energy at the end minus energy at the start minus work, J, and the largest energy that occurs.
fn energy_residual(equation: &Equation, start: Start, last: &Step, speed: f64) -> (f64, f64) {
    let angle = last.angle(last.end.theta);
    // Whole turns that both ends share are taken off, so that they cost no digits of the potential.
    let common = Angle {
        turns: start.angle.turns,
        rest: 0.0,
    };
    let relative = |angle: Angle| Angle {
        turns: angle.turns - common.turns,
        rest: angle.rest,
    };
    let kinetic = [
        equation.kinetic_energy(start.angle.rest, start.speed),
        equation.kinetic_energy(angle.rest, last.end.omega),
    ];
    let potential = [
        equation.potential_energy(relative(start.angle)),
        equation.potential_energy(relative(angle)),
    ];
    let gained = (kinetic[1] - kinetic[0]) + (potential[1] - potential[0]);
    let peak = equation.kinetic_energy(angle.rest, speed);
    let scale = [
        kinetic[0],
        kinetic[1],
        potential[1] - potential[0],
        last.end.work,
        peak,
    ]
    .into_iter()
    .fold(0.0, |largest: f64, energy| largest.max(energy.abs()));
    (gained - last.end.work, scale)
}

fn at_limit(last: &Step) -> String {
    format!(
        "the crank reaches the limit of its motion, where the rod stands normal to the guide: stopped at t = {} s, theta = {} rad; this version does not pass it",
        last.end.t,
        last.angle(last.end.theta).radians()
    )
}

/// Whether a crank angle in [0, 2π) lies in one of the intervals; no intervals: anywhere.
fn inside(reach: &[[f64; 2]], theta: f64) -> bool {
    let within = |[from, to]: &[f64; 2]| (theta - from).rem_euclid(TAU) <= to - from;
    reach.is_empty() || reach.iter().any(within)
}

/// Why a run ended before its time.
fn stopped(
    finish: Finish,
    equation: &Equation,
    motion: &Counted<'_>,
    last: &Step,
    extent: &Extent,
) -> Option<String> {
    let end = &last.end;
    let place = format!(
        "at t = {} s, theta = {} rad, omega = {} rad/s",
        end.t,
        last.angle(end.theta).radians(),
        end.omega
    );
    match (finish, extent) {
        (Finish::AtEnd, Extent::Revolutions(turns)) if end.t >= FAR => Some(format!(
            "the crank does not complete {turns} turns: stopped {place}; give a duration instead"
        )),
        (Finish::AtEnd | Finish::Stopped | Finish::NoStart, _) => None,
        (Finish::WorkLimit, _) => Some(format!(
            "the work limit of evaluations is reached: stopped {place}; raise --max-evaluations, shorten the run or loosen the tolerance"
        )),
        (Finish::StepTooSmall, _) => {
            let (t, angle, speed) =
                motion
                    .impossible()
                    .unwrap_or((end.t, last.angle(end.theta), end.omega));
            Some(match equation.obstacle(t, angle, speed) {
                Some(Obstacle::Blocked) => at_limit(last),
                Some(Obstacle::Load) => format!(
                    "a load has no finite value at t = {t} s, theta = {} rad, omega = {speed} rad/s (outside its table, or outside the domain of its formula): stopped {place}",
                    angle.radians()
                ),
                Some(Obstacle::NoInertia) => {
                    format!(
                        "the effective inertia vanishes: stopped {place}; give the crank an inertia"
                    )
                }
                None => format!(
                    "the equation is singular or too stiff for this method: stopped {place}"
                ),
            })
        }
    }
}

fn no_start(equation: &Equation, start: Start, limits: &Limits) -> Error {
    let theta = start.angle.radians();
    match equation.obstacle(start.t, start.angle, start.speed) {
        Some(Obstacle::Blocked) | None => {
            let reach: Vec<String> = limits
                .reach
                .iter()
                .map(|[from, to]| format!("{:.6} to {:.6} deg", from.to_degrees(), to.to_degrees()))
                .collect();
            Error::refused(
                format!(
                    "motion.angle: the mechanism has no position at crank angle {theta} rad: the rod does not reach the guide or stands normal to it"
                ),
                format!("give an angle inside {}", reach.join(" or ")),
            )
        }
        Some(Obstacle::Load) => Error::refused(
            format!(
                "a load has no finite value at the start (t = 0, theta = {theta} rad, omega = {} rad/s)",
                start.speed
            ),
            "check the range of its table or the domain of its formula",
        ),
        _ => Error::refused(
            format!("the effective inertia vanishes at the start, theta = {theta} rad"),
            "give the crank an inertia, or start away from the dead centre",
        ),
    }
}
