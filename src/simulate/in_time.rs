//! Motion by integration in time.

use std::time::Instant;

use super::crank_watch::{CrankWatch, EndsBy};
use super::outcome::{Balance, Estimate, Outcome};
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::simulation::Simulation;
use super::{configuration_curve, error_estimate, stop_reason};
use crate::engine::Counted;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Start};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;

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
    let settings = task.settings();
    // What rows and events cost is counted apart: it does not change how far a run goes.
    let looked_at = Counted::new(&forward);
    let mut watch = CrankWatch::new(task, &looked_at, rows);
    let (mut finish, mut last, steps) =
        time::run(&motion, start, &settings, &mut |step| watch.step(step));
    if finish == Finish::NoStart {
        return Err(stop_reason::no_start(start.angle, start.speed));
    }
    if watch.ends_at.is_some() {
        last = watch.shortened(&motion, &last, &settings);
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
