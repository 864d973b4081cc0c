//! Motion in time on the configuration curve: past the limits of a rocker, and with Coulomb friction.

mod follow;
mod phase;
mod release;
mod watch;

use std::sync::Arc;
use std::time::{Duration, Instant};

use follow::{Arrived, End, Follow, Observer};
use phase::Phase;
use watch::CurveWatch;

use super::in_time::{FAR, settings};
use super::row::RowSink;
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::stopped;
use super::summary::{Cost, ErrorEstimate, Final, Solved, Summary};
use super::task::Task;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Settings, Start};
use crate::error::Error;
use crate::mechanism::{Class, Constrained, Curve, Equation};
use crate::numeric::angle::Angle;
use crate::scene::Extent;
use crate::trajectory::Trajectory;

/// Whether a free motion in time is computed here.
pub(super) fn serves(task: &Task<'_>) -> bool {
    task.limits.class != Class::RotatingCrank || task.scene.reduced().friction.is_some()
}

/// Runs a task.
pub(super) fn run(
    task: &Task<'_>,
    rows: &mut dyn RowSink,
    record: bool,
) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let (constrained, start) = on_curve(task)?;
    let constrained = Arc::new(constrained);
    let curve = constrained.curve();
    let speed = task.scene.motion.speed;
    let follow = Follow {
        equation: &constrained,
        settings: settings(task, equation),
        start,
        turn_limit: match task.extent {
            Extent::Revolutions(turns) => Some(super::watch::radians(turns)),
            Extent::Duration(_) => None,
        },
    };
    let mut watch = CurveWatch {
        equation: &constrained,
        reactor: task.maker.reactor.as_ref(),
        rows,
        schedule: Schedule::new(task.scene.run.output_every, task.extent),
        start: task.start(),
        events_kept: task.options.events_kept,
        events: Vec::new(),
        events_total: 0,
        speed: (speed, speed),
        recorded: record.then(Vec::new),
        row_time: Duration::ZERO,
        error: None,
        next_row: 0,
        phase: Phase::Sticking,
    };
    let arrived = follow.run(&mut watch);
    if let Some(error) = watch.error.take() {
        return Err(error);
    }
    if arrived.end == End::Integrator(Finish::NoStart) {
        let crank = Start {
            angle: task.start(),
            speed,
            ..start
        };
        return Err(stopped::no_start(equation, crank, &task.limits));
    }
    watch.write_last_row(&arrived.last)?;
    let wall_s = (begun.elapsed() - watch.row_time).as_secs_f64();
    let stopped = why(task, &arrived, curve);
    let estimate = if task.options.estimate && stopped.is_none() {
        estimate(&follow, &arrived)
    } else {
        None
    };
    let mut warnings = warnings(task);
    if task.options.estimate && stopped.is_none() && estimate.is_none() {
        let why = "the error could not be estimated: the second, tighter run did not finish";
        warnings.push(why.to_owned());
    }
    let end = &arrived.last.end;
    let last = crank_state(curve, &arrived.last);
    let peak = watch.speed.0.abs().max(watch.speed.1.abs());
    let solved = Solved {
        last: Final {
            t_s: end.t,
            theta_rad: last.0.radians(),
            omega_rad_per_s: last.1,
        },
        turned: last.0.minus(task.start()),
        error_estimate: estimate.map(|(error, _)| error),
        energy: energy_residual(&constrained, equation, start, &arrived, peak),
        evaluations: arrived.evaluations,
        steps: arrived.steps,
        wall_s,
        estimate_cost: estimate.map(|(_, cost)| cost),
        speed: watch.speed,
        driving_torque: None,
        events: watch.events,
        events_total: watch.events_total,
        warnings,
        stopped,
    };
    let t_end = end.t;
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
    })
}

/// The equation on the curve of the start, and the start on it.
fn on_curve(task: &Task<'_>) -> Result<(Constrained, Start), Error> {
    let theta = task.start();
    let speed = task.scene.motion.speed;
    let linkage = task.equation().linkage();
    let start = |angle: Angle, speed: f64| Start {
        t: 0.0,
        angle,
        speed,
    };
    let Some((curve, q)) = Curve::through(linkage, theta) else {
        if task.limits.class == Class::ChangePoint && linkage.reaches(theta.rest) {
            return Err(Error::refused(
                "motion.angle is the change point itself, where the mechanism may go on in two ways",
                "start away from it, or change a length a little to say which mechanism is meant",
            ));
        }
        return Err(stopped::no_start(
            task.equation(),
            start(theta, speed),
            &task.limits,
        ));
    };
    let pace = speed / curve.place(q.rest).dtheta;
    if speed != 0.0 && pace.abs() > 1e12 * speed.abs() {
        return Err(Error::refused(
            "motion.speed: at motion.angle the rod stands normal to the guide, and the crank has no speed there",
            "start at rest, or away from the limit",
        ));
    }
    let pace = if speed == 0.0 { 0.0 } else { pace };
    Ok((Constrained::new(task.scene, curve), start(q, pace)))
}

fn crank_state(curve: &Curve, last: &Step) -> (Angle, f64) {
    let angle = last.angle(last.end.theta);
    let dtheta = curve.place(angle.rest).dtheta;
    (curve.crank_angle(angle), dtheta * last.end.omega)
}

