//! Motion by collocation over the crank angle.

use std::time::Instant;

use super::angle_model::AngleModel;
use super::angle_motion::{LEAST_TAIL, PLACE, late_by, worst_row};
use super::error_estimate::MARGIN;
use super::outcome::Estimate;
use super::result::{Cost, ErrorEstimate};
use super::run_setup::RunSetup;
use crate::engine::angle::{self, Driving, Goal, Resolution};
use crate::engine::energy::{NotApplicable, Orbit};

/// Series end where their coefficients have decayed to this part of the tolerance.
const SHARE: f64 = 1e-2;
/// Inside a panel, where friction may cut it, a series is not as good as at the ends.
const CUT: f64 = 0.03;

/// Relative error of times by rounding.
pub(super) const ROUNDING: f64 = 2.5 * f64::EPSILON;

/// Evaluations of a second run for one of the first, and beside them.
const MOST_EVALUATIONS: (u64, u64) = (20, 200_000);

/// Most evaluations of the second run after a first one that took so many, under a work limit.
pub(super) fn most_evaluations(first: u64, limit: u64) -> u64 {
    let (factor, beside) = MOST_EVALUATIONS;
    let share = first.saturating_mul(factor).saturating_add(beside);
    share.min(limit)
}

/// Error of a whole run over the angle, by its distance from a second one; none where that does not get to the end within
/// its share of work.
///
/// # Errors
/// What else keeps the second one from its end.
pub(super) fn estimate(
    position: &AngleModel<'_>,
    task: &RunSetup<'_>,
    evaluations: u64,
    driving: &Driving,
    wants_rows: bool,
) -> Result<Option<Estimate>, NotApplicable> {
    let begun = Instant::now();
    let places = position.evaluations();
    let limited = Resolution {
        most_evaluations: most_evaluations(evaluations, task.options.max_evaluations),
        ..finer()
    };
    let second = angle::run(
        position,
        task.first_state(),
        Goal::Time(driving.end),
        limited,
    );
    let better = match second {
        Ok(Driving {
            short: Some(short), ..
        }) => Err(short.why),
        second => second,
    };
    let better = match better {
        Err(NotApplicable::WorkLimit | NotApplicable::TooManyTurns) => return Ok(None),
        better => better?,
    };
    let cost = Cost {
        evaluations: position.evaluations() - places + better.evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    let error = distance(task, driving, &better);
    let rows = |t: f64| row_error([&driving.orbit, &better.orbit], t, error);
    Ok(Some(Estimate {
        error,
        on_the_way: wants_rows.then(|| worst_row(driving.end, error, rows)),
        cost: Some(cost),
    }))
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
fn row_error(orbits: [&Orbit; 2], t: f64, last: ErrorEstimate) -> ErrorEstimate {
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
