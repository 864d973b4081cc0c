//! Forward motion: scene -> mechanism -> plan -> engine -> trajectory.

use std::time::Instant;

use super::row::{NoRows, RowMaker, RowSink};
use super::schedule::Schedule;
use super::summary::{Final, Summary};
use super::watch::{Seen, Watch, radians};
use super::{closed_form, forward};
use crate::engine::Counted;
use crate::engine::library;
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::mechanism::{Equation, Limits, Obstacle, Reactor};
use crate::numeric::angle::Angle;
use crate::plan::{Engine, Method, Plan, Stepper};
use crate::scene::{Extent, Scene};
use crate::trajectory::Trajectory;

/// What is asked of a run beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The method; [`Method::Auto`] leaves it to the plan.
    pub method: Method,
    /// Joint forces in the rows.
    pub reactions: bool,
    /// Driving torque in the rows, for prescribed motions.
    pub driving_torque: bool,
    /// Whether the global error is estimated, by a second run.
    pub estimate: bool,
    /// Most evaluations of the equation; the run ends there with what it has.
    pub max_evaluations: u64,
    /// Most events that are listed; all are counted.
    pub events_kept: usize,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            method: Method::Auto,
            reactions: false,
            driving_torque: false,
            estimate: true,
            max_evaluations: 2_000_000_000,
            events_kept: 1000,
        }
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Its numbers.
    pub summary: Summary,
    /// Its motion, if it was recorded.
    pub trajectory: Option<Trajectory>,
}

impl Simulation {
    /// Unwrapped crank angle (rad) and speed (rad/s) at time `t` (s); none outside the run.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
        self.trajectory.as_ref()?.at(t)
    }
}

/// Simulates a scene and keeps its dense trajectory.
///
/// # Errors
/// [`Error::Scene`] for impossible values, [`Error::Refused`] for what cannot be computed. A run that ends
/// before its time is no error: see [`Summary::stopped`].
///
/// ```
/// use slider_crank::scene::Scene;
/// use slider_crank::study::{Options, simulate};
/// let run = simulate(&Scene::duarte(), &Options::default()).unwrap();
/// let (theta, omega) = run.at(0.5).unwrap();
/// assert!((theta - 50.0).abs() < 1.0 && (omega - 100.0).abs() < 5.0);
/// ```
pub fn simulate(scene: &Scene, options: &Options) -> Result<Simulation, Error> {
    run(scene, options, &mut NoRows, true)
}

/// Simulates a scene and hands its rows to `rows` as they are computed; memory does not grow with the run.
///
/// # Errors
/// As [`simulate`], and the errors of `rows`.
pub fn simulate_rows(
    scene: &Scene,
    options: &Options,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    run(scene, options, rows, false)
}

fn run(
    scene: &Scene,
    options: &Options,
    rows: &mut dyn RowSink,
    record: bool,
) -> Result<Simulation, Error> {
    let plan = Plan::new(scene, options.method)?;
    let extent = scene.run.extent.ok_or_else(|| {
        Error::refused(
            "the scene does not say how long the run is",
            "add [run] with duration = \"1 s\" or revolutions = 10",
        )
    })?;
    let reactor = options.reactions.then(|| Reactor::new(scene)).transpose()?;
    let equation = Equation::new(scene);
    let task = Task {
        scene,
        options,
        plan,
        extent,
        limits: Limits::new(equation.linkage(), scene.motion.speed),
        maker: RowMaker {
            equation: &equation,
            reactor,
            driving_torque: options.driving_torque,
        },
    };
    match task.plan.engine {
        Engine::ClosedForm => closed_form::run(task, rows),
        Engine::Time => in_time(task, rows, record),
    }
}

/// A run that is ready to be computed.
pub(super) struct Task<'a> {
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub plan: Plan,
    pub extent: Extent,
    pub limits: Limits,
    pub maker: RowMaker<'a>,
}

impl Task<'_> {
    pub fn title(&self) -> String {
        self.scene.title.clone().unwrap_or_default()
    }
}

fn in_time(task: Task<'_>, rows: &mut dyn RowSink, record: bool) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.maker.equation;
    let forward = forward::Forward(equation);
    let motion = Counted::new(&forward);
    let start = Start {
        t: 0.0,
        angle: Angle::from(task.scene.motion.angle).reduced(),
        speed: task.scene.motion.speed,
    };
    let settings = settings(&task, equation);
    let mut watch = Watch {
        motion: &motion,
        maker: task.maker,
        rows,
        schedule: Schedule::new(task.scene.run.output_every, task.extent),
        start,
        dead_centres: task.limits.dead_centres.iter().map(|dc| dc.theta).collect(),
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
    if let Some(t) = watch.seen.turned_at {
        last = shortened(&motion, &last, t, &settings);
        finish = Finish::AtEnd;
    }
    watch.write_last_row(&last)?;
    let (seen, recorded) = (watch.seen, watch.recorded);
    let wall_s = (begun.elapsed() - seen.row_time).as_secs_f64();
    let evaluations = motion.evaluations();
    let stopped = stopped(finish, equation, &motion, &last, &task.extent);
    let largest_speed = seen.speed.0.abs().max(seen.speed.1.abs());
    let estimate = if task.options.estimate && stopped.is_none() {
        forward::estimate(equation, start, &settings, &last, steps, largest_speed)
    } else {
        None
    };
    let (residual, scale) = energy_residual(equation, start, &last, largest_speed);
    let angle = last.angle(last.end.theta);
    let mut warnings = Vec::new();
    if seen.events_total > seen.events.len() as u64 {
        let (total, kept) = (seen.events_total, seen.events.len());
        warnings.push(format!(
            "{total} events occurred; the first {kept} are listed"
        ));
    }
    if task.options.estimate && stopped.is_none() && estimate.is_none() {
        warnings.push(
            "the error could not be estimated: the second, tighter run did not finish".to_owned(),
        );
    }
    let summary = Summary {
        scene: task.scene.title.clone().unwrap_or_default(),
        engine: task.plan.engine.name().to_owned(),
        plan: task.plan,
        last: Final {
            t_s: last.end.t,
            theta_rad: angle.radians(),
            omega_rad_per_s: last.end.omega,
        },
        revolutions: angle.minus(start.angle) / radians(1.0),
        error_estimate: estimate.map(|(error, _)| error),
        energy_residual: if scale > 0.0 { residual / scale } else { 0.0 },
        energy_residual_j: residual,
        evaluations,
        steps,
        wall_s,
        estimate_cost: estimate.map(|(_, cost)| cost),
        omega_min: seen.speed.0,
        omega_max: seen.speed.1,
        driving_torque: None,
        events: seen.events,
        events_total: seen.events_total,
        warnings,
        stopped,
    };
    Ok(Simulation {
        trajectory: recorded.map(|steps| Trajectory::from_steps(steps, summary.last.t_s)),
        summary,
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
                Some(Obstacle::Blocked) => format!(
                    "the crank reaches the limit of its motion, where the rod stands normal to the guide: stopped {place}; this version does not pass it"
                ),
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
        Some(Obstacle::Blocked) => {
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
