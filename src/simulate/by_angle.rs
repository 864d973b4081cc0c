//! Motion by collocation over the crank angle.

use std::f64::consts::TAU;
use std::time::Instant;

use super::angle_model::AngleModel;
use super::angle_motion::{Motion, PLACE, late_by};
use super::outcome::Estimate;
use super::result::{Cost, ErrorEstimate};
use super::run_setup::RunSetup;
use crate::engine::angle::{self, Driving, Goal, Resolution};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::scene::Extent;

/// Series end where their coefficients have decayed to this part of the tolerance.
const SHARE: f64 = 1e-2;
/// Inside a panel, where friction may cut it, a series is not as good as at the ends.
const CUT: f64 = 0.03;
/// Where rounding takes over.
const LEAST_TAIL: f64 = 4e-15;

/// Relative error of times by rounding.
pub(super) const ROUNDING: f64 = 2.5 * f64::EPSILON;
/// What is stated is larger than the distance of two runs by this.
pub(super) const MARGIN: f64 = 1.5;

/// Evaluations of a second run for one of the first, and beside them.
const MOST_EVALUATIONS: (u64, u64) = (20, 200_000);

/// Most evaluations of the second run after a first one that took so many, under a work limit.
pub(super) fn most_evaluations(first: u64, limit: u64) -> u64 {
    let (factor, beside) = MOST_EVALUATIONS;
    let share = first.saturating_mul(factor).saturating_add(beside);
    share.min(limit)
}

/// A task that is not solved over the angle alone.
pub(super) struct Unsolved {
    pub why: NotApplicable,
    /// How far it came.
    pub first: Option<Box<First>>,
}

/// A first piece.
pub(super) struct First {
    pub driving: Driving,
    /// Positions that were tabulated for it.
    pub places: u64,
    pub wall_s: f64,
}

/// Solves a task.
pub(super) fn solve(task: &RunSetup<'_>, position: &AngleModel<'_>) -> Result<Motion, Unsolved> {
    let begun = Instant::now();
    let run = |goal: Goal, resolution: Resolution| {
        let driving = angle::run(position, task.first_state(), goal, resolution);
        driving.map_err(|why| Unsolved { why, first: None })
    };
    let goal = match task.extent {
        Extent::Duration(duration) => Goal::Time(duration),
        Extent::Revolutions(turns) => Goal::Turned(turns * TAU),
    };
    let driving = run(goal, plain(task))?;
    let wall_s = begun.elapsed().as_secs_f64();
    let places = position.evaluations();
    let handed = |driving: Driving, why: NotApplicable| Unsolved {
        why,
        first: Some(Box::new(First {
            driving,
            places,
            wall_s,
        })),
    };
    if let Some(short) = driving.short {
        return Err(handed(driving, short.why));
    }
    let estimated = if task.options.estimate {
        let begun = Instant::now();
        let limited = Resolution {
            most_evaluations: most_evaluations(
                places + driving.evaluations,
                task.options.max_evaluations,
            ),
            ..finer()
        };
        let unfinished =
            |why| matches!(why, NotApplicable::WorkLimit | NotApplicable::TooManyTurns);
        let second = match run(Goal::Time(driving.end), limited) {
            Err(unsolved) if unfinished(unsolved.why) => None,
            solved => Some(solved?),
        };
        let better = match second.as_ref().and_then(|second| second.short) {
            Some(short) if !unfinished(short.why) => return Err(handed(driving, short.why)),
            Some(_) => None,
            None => second,
        };
        better.map(|better| {
            let cost = Cost {
                evaluations: position.evaluations() - places + better.evaluations,
                wall_s: begun.elapsed().as_secs_f64(),
            };
            let error = distance(task, &driving, &better);
            (Estimate::of_end(error, Some(cost)), better.orbit)
        })
    } else {
        None
    };
    let (estimate, second) = estimated.unzip();
    Ok(Motion {
        last: driving.orbit.state(driving.end),
        orbit: driving.orbit,
        end: driving.end,
        work: driving.work,
        evaluations: places + driving.evaluations,
        wall_s,
        stopped: None,
        estimate,
        second,
    })
}

/// As fine as the tolerance asks for.
pub(super) fn plain(task: &RunSetup<'_>) -> Resolution {
    let share = match task.maker.sliding {
        Some(_) => SHARE * CUT,
        None => SHARE,
    };
    Resolution {
        tail: (share * task.scene.run.tolerance).max(LEAST_TAIL),
        other: false,
        most_evaluations: task.options.max_evaluations,
    }
}

/// Finer, and cut at other angles: two runs on the same panels would have the same error.
pub(super) fn finer() -> Resolution {
    Resolution {
        tail: LEAST_TAIL,
        other: true,
        most_evaluations: u64::MAX,
    }
}

/// Error of a row at a time (s) of two motions, the error of the last one added.
pub(super) fn row_error(orbits: [&Orbit; 2], t: f64, last: ErrorEstimate) -> ErrorEstimate {
    let [(angle, speed), (other, faster)] = orbits.map(|orbit| orbit.state(t));
    ErrorEstimate {
        theta_rad: MARGIN * angle.minus(other).abs() + last.theta_rad,
        omega_rad_per_s: MARGIN * (speed - faster).abs() + last.omega_rad_per_s,
    }
}

/// Distance of two runs at the end of the first, and what rounding may add.
fn distance(task: &RunSetup<'_>, driving: &Driving, better: &Driving) -> ErrorEstimate {
    let end = driving.end;
    let (a, b) = (driving.orbit.state(end), better.orbit.state(end));
    let floor = late_by(task, a, end, driving.errors.late + ROUNDING * end, PLACE);
    let momentum = task.equation().terms(a.0.rest).inertia.m * a.1.abs();
    ErrorEstimate {
        theta_rad: MARGIN * a.0.minus(b.0).abs() + floor.theta_rad,
        omega_rad_per_s: MARGIN * (a.1 - b.1).abs()
            + floor.omega_rad_per_s
            + driving.errors.off / momentum,
    }
}
