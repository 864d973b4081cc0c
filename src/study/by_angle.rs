//! Motion by collocation over the crank angle.

use std::f64::consts::TAU;
use std::time::Instant;

use super::over_angle::{Motion, late_by};
use super::profile::Position;
use super::summary::{Cost, ErrorEstimate};
use super::task::Task;
use crate::engine::angle::{self, Driving, Goal, Resolution};
use crate::engine::energy::Unserved;
use crate::scene::Extent;

/// Series end where their coefficients have decayed to this part of the tolerance.
const SHARE: f64 = 1e-2;
/// Where rounding takes over.
const LEAST_TAIL: f64 = 4e-15;

/// Relative error of times by rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// What is stated is larger than the distance of two runs by this.
const MARGIN: f64 = 1.5;

/// Solves a task.
pub(super) fn solve(task: &Task<'_>, position: &Position<'_>) -> Result<Motion, Unserved> {
    let begun = Instant::now();
    let speed = task.scene.motion.speed;
    let run = |goal: Goal, resolution: Resolution| {
        angle::run(position, task.start(), speed, goal, resolution)
    };
    let plain = Resolution {
        tail: (SHARE * task.scene.run.tolerance).max(LEAST_TAIL),
        other: false,
    };
    let goal = match task.extent {
        Extent::Duration(duration) => Goal::Time(duration),
        Extent::Revolutions(turns) => Goal::Turned(turns * TAU),
    };
    let driving = run(goal, plain)?;
    let wall_s = begun.elapsed().as_secs_f64();
    let places = position.evaluations();
    let estimate = if task.options.estimate {
        let begun = Instant::now();
        // Finer, and cut at other angles: two runs on the same panels would have the same error.
        let finer = Resolution {
            tail: LEAST_TAIL,
            other: true,
        };
        let better = run(Goal::Time(driving.end), finer)?;
        let cost = Cost {
            evaluations: position.evaluations() - places + better.evaluations,
            wall_s: begun.elapsed().as_secs_f64(),
        };
        Some((distance(task, &driving, &better), Some(cost)))
    } else {
        None
    };
    Ok(Motion {
        last: driving.orbit.state(driving.end),
        orbit: driving.orbit,
        end: driving.end,
        work: driving.work,
        evaluations: places + driving.evaluations,
        wall_s,
        stopped: None,
        estimate,
    })
}

/// Distance of two runs at the end of the first, and what rounding may add.
fn distance(task: &Task<'_>, driving: &Driving, better: &Driving) -> ErrorEstimate {
    let end = driving.end;
    let (a, b) = (driving.orbit.state(end), better.orbit.state(end));
    let floor = late_by(task, a, end, ROUNDING * end);
    ErrorEstimate {
        theta_rad: MARGIN * a.0.minus(b.0).abs() + floor.theta_rad,
        omega_rad_per_s: MARGIN * (a.1 - b.1).abs() + floor.omega_rad_per_s,
    }
}
