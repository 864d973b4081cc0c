//! Motion over the crank angle: what the energy and the angle engine have in common.

use super::angle_model::AngleModel;
use super::by_angle::Unsolved;
use super::outcome::{Balance, Estimate, Outcome};
use super::passages::Stretch;
use super::recorder::Recorder;
use super::result::ErrorEstimate;
use super::row::RowSink;
use super::run::Simulation;
use super::run_setup::{NOT_ESTIMATED, RunSetup};
use super::{by_angle, by_energy, engine_switching, in_time};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::engine::time::Start;
use crate::error::Error;
use crate::mechanism::Class;
use crate::numeric::angle::Angle;
use crate::plan::{Engine, Method, Plan, cycle_over_angle};
use crate::trajectory::Trajectory;

/// A motion over the crank angle.
pub(super) struct Motion {
    pub orbit: Orbit,
    /// Time of the end, s.
    pub end: f64,
    /// Angle and speed there.
    pub last: (Angle, f64),
    /// Work of the loads without potential, J.
    pub work: f64,
    pub evaluations: u64,
    pub wall_s: f64,
    pub stopped: Option<String>,
    /// Error of the end, and what its estimate cost.
    pub estimate: Option<Estimate>,
    /// The motion of the second run, if the estimate is by one.
    pub second: Option<Orbit>,
}

/// Times of a run at which its rows are judged.
const LOOKED_AT: u32 = 64;

impl Motion {
    /// Error of the worst row, by that of rows spread over the run.
    fn rows_error(&self, task: &RunSetup<'_>) -> Option<ErrorEstimate> {
        // Multiples of the golden section fall everywhere in panels, however these divide the run.
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let times = (1..=LOOKED_AT).map(|i| (f64::from(i) * golden).fract() * self.end);
        let last = self.estimate?.error;
        Some(times.fold(last, |worst, t| {
            worst.max(match &self.second {
                Some(second) => by_angle::row_error([&self.orbit, second], t, last),
                None => by_energy::row_error(task, &self.orbit, t),
            })
        }))
    }
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

/// Why these engines cannot serve.
pub(super) fn reason(unserved: NotApplicable) -> &'static str {
    match unserved {
        NotApplicable::Equilibrium => "it starts at rest without a force",
        NotApplicable::NotFinite => "a load has no finite value on the way",
        NotApplicable::NotSmooth => "a load is not smooth",
        NotApplicable::TooSlow => "the crank comes too near to rest",
        NotApplicable::WorkLimit | NotApplicable::TooManyTurns => {
            "it takes more evaluations than the work limit allows"
        }
        NotApplicable::TooLong => {
            "its turns differ from each other, and they are too many to be kept"
        }
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
    let rows_error = wants_rows.then(|| motion.rows_error(task)).flatten();
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

/// How far an angle in its turn is rounded at most, rad.
pub(super) const PLACE: f64 = 2.0 * f64::EPSILON;

/// Error of a state if its time may be off by `late` (s): it moves the state along the motion. The angle in its
/// turn is right to `place` (rad), and rounded once more with its turns. The speed comes from series of 33
/// terms, whose sum is rounded by half of √33 units. These errors are independent.
pub(super) fn late_by(
    task: &RunSetup<'_>,
    (angle, omega): (Angle, f64),
    end: f64,
    late: f64,
    place: f64,
) -> ErrorEstimate {
    let (alpha, _) = task.maker.forward(end, angle, omega);
    let rounding = place + 0.5 * f64::EPSILON * angle.radians().abs();
    ErrorEstimate {
        theta_rad: (omega * late).hypot(rounding),
        omega_rad_per_s: (alpha * late).hypot(3.0 * f64::EPSILON * omega),
    }
}

/// Energy balance of a run whose largest kinetic energy (J) is known; `work` of the loads without potential, J.
pub(super) fn balance(task: &RunSetup<'_>, at: &Start, work: f64, largest_kinetic: f64) -> Balance {
    let equation = task.equation();
    let start = task.start();
    let turned = Angle {
        turns: at.angle.turns - start.turns,
        rest: at.angle.rest,
    };
    let begin = equation.kinetic_energy(start.rest, task.scene.motion.speed)
        + equation.potential_energy(start.rest);
    let last = equation.kinetic_energy(at.angle.rest, at.speed) + equation.potential_energy(turned);
    Balance::new(last - begin - work, &[largest_kinetic, begin, last, work])
}
