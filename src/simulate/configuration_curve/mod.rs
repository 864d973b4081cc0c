//! Motion in time on the configuration curve: past the limits of a rocker, and with Coulomb friction.

mod arrived;
mod end_reason;
mod estimate;
mod follow;
mod recorder;
mod release;
mod rest;
mod roundoff;
mod senses;
mod stick_slip;

use std::sync::Arc;
use std::time::Instant;

pub(super) use arrived::{Arrived, End, Follow, Observer};
use end_reason::warnings;
pub(super) use end_reason::why;
use estimate::estimate;
pub(super) use recorder::{CurveWatch, row_on_curve};
pub(super) use roundoff::Noise;
pub(super) use stick_slip::Phase;

use super::bounded_motion::Swing;
use super::dense_rows::DenseRows;
use super::event_log::Log;
use super::in_time::settings;
use super::result::{Final, Solved, Summary};
use super::row::RowSink;
use super::run::Simulation;
use super::run_setup::RunSetup;
use super::stop_reason;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Start};
use crate::error::Error;
use crate::mechanism::{Class, Curve, CurveEquation, Equation};
use crate::numeric::angle::Angle;
use crate::trajectory::Trajectory;

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
        settings: settings(task, equation),
        start,
        turn_limit: task.extent.angle(),
        turned_from: task.start(),
    };
    let mut watch = CurveWatch {
        equation: &constrained,
        reactor: task.maker.reactor,
        rows,
        schedule: task.schedule(),
        start: task.start(),
        swing: Swing::new(task, start.angle),
        log: Log::new(task),
        recorded: (task.kept > 0).then(Vec::new),
        spells: Vec::new(),
        error: None,
        phase: Phase::Sticking,
    };
    let arrived = follow.run(&mut watch);
    if let Some(error) = watch.error.take() {
        return Err(error);
    }
    if arrived.end == End::Integrator(Finish::NoStart) {
        return Err(stop_reason::no_start(task.start(), task.scene.motion.speed));
    }
    watch.write_last_row(&arrived.last)?;
    let log = watch.log;
    let wall_s = log.wall_s(begun);
    let crank = |q| curve.crank_angle(q);
    let caught = watch
        .swing
        .and_then(|swing| swing.why(arrived.last.end.t, crank));
    let stopped = caught.or_else(|| why(task, &arrived, &constrained));
    let mut warnings = warnings(task);
    let second = || estimate(&follow, &arrived, &log.checkpoints);
    let estimate = task.estimate(stopped.as_ref(), &mut warnings, second);
    let t_end = arrived.last.end.t;
    let (angle, omega) = crank_state(curve, &arrived.last);
    let solved = Solved {
        last: Final {
            t_s: t_end,
            theta_rad: angle.radians(),
            omega_rad_per_s: omega,
        },
        turned: angle.minus(task.start()),
        error_estimate: estimate.map(|judged| judged.end),
        rows_error: estimate.map(|judged| judged.rows),
        energy: energy_residual(&constrained, equation, start, &arrived, log.fastest()),
        evaluations: arrived.evaluations,
        steps: arrived.steps,
        wall_s,
        estimate_cost: estimate.map(|judged| judged.cost),
        speed: log.speed,
        events: log.events,
        events_total: log.events_total,
        warnings,
        stopped,
        ..Solved::default()
    };
    let seen = constrained.clone();
    let view = move |angle: Angle, speed: f64| {
        let curve = seen.curve();
        (
            curve.crank_angle(angle),
            curve.place(angle.rest).dtheta * speed,
        )
    };
    Ok(Simulation {
        summary: Summary::new(task, solved),
        trajectory: watch
            .recorded
            .map(|steps| Trajectory::from_steps(steps, t_end).seen_as(Arc::new(view))),
        dense: DenseRows {
            frame: None,
            curve: Some(constrained.clone()),
            spells: watch.spells,
        },
    })
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

fn crank_state(curve: &Curve, last: &Step) -> (Angle, f64) {
    let angle = last.angle(last.end.theta);
    let dtheta = curve.place(angle.rest).dtheta;
    (curve.crank_angle(angle), dtheta * last.end.omega)
}

/// Energy at the end minus energy at the start minus work, J, and the largest energy that occurs.
fn energy_residual(
    constrained: &CurveEquation,
    equation: &Equation,
    start: Start,
    arrived: &Arrived,
    speed: f64,
) -> (f64, f64) {
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
    let scale = [kinetic[0], kinetic[1], rise, arrived.work, peak]
        .into_iter()
        .fold(0.0, |largest: f64, energy| largest.max(energy.abs()));
    (gained - arrived.work, scale)
}
