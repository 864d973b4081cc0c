//! How finely a motion over the crank angle is computed, and how far two of them are apart.

use super::angle_motion::LEAST_TAIL;
use super::error_estimate::MARGIN;
use super::result::ErrorEstimate;
use super::run_setup::RunSetup;
use crate::engine::angle::Resolution;
use crate::engine::energy::Orbit;

/// Series end where their coefficients have decayed to this part of the tolerance.
const SHARE: f64 = 1e-2;
/// Inside a panel, where friction may cut it, a series is not as good as at the ends.
const CUT: f64 = 0.03;

/// Relative error of times by rounding.
pub(super) const ROUNDING: f64 = 2.5 * f64::EPSILON;

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
