//! Motion by integration in time.

use std::f64::consts::TAU;
use std::time::Instant;

use super::bounded_motion::Swing;
use super::dense_rows::DenseRows;
use super::event_log::Log;
use super::recorder::{Recorder, Seen};
use super::result::{Final, Solved, Summary};
use super::row::RowSink;
use super::run::Simulation;
use super::run_setup::RunSetup;
use super::{configuration_curve, error_estimate, stop_reason};
use crate::engine::Counted;
use crate::engine::runge_kutta;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::mechanism::{Equation, Limits};
use crate::numeric::angle::Angle;
use crate::plan::Stepper;
use crate::scene::Extent;
use crate::trajectory::Trajectory;

/// Runs a task.
pub(super) fn run(task: &RunSetup<'_>, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
    if configuration_curve::serves(task) {
        return configuration_curve::run(task, rows);
    }
    let begun = Instant::now();
    let equation = task.equation();
    let forward = error_estimate::Forward(equation);
    let motion = Counted::new(&forward);
    let start = task.first_state();
    let settings = settings(task, equation);
    // What rows and events cost is counted apart: it does not change how far a run goes.
    let looked_at = Counted::new(&forward);
    let mut watch = watch(task, &looked_at, rows);
    let (mut finish, mut last, steps) =
        time::run(&motion, start, &settings, &mut |step| watch.step(step));
    if let Some(error) = watch.seen.error.take() {
        return Err(error);
    }
    if finish == Finish::NoStart {
        return Err(stop_reason::no_start(start.angle, start.speed));
    }
    if let Some(t) = watch.seen.ends_at {
        last = shortened(&motion, &last, t, &settings, &mut watch);
        finish = Finish::AtEnd;
    }
    watch.write_last_row(&last)?;
    let Recorder {
        seen,
        swing,
        log,
        recorded,
        ..
    } = watch;
    let wall_s = log.wall_s(begun);
    let evaluations = motion.evaluations();
    let stopped = if seen.at_limit {
        Some(stop_reason::at_limit(&last))
    } else {
        let caught = swing.and_then(|swing| swing.why(last.end.t, |theta| theta));
        caught.or_else(|| {
            stop_reason::reason(finish, equation, motion.impossible(), &last, &task.extent)
        })
    };
    let mut warnings = Vec::new();
    let estimate = task.estimate(stopped.as_ref(), &mut warnings, || {
        let run = error_estimate::Ended {
            last: &last,
            evaluations,
            checkpoints: &log.checkpoints,
        };
        error_estimate::estimate(equation, start, &settings, run)
    });
    let angle = last.angle(last.end.theta);
    let t_end = last.end.t;
    let solved = Solved {
        last: Final {
            t_s: t_end,
            theta_rad: angle.radians(),
            omega_rad_per_s: last.end.omega,
        },
        turned: angle.minus(start.angle),
        error_estimate: estimate.map(|judged| judged.end),
        rows_error: estimate.map(|judged| judged.rows),
        energy: energy_residual(equation, start, &last, log.fastest()),
        evaluations,
        steps,
        wall_s,
        estimate_cost: estimate.map(|judged| judged.cost),
        speed: log.speed,
        events: log.events,
        events_total: log.events_total,
        warnings,
        stopped,
        ..Solved::default()
    };
    Ok(Simulation {
        summary: Summary::new(task, solved),
        trajectory: recorded.map(|steps| Trajectory::from_steps(steps, t_end)),
        dense: DenseRows::default(),
    })
}

/// What follows the steps of a task.
pub(super) fn watch<'a>(
    task: &'a RunSetup<'_>,
    motion: &'a Counted<'a>,
    rows: &'a mut dyn RowSink,
) -> Recorder<'a> {
    let reach = Limits::clear_reach(task.equation().linkage());
    let dead_centres = task.limits.dead_centres.iter().map(|dc| dc.theta);
    let guards = reach.iter().flatten().map(|angle| angle.rem_euclid(TAU));
    Recorder {
        motion,
        maker: &task.maker,
        rows,
        schedule: task.schedule(),
        start: task.first_state(),
        dead_centres: task.limits.dead_centres.len(),
        watched: dead_centres.chain(guards).collect(),
        turn_limit: task.extent.angle(),
        swing: Swing::new(task, task.start()),
        log: Log::new(task),
        seen: Seen::default(),
        recorded: (task.kept > 0).then(Vec::new),
    }
}

/// A run that ends after a number of turns has no last time of its own.
pub(super) const FAR: f64 = time::FAR;

pub(super) fn settings(task: &RunSetup<'_>, equation: &Equation) -> Settings {
    let motion = &task.scene.motion;
    let inertia = equation.terms(motion.angle).inertia.m;
    let unit = 0.5 * inertia * motion.speed.powi(2).max(1.0);
    Settings {
        method: match task.plan.stepper {
            Some(Stepper::Dop853) => time::Method::Library(runge_kutta::Method::Dop853),
            Some(Stepper::Dopri5) => time::Method::Library(runge_kutta::Method::Dopri5),
            _ => time::Method::Picard,
        },
        tolerance: task.scene.run.tolerance,
        t_end: match task.extent {
            Extent::Duration(duration) => duration,
            Extent::Revolutions(_) => FAR,
        },
        way: task.extent.angle().unwrap_or(f64::INFINITY),
        max_evaluations: task.options.max_evaluations,
        work_unit: if unit > 0.0 { unit } else { 1.0 },
    }
}

/// The step ended at time `t` inside it, integrated anew; at a turn limit once more, to meet the limit exactly.
pub(super) fn shortened(
    motion: &Counted<'_>,
    step: &Step,
    t: f64,
    settings: &Settings,
    watch: &mut Recorder<'_>,
) -> Step {
    let until = |t_end: f64, sink: &mut dyn FnMut(&Step) -> bool| {
        time::shortened(motion, step, t_end, settings, sink)
    };
    let mut t = t;
    let at_turns = !watch.seen.at_limit && !watch.is_caught();
    if let Some(limit) = watch.turn_limit.filter(|_| at_turns) {
        for _ in 0..3 {
            let end = until(t, &mut |_| false);
            let turned = watch.turned(&end, end.end.theta);
            let missing = limit.copysign(turned) - turned;
            if missing == 0.0 || end.end.omega == 0.0 {
                break;
            }
            t = (t + missing / end.end.omega).clamp(step.start.t, step.end.t);
        }
    }
    until(t, &mut |step| {
        watch.follow_speed(&mut step.clone());
        false
    })
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
