//! Motion over the crank angle: what the energy and the angle engine have in common.

use super::angle_model::AngleModel;
use super::angle_motion::{Motion, balance, reason};
use super::by_angle::Unsolved;
use super::outcome::Outcome;
use super::passages::Stretch;
use super::recorder::Recorder;
use super::result::ErrorEstimate;
use super::row::RowSink;
use super::run_setup::{NOT_ESTIMATED, RunSetup};
use super::simulation::Simulation;
use super::{by_angle, by_energy, engine_switching, in_time};
use crate::engine::energy::NotApplicable;
use crate::engine::time::Start;
use crate::error::Error;
use crate::mechanism::Class;
use crate::plan::{Engine, Method, Plan, cycle_over_angle};
use crate::trajectory::Trajectory;

/// Times of a run at which its rows are judged.
const LOOKED_AT: u32 = 64;

/// Error of the worst row, by that of rows spread over the run.
fn rows_error(motion: &Motion, task: &RunSetup<'_>) -> Option<ErrorEstimate> {
    // Multiples of the golden section fall everywhere in panels, however these divide the run.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let times = (1..=LOOKED_AT).map(|i| (f64::from(i) * golden).fract() * motion.end);
    let last = motion.estimate?.error;
    Some(times.fold(last, |worst, t| {
        worst.max(match &motion.second {
            Some(second) => by_angle::row_error([&motion.orbit, second], t, last),
            None => by_energy::row_error(task, &motion.orbit, t),
        })
    }))
}

/// Runs a task; one that these engines cannot serve after all is run in time, and its plan says so.
pub(super) fn run(task: &mut RunSetup<'_>, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
    let speed = task.scene.motion.speed;
    let cycle = cycle_over_angle(task.scene).ok();
    let mut position = AngleModel::new(task.equation(), &task.limits, task.start(), speed)
        .with_friction(task.maker.sliding)
        .with_limit(task.options.max_evaluations);
    if let Some(turns) = cycle {
        position = position.with_cycle(turns);
    }
    if task.plan.engine == Engine::Energy && cycle == Some(1) {
        position = position.with_turns_alike();
    }
    let solved = match task.plan.engine {
        Engine::Angle => match by_angle::solve(task, &position) {
            Ok(motion) => Ok(motion),
            // What does not turn fully is followed past its limits from the start.
            Err(Unsolved { why, first })
                if turns_fully(task) && first.is_some() || hands_over(task, why) =>
            {
                return engine_switching::run(task, &position, first, rows);
            }
            Err(Unsolved { why, .. }) => Err(why),
        },
        // Turns that differ and end at rest are many panels; the map from turn to turn is for them.
        _ => match by_energy::solve(task, &position) {
            Err(NotApplicable::TooLong) if cycle.is_some() => {
                by_angle::solve(task, &position).map_err(|unsolved| unsolved.why)
            }
            Err(why) if hands_over(task, why) => match Plan::new(task.scene, Method::Angle) {
                Ok(plan) => {
                    task.plan = plan;
                    return engine_switching::run(task, &position, None, rows);
                }
                Err(_) => Err(why),
            },
            solved => solved,
        },
    };
    match solved {
        Ok(motion) => finish(task, motion, rows),
        Err(unserved) if task.options.method != Method::Auto => Err(Error::refused(
            format!(
                "method {} cannot serve this scene: {}",
                task.options.method,
                why(task, unserved)
            ),
            "use --method auto or time",
        )),
        Err(unserved) => {
            let why = format!("integration in time, for {}", why(task, unserved));
            task.plan = Plan::new(task.scene, Method::Time)?;
            task.plan.reason = why.into();
            in_time::run(task, rows)
        }
    }
}

/// Whether a run that cannot begin over the angle may be served by it later.
fn hands_over(task: &RunSetup<'_>, why: NotApplicable) -> bool {
    why == NotApplicable::TooSlow && task.options.method == Method::Auto && turns_fully(task)
}

fn turns_fully(task: &RunSetup<'_>) -> bool {
    task.limits.class == Class::RotatingCrank
}

/// Why these engines cannot serve a task.
fn why(task: &RunSetup<'_>, unserved: NotApplicable) -> &'static str {
    match task.maker.sliding {
        Some(sliding) if sliding.jams() => "the slider jams in its guide at an angle of the turn",
        _ if unserved == NotApplicable::NotFinite && task.limits.class != Class::RotatingCrank => {
            "the mechanism reaches the limit of its motion"
        }
        _ => reason(unserved),
    }
}

fn finish(
    task: &RunSetup<'_>,
    motion: Motion,
    rows: &mut dyn RowSink,
) -> Result<Simulation, Error> {
    let Motion { orbit, end, .. } = &motion;
    let wants_rows = rows.wants_rows();
    let mut recorder = Recorder::new(task, rows);
    recorder.stretch(&Stretch {
        orbit,
        begin: 0.0,
        end: *end,
    })?;
    let (angle, speed) = motion.last;
    let at = Start {
        t: *end,
        angle,
        speed,
    };
    let record = recorder.finish(|| {
        let (angle, speed) = orbit.state(*end);
        task.maker.row(*end, angle, speed, None)
    })?;
    let rows_error = wants_rows.then(|| rows_error(&motion, task)).flatten();
    let mut warnings = Vec::new();
    if task.options.estimate && motion.estimate.is_none() {
        warnings.push(NOT_ESTIMATED.to_owned());
    }
    let outcome = Outcome {
        at,
        turned: angle.minus(task.start()),
        estimate: motion.estimate,
        balance: balance(task, &at, motion.work, orbit.largest_kinetic(*end)),
        evaluations: motion.evaluations,
        steps: orbit.panels() as u64,
        wall_s: motion.wall_s,
        warnings,
        stopped: motion.stopped,
        record,
    };
    let mut run = outcome.with_bounded_speeds(task).conclude(task);
    run.summary.rows_error = rows_error;
    run.trajectory = Some(Trajectory::orbit(motion.orbit, 0.0, motion.end));
    Ok(run)
}
