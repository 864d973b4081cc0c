//! Output row of each sample.

use super::inverse_dynamics::Demand;
use super::motion_estimate::MotionEstimate;

/// Motion, force and torque at one sample, SI and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InverseRow {
    /// Time, s.
    pub t: f64,
    /// Fitted crank angle, rad, unwrapped.
    pub theta: f64,
    /// Crank speed, rad/s.
    pub omega: f64,
    /// Crank acceleration, rad/s².
    pub alpha: f64,
    /// Force on the slider along +x, N; none where the motion does not determine it.
    pub slider_force: Option<f64>,
    /// Standard error of the force, N.
    pub slider_force_se: Option<f64>,
    /// Torque on the crank that drives the motion in place of the slider force, N m; none where the guide locks.
    pub crank_torque: Option<f64>,
    /// Standard error of the torque, N m.
    pub crank_torque_se: Option<f64>,
    /// Whether the force is left empty.
    pub near_dead_centre: bool,
}

/// Measured value and residual of the fit at one sample, rad or m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Time, s.
    pub t: f64,
    /// Measured value; a crank angle is continued over the turns.
    pub measured: f64,
    /// Measured minus fitted value.
    pub residual: f64,
}

/// Criteria that decide whether a row has a force.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Doubt {
    /// Whether the mechanism can take the crank angle.
    pub exists: bool,
    /// Whether the lever arm x' of the force is at least half a crank.
    pub long_arm: bool,
    /// Whether the sign of the lever arm is certain.
    pub certain: bool,
    /// Whether the rod is nearly normal to the guide.
    pub near_limit: bool,
    /// Whether friction of the guide and dry loads are known.
    pub friction_known: bool,
}

/// Lever arm |x'|, in crank lengths, below which forces may be left empty.
pub(super) const LONG_ARM: f64 = 0.5;

impl Doubt {
    pub fn new(demand: &Demand, r: f64) -> Doubt {
        let arm = demand.arm.abs();
        Doubt {
            exists: arm.is_finite(),
            long_arm: arm >= LONG_ARM * r,
            // Not-a-number counts as uncertain.
            certain: arm > 5.0 * demand.arm_se,
            near_limit: demand.near_limit,
            friction_known: demand.friction_known,
        }
    }
}

impl InverseRow {
    /// Creates a row with its force, before the rule of empty forces is applied.
    pub(super) fn new(t: f64, state: &MotionEstimate, demand: &Demand) -> InverseRow {
        let [theta, omega, alpha] = state.value;
        let is_known = demand.torque.is_finite() && demand.torque_se.is_finite();
        InverseRow {
            t,
            theta,
            omega,
            alpha,
            slider_force: Some(demand.force),
            slider_force_se: Some(demand.force_se),
            crank_torque: is_known.then_some(demand.torque),
            crank_torque_se: is_known.then_some(demand.torque_se),
            near_dead_centre: false,
        }
    }
}
