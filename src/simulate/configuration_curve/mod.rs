//! Motion in time on the configuration curve: past the limits of a rocker, and with Coulomb friction.

mod arrived;
mod end_reason;
mod estimate;
mod follow;
mod recorder;
mod release;
mod rest;
mod roundoff;
mod row;
mod senses;
mod stick_slip;

use std::sync::Arc;
use std::time::Instant;

use arrived::crank_state;
pub(super) use arrived::{Arrived, End, Follow, Observer};
use end_reason::warnings;
pub(super) use end_reason::why;
use estimate::estimate;
pub(super) use recorder::CurveWatch;
pub(super) use roundoff::Noise;
pub(super) use row::{last_row, row_on_curve};
pub(super) use stick_slip::Phase;

use super::bounded_motion::Swing;
use super::outcome::{Balance, Estimate, Outcome};
use super::recorder::Recorder;
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::simulation::Simulation;
use super::stop_reason;
use crate::engine::time::{Finish, Start};
use crate::error::Error;
use crate::mechanism::{Class, Curve, CurveEquation, Equation};
use crate::numeric::angle::Angle;

/// Whether a free motion in time is computed here.
pub(super) fn serves(task: &RunSetup<'_>) -> bool {
    let may_stick = task.scene.reduced().friction.is_some() || task.equation().loads().are_dry();
    task.limits.class != Class::RotatingCrank || may_stick
}

/// Runs a task.
pub(super) fn run(task: &RunSetup<'_>, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let (constrained, start) = on_curve(task)?;
    let constrained = Arc::new(constrained);
    let curve = constrained.curve();
    let follow = Follow {
        equation: &constrained,
        settings: task.settings(),
        start,
        turn_limit: task.extent.angle(),
        turned_from: task.start(),
    };
    let mut recorder = Recorder::new(task, rows);
    let mut watch = CurveWatch {
        equation: &constrained,
        recorder: &mut recorder,
        swing: Swing::new(task, start.angle),
        phase: Phase::Sticking,
    };
    let arrived = follow.run(&mut watch);
    let CurveWatch { swing, phase, .. } = watch;
    let last = &arrived.last;
    let t_end = last.end.t;
    recorder.end_piece(t_end);
    let record = recorder.finish(|| last_row(task, &constrained, phase, last))?;
    if arrived.end == End::Integrator(Finish::NoStart) {
        return Err(stop_reason::no_start(task.start(), task.scene.motion.speed));
    }
    let wall_s = record.wall_s(begun);
    let crank = |q| curve.crank_angle(q);
    let caught = swing.and_then(|swing| swing.why(t_end, crank));
    let stopped = caught.or_else(|| why(task, &arrived, &constrained));
    let mut warnings = warnings(task);
    let second = || estimate(&follow, &arrived, &record.checkpoints);
    let estimate = task.estimate(stopped.as_ref(), &mut warnings, second);
    let (angle, speed) = crank_state(curve, last);
    let outcome = Outcome {
        at: Start {
            t: t_end,
            angle,
            speed,
        },
        turned: angle.minus(task.start()),
        estimate: estimate.map(Estimate::from),
        balance: energy_balance(&constrained, equation, start, &arrived, record.fastest()),
        evaluations: arrived.evaluations,
        steps: arrived.steps,
        wall_s,
        warnings,
        stopped,
        record,
    };
    let seen = constrained.clone();
    let view = move |angle: Angle, speed: f64| {
        let curve = seen.curve();
        (
            curve.crank_angle(angle),
            curve.place(angle.rest).dtheta * speed,
        )
    };
    let mut run = outcome.conclude(task);
    run.trajectory = run.trajectory.map(|motion| motion.seen_as(Arc::new(view)));
    run.dense.curve = Some(constrained);
    Ok(run)
}

/// The equation on the curve of the start, and the start on it.
fn on_curve(task: &RunSetup<'_>) -> Result<(CurveEquation, Start), Error> {
    let theta = task.start();
    let speed = task.scene.motion.speed;
    let linkage = task.equation().linkage();
    let Some((curve, q)) = Curve::through(linkage, theta) else {
        return Err(stop_reason::no_start(theta, speed));
    };
    let pace = match speed {
        0.0 => 0.0,
        speed => speed / curve.place(q.rest).dtheta,
    };
    let start = Start {
        t: 0.0,
        angle: q,
        speed: pace,
    };
    Ok((CurveEquation::new(task.scene, curve), start))
}

/// Energy at the end against that at the start and the work.
fn energy_balance(
    constrained: &CurveEquation,
    equation: &Equation,
    start: Start,
    arrived: &Arrived,
    speed: f64,
) -> Balance {
    let last = &arrived.last;
    let angle = last.angle(last.end.theta);
    let turns = constrained.curve().crank_angle(start.angle).turns;
    let potential = |q: Angle| constrained.potential_energy(equation, q, turns);
    let kinetic = [
        constrained.kinetic_energy(start.angle, start.speed),
        constrained.kinetic_energy(angle, last.end.omega),
    ];
    let rise = potential(angle) - potential(start.angle);
    let gained = (kinetic[1] - kinetic[0]) + rise;
    let peak = equation.kinetic_energy(constrained.curve().crank_angle(angle).rest, speed);
    let peak = if peak.is_finite() { peak } else { 0.0 };
    Balance::new(
        gained - arrived.work,
        &[kinetic[0], kinetic[1], rise, arrived.work, peak],
    )
}
