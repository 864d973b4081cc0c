//! Motion by integration in time.

use std::time::Instant;

use super::crank_watch::{CrankWatch, EndsBy};
use super::outcome::{Balance, Estimate, Outcome};
use super::row::RowSink;
use super::run::Simulation;
use super::run_setup::RunSetup;
use super::{configuration_curve, error_estimate, stop_reason};
use crate::engine::Counted;
use crate::engine::runge_kutta;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::plan::Stepper;
use crate::scene::Extent;

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
    let mut watch = CrankWatch::new(task, &looked_at, rows);
    let (mut finish, mut last, steps) =
        time::run(&motion, start, &settings, &mut |step| watch.step(step));
    if finish == Finish::NoStart {
        return Err(stop_reason::no_start(start.angle, start.speed));
    }
    if watch.ends_at.is_some() {
        last = shortened(&motion, &last, &settings, &mut watch);
        finish = Finish::AtEnd;
    }
    let end = Start {
        t: last.end.t,
        angle: last.angle(last.end.theta),
        speed: last.end.omega,
    };
    let CrankWatch {
        ends_at,
        swing,
        mut recorder,
        ..
    } = watch;
    recorder.end_piece(end.t);
    let record = recorder.finish(|| task.maker.row(end.t, end.angle, end.speed, None))?;
    let wall_s = record.wall_s(begun);
    let evaluations = motion.evaluations();
    let stopped = if let Some((_, EndsBy::Limit)) = ends_at {
        Some(stop_reason::at_limit(&last))
    } else {
        let caught = swing.and_then(|swing| swing.why(end.t, |theta| theta));
        caught.or_else(|| {
            stop_reason::reason(finish, equation, motion.impossible(), &last, &task.extent)
        })
    };
    let mut warnings = Vec::new();
    let estimate = task.estimate(stopped.as_ref(), &mut warnings, || {
        let run = error_estimate::Ended {
            last: &last,
            evaluations,
            checkpoints: &record.checkpoints,
        };
        error_estimate::estimate(equation, start, &settings, run)
    });
    let outcome = Outcome {
        at: end,
        turned: end.angle.minus(start.angle),
        estimate: estimate.map(Estimate::from),
        balance: energy_balance(equation, start, &last, record.fastest()),
        evaluations,
        steps,
        wall_s,
        warnings,
        stopped,
        record,
    };
    Ok(outcome.conclude(task))
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

/// The step ended where the run ends inside it, integrated anew; at a turn limit once more, to meet the limit exactly.
pub(super) fn shortened(
    motion: &Counted<'_>,
    step: &Step,
    settings: &Settings,
    watch: &mut CrankWatch<'_>,
) -> Step {
    let until = |t_end: f64, sink: &mut dyn FnMut(&Step) -> bool| {
        time::shortened(motion, step, t_end, settings, sink)
    };
    let Some((mut t, by)) = watch.ends_at else {
        return *step;
    };
    if let Some(limit) = watch.turn_limit.filter(|_| by == EndsBy::Turns) {
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

/// Energy at the end against that at the start and the work.
fn energy_balance(equation: &Equation, start: Start, last: &Step, speed: f64) -> Balance {
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
    let rise = potential[1] - potential[0];
    let energies = [kinetic[0], kinetic[1], rise, last.end.work, peak];
    Balance::new(gained - last.end.work, &energies)
}
