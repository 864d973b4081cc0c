//! Stretches without a determined slider force: near dead centres, and at rest with friction or dry loads.

use serde::Serialize;

use super::super::row::InverseRow;
use super::inverse_dynamics::Leverage;
use crate::mechanism::Linkage;
use crate::numeric::median::median;

/// Stretch of the motion in which the slider force is left empty.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeadCentreBand {
    /// Time of the first sample, s.
    pub from_s: f64,
    /// Time of the last sample, s.
    pub to_s: f64,
    /// Crank angle of the first sample, rad.
    pub from_theta_rad: f64,
    /// Crank angle of the last sample, rad.
    pub to_theta_rad: f64,
    /// Number of samples in the stretch.
    pub rows: usize,
    /// Reason, in words, why the force is not determined.
    pub reason: &'static str,
}

/// Rule by which samples are left without a force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BandRule {
    /// Largest half-width of the 95 % band of the slider force at which the force is given, N.
    pub half_width_max_n: f64,
    /// Lever arm |x'| below which the rule applies, m/rad: half of the crank length.
    pub arm_m: f64,
    /// Rule in words.
    pub rule: &'static str,
}

/// Lever arm |x'|, in crank lengths, below which forces may be left empty.
const LONG_ARM: f64 = 0.5;

const RULE: &str = "within |x'| < r/2 the slider force is left empty where half of its 95 % band is wider than the largest crank torque of the motion (or ten times the median half-width of that torque's band, if larger) over the crank length, or where x' is less than five standard errors from zero; near the limit of a rocker (cos phi < 0.3) the width alone counts, and each torque of a rocker is divided by |x'| where that is longer than the crank; it is left empty too with friction or dry loads where the crank speed is less than five standard errors from zero";

const NO_SIGN: &str = "the sign of the lever arm x' is not certain";
const AT_LIMIT: &str =
    "the rod stands normal to the guide: the position has no certain derivatives";
pub(in crate::inverse) const AT_REST: &str = "the crank speed is within five standard errors of zero: friction and dry loads may act either way";
const TOO_WIDE: &str =
    "the uncertainty of the motion over the lever arm x' is wider than the force";

const TOO_WIDE_AT_LIMIT: &str = "the rod is nearly normal to the guide: the uncertainty of the motion makes that of the force wider than the force";

impl BandRule {
    /// Creates the rule from crank torques and their standard errors, of which `factor` are half of a 95 % band. Those of a rocker
    /// count over |x'| in crank lengths where that exceeds 1: lever arm and torque grow without bound towards a limit.
    pub(in crate::inverse) fn new(linkage: &Linkage, rows: &[InverseRow], factor: f64) -> BandRule {
        let (r, rocks) = (linkage.r, !linkage.limit_angles().is_empty());
        let torques = rows.iter().filter_map(|row| {
            let arm = if rocks {
                linkage.pose(row.theta).dx
            } else {
                0.0
            };
            let longer = (arm.abs() / r).max(1.0);
            Some((row.crank_torque? / longer, row.crank_torque_se? / longer))
        });
        let (torques, errors): (Vec<f64>, Vec<f64>) = torques.unzip();
        let largest = torques
            .iter()
            .fold(0.0, |most: f64, one| most.max(one.abs()));
        let median = median(errors).unwrap_or(0.0);
        BandRule {
            half_width_max_n: largest.max(10.0 * factor * median) / r,
            arm_m: LONG_ARM * r,
            rule: RULE,
        }
    }

    /// Returns the reason why the force of a sample is left empty, if it is.
    pub(in crate::inverse) fn reason(
        &self,
        row: &InverseRow,
        leverage: &Leverage,
        factor: f64,
    ) -> Option<&'static str> {
        let [force, error] =
            [row.slider_force, row.slider_force_se].map(|value| value.unwrap_or(f64::NAN));
        let narrow = factor * error <= self.half_width_max_n;
        let (arm, near_limit) = (leverage.arm.abs(), leverage.near_limit);
        // Not-a-number counts as uncertain.
        let certain = arm > 5.0 * leverage.arm_se;
        if !force.is_finite() || !error.is_finite() {
            // At a dead centre itself the lever arm is zero.
            Some(if near_limit { AT_LIMIT } else { NO_SIGN })
        } else if !leverage.friction_known {
            Some(AT_REST)
        } else if near_limit && !narrow {
            Some(TOO_WIDE_AT_LIMIT)
        } else if arm >= self.arm_m {
            None
        } else if !certain {
            Some(NO_SIGN)
        } else if !narrow {
            Some(TOO_WIDE)
        } else {
            None
        }
    }
}