/// Why a run ended before its time.
fn why(task: &Task<'_>, arrived: &Arrived, curve: &Curve) -> Option<String> {
    let (angle, speed) = crank_state(curve, &arrived.last);
    let t = arrived.last.end.t;
    let place = format!(
        "at t = {t} s, theta = {} rad, omega = {speed} rad/s",
        angle.radians()
    );
    match (&arrived.end, task.extent) {
        (End::Done, Extent::Revolutions(turns)) if t >= FAR => Some(format!(
            "the crank does not complete {turns} turns: stopped {place}; give a duration instead"
        )),
        (End::AtRest, Extent::Revolutions(turns)) => Some(format!(
            "the crank comes to rest and does not complete {turns} turns: stopped {place}; give a duration instead"
        )),
        (End::Done | End::AtRest | End::Stopped, _) => None,
        (End::Jam(why), _) => Some(format!("{why}: stopped {place}")),
        (End::Integrator(Finish::WorkLimit), _) => Some(stopped::work_limit(&place)),
        (End::Integrator(_), _) => Some(singular(task, arrived, &place)),
    }
}

/// Why the steps became too small.
fn singular(task: &Task<'_>, arrived: &Arrived, place: &str) -> String {
    if let Some((t, theta, omega)) = arrived.impossible
        && !task.equation().load(t, theta, omega).is_finite()
    {
        return format!(
            "a load has no finite value at t = {t} s, theta = {theta} rad, omega = {omega} rad/s (outside its table, or outside the domain of its formula): stopped {place}"
        );
    }
    format!("the equation is singular here or too stiff for this method: stopped {place}")
}

fn warnings(task: &Task<'_>) -> Vec<String> {
    let linkage = task.equation().linkage();
    let near = linkage.nearness_to_change_point();
    match task.limits.class {
        Class::ChangePoint => vec![
            "the lengths make a change point: it is passed so that all velocities stay continuous, and the branch changes there; a slightly longer or shorter rod moves differently".to_owned(),
        ],
        _ if near < 1e-6 => vec![format!(
            "the lengths are {near:e} crank lengths from a change point: which way the mechanism goes there depends on their last digits"
        )],
        _ => Vec::new(),
    }
}

/// The second run of the estimate is this much tighter.
const TIGHTER: f64 = 50.0;
/// What is stated is larger than the distance of the two runs by this.
const MARGIN: f64 = 1.5;
/// Where rounding inside a step takes over.
const TIGHTEST: f64 = 1e-15;

/// Adds up what rounding does to a run.
struct Shaken {
    unevenness: f64,
    largest_speed: f64,
}

impl Observer for Shaken {
    fn step(&mut self, step: &Step, _: Phase) -> bool {
        let travel = step.end.theta - step.start.theta;
        self.largest_speed = self.largest_speed.max(step.end.omega.abs());
        if travel != 0.0 && step.end.alpha.is_finite() {
            let slope = (step.end.alpha - step.start.alpha) / travel;
            let angle = 4.0 * step.end.theta.abs() * slope;
            let evaluation = 64.0 * step.end.alpha;
            self.unevenness += (angle * angle + evaluation * evaluation) * step.length().powi(2);
        }
        false
    }

    fn event(&mut self, _: &'static str, _: f64, _: Angle, _: f64) {}
}

/// Global error of the last state: its distance from a much tighter run, and what rounding may have added.
fn estimate(follow: &Follow<'_>, arrived: &Arrived) -> Option<(ErrorEstimate, Cost)> {
    let begun = Instant::now();
    let end = arrived.last.end;
    let tighter = Follow {
        equation: follow.equation,
        settings: Settings {
            tolerance: (follow.settings.tolerance / TIGHTER).max(TIGHTEST),
            t_end: end.t,
            max_evaluations: follow.settings.max_evaluations.saturating_mul(4),
            ..follow.settings
        },
        start: follow.start,
        turn_limit: None,
    };
    let mut shaken = Shaken {
        unevenness: 0.0,
        largest_speed: 0.0,
    };
    let best = tighter.run(&mut shaken);
    if best.end != End::Done {
        return None;
    }
    let curve = follow.equation.curve();
    let (a, b) = (
        crank_state(curve, &arrived.last),
        crank_state(curve, &best.last),
    );
    let roundings = ((arrived.steps + best.steps) as f64).sqrt();
    let noise = f64::EPSILON
        * (0.5 * shaken.largest_speed * roundings + shaken.unevenness.sqrt());
    let duration = end.t - follow.start.t;
    let angle_noise = 0.5 * f64::EPSILON * (1.0 + end.theta.abs()) * roundings
        + noise * duration
        + f64::EPSILON * a.0.radians().abs();
    // The same time in the motion, at another angle.
    let bend = if end.omega == 0.0 {
        0.0
    } else {
        (end.alpha / end.omega * angle_noise).abs()
    };
    let place = curve.place(end.theta);
    let dtheta = place.dtheta.abs().max(f64::EPSILON);
    let still = arrived.last.end.omega == 0.0 && best.last.end.omega == 0.0;
    let rounded = if still { f64::EPSILON } else { 1.0 };
    let estimate = ErrorEstimate {
        theta_rad: MARGIN * a.0.minus(b.0).abs() + dtheta * angle_noise,
        omega_rad_per_s: MARGIN * (a.1 - b.1).abs()
            + rounded * (dtheta * (noise + bend) + place.d2theta.abs() * end.omega.abs() * angle_noise),
    };
    let cost = Cost {
        evaluations: best.evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    Some((estimate, cost))
}

/// Energy at the end minus energy at the start minus work, J, and the largest energy that occurs.
fn energy_residual(
    constrained: &Constrained,
    equation: &Equation,
    start: Start,
    arrived: &Arrived,
    speed: f64,
) -> (f64, f64) {
    let last = &arrived.last;
    let angle = last.angle(last.end.theta);
    let turns = constrained.curve().crank_angle(start.angle).turns;
    let potential = |q: Angle| {
        constrained.potential_energy(equation, q, turns)
    };
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
