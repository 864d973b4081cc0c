//! Inverse dynamics: an estimated motion in, slider force and crank torque out, by the equation of motion, with
//! standard errors that follow from the covariance of the motion.
//!
//! The motion and the torques on the crank determine the whole force along the guide, and with it the normal force: the
//! slider force is unique. Where the crank torque is unknown, friction and normal force depend on each other.

use super::super::motion_estimate::MotionEstimate;
use super::super::row::InverseRow;
use crate::error::Error;
use crate::mechanism::{Equation, LoadValue, Pose, Reactor, Sense, Terms};
use crate::scene::{Instant, Scene};

/// Lever arm of the slider force at one sample, and what leaves the force in doubt.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Leverage {
    /// Lever arm x', m/rad.
    pub arm: f64,
    /// Standard error of x', m/rad.
    pub arm_se: f64,
    /// Whether the rod is nearly normal to the guide, where the terms of the equation grow without bound.
    pub near_limit: bool,
    /// Whether friction of the guide and dry loads are known: none in the scene, or the slider certainly slides.
    pub friction_known: bool,
}

/// Inverse dynamics of a scene.
#[derive(Debug)]
pub(in crate::inverse) struct InverseDynamics<'a> {
    pub equation: &'a Equation,
    /// Whether the forces of the scene act beside the slider force that is computed.
    pub beside_forces: bool,
    /// Guide with friction, if the scene has one.
    pub guide: Option<&'a Guide>,
}

/// Difference step: crank angle in rad, speed and acceleration relative; differences are right to about 1e-9.
const STEP: f64 = 1e-5;

/// cos φ below which the standard errors include second differences, for force and torque are curved over the
/// uncertainty of the crank angle.
pub(in crate::inverse) const NEAR_LIMIT: f64 = 0.3;

impl InverseDynamics<'_> {
    /// Returns the scene's loads at a state, dry ones against a crank motion of this sense (±1; 0: without dry loads).
    fn loads(&self, t: f64, theta: f64, omega: f64, pose: &Pose, sense: f64) -> LoadValue {
        let loads = self.equation.loads();
        let value = loads.value(t, theta, omega, pose);
        if !loads.are_dry() {
            return value;
        }
        let now = Instant {
            t,
            theta,
            omega,
            x: pose.x,
            v: pose.dx * omega,
        };
        let [meant, own] =
            [sense, omega].map(|speed| loads.dry(&now, Sense::of(speed, pose.dx * speed)));
        LoadValue {
            torque: value.torque + (meant.torque - own.torque),
            force: value.force + (meant.force - own.force),
        }
    }

    /// Returns the force on the slider, N, and the torque on the crank, N m, either of which drives a motion beside the
    /// scene's loads and guide friction, dry loads against this sense of the crank. Torque NaN if the guide locks.
    fn needed_at(&self, t: f64, terms: &Terms, at: [f64; 3], sense: f64) -> [f64; 2] {
        let ([theta, omega, alpha], pose) = (at, &terms.pose);
        let mut whole = self.equation.generalized_force(terms, omega, alpha);
        let mut known = 0.0;
        if !self.equation.loads().are_none() {
            let load = self.loads(t, theta, omega, pose, sense);
            whole -= load.torque;
            known = if self.beside_forces { load.force } else { 0.0 };
        }
        let along = whole / pose.dx;
        let [mut force, mut torque] = [along - known, whole - known * pose.dx];
        if let Some(guide) = self.guide {
            let (motion, direction) = ([omega, alpha], sense * pose.dx.signum());
            force -= guide.friction(pose, motion, direction, along);
            torque -= guide.driven(pose, motion, direction, known) * pose.dx;
        }
        [force, torque]
    }

    /// Returns the force, N, and the torque, N m, of a motion, by `needed_at`.
    pub fn needed(&self, t: f64, at: [f64; 3], sense: f64) -> [f64; 2] {
        self.needed_at(t, &self.equation.terms(at[0]), at, sense.signum())
    }

    /// Computes force and torque of a state, before the rule of empty forces is applied; `with_shared` adds the errors that all
    /// samples share to the standard errors of force and torque. At rest friction and dry loads may be anything up to their
    /// magnitude: the torque is then the middle of its range, and its standard error includes half of the range.
    pub fn demand(
        &self,
        t: f64,
        state: &MotionEstimate,
        with_shared: impl Fn([f64; 2]) -> [f64; 2],
    ) -> (InverseRow, Leverage) {
        let [theta, omega, alpha] = state.value;
        let terms = self.equation.terms(theta);
        let moves = omega.abs() > 5.0 * state.error(&[0.0, 1.0, 0.0], 0.0);
        let friction_known = moves || !self.equation.loads().are_dry() && self.guide.is_none();
        let sense = if omega < 0.0 { -1.0 } else { 1.0 };
        let at = |terms: &Terms, at: [f64; 3]| self.needed_at(t, terms, at, sense);
        let [force, mut torque] = at(&terms, state.value);
        let mut holding = 0.0;
        if !friction_known {
            let [_, other] = self.needed_at(t, &terms, state.value, -sense);
            (torque, holding) = (0.5 * (torque + other), 0.5 * (torque - other).abs());
        }
        let steps = [
            STEP,
            STEP * omega.abs().max(1e-3),
            STEP * alpha.abs().max(omega * omega).max(1e-3),
        ];
        // Force, torque and lever arm at a state with a step of one of its numbers, and that step.
        let beside = |k: usize, step: f64| {
            let (mut moved, mut there, mut step) = (state.value, terms, step);
            moved[k] += step;
            if k == 0 {
                there = self.equation.terms(moved[0]);
                if !there.pose.is_regular() {
                    // One-sided at the limit of a rocker.
                    (moved, there, step) = (state.value, terms, 0.0);
                }
            }
            let [force, torque] = at(&there, moved);
            ([force, torque, there.pose.dx], step)
        };
        let slopes = [0, 1, 2].map(|k| {
            let [(after, h), (before, g)] = [steps[k], -steps[k]].map(|step| beside(k, step));
            [0, 1, 2].map(|i| (after[i] - before[i]) / (h - g))
        });
        let [of_force, of_torque, bend] = [0, 1, 2].map(|i| slopes.map(|slope| slope[i]));
        let near_limit = terms.pose.cos_phi < NEAR_LIMIT;
        let mut bent = [0.0; 2];
        if near_limit {
            let spread = state.angle_error();
            let [a, b] = [theta - spread, theta + spread]
                .map(|theta| at(&self.equation.terms(theta), [theta, omega, alpha]));
            bent = [0, 1].map(|i| (0.5 * (a[i] + b[i]) - [force, torque][i]).abs());
        }
        let (arm, r) = (terms.pose.dx, self.equation.linkage().r);
        let size = (terms.m * alpha).abs()
            + (terms.half_dm * omega * omega).abs()
            + terms.dv.abs()
            // At a dead centre, where the arm is 0, the force is not finite.
            + (force * arm).abs().max(torque.abs());
        let rounding = 8.0 * f64::EPSILON * size;
        let of_arm = 4.0 * f64::EPSILON * r;
        let rounded = (rounding + of_arm * force.abs()) / arm.abs();
        let [force_se, torque_se] = with_shared([
            state.error(&of_force, rounded) + bent[0],
            state.error(&of_torque, rounding) + bent[1] + holding,
        ]);
        let is_known = torque.is_finite() && torque_se.is_finite();
        let row = InverseRow {
            t,
            theta,
            omega,
            alpha,
            slider_force: Some(force),
            slider_force_se: Some(force_se),
            crank_torque: is_known.then_some(torque),
            crank_torque_se: is_known.then_some(torque_se),
            near_dead_centre: false,
        };
        let leverage = Leverage {
            arm,
            arm_se: state.error(&bend, of_arm),
            near_limit,
            friction_known,
        };
        (row, leverage)
    }
}

/// Guide of a slider with friction.
#[derive(Debug)]
pub(in crate::inverse) struct Guide {
    mu: f64,
    reactor: Reactor,
}

/// Crank speed, rad/s, and crank acceleration, rad/s², at one sample.
pub(in crate::inverse) type CrankRates = [f64; 2];

impl Guide {
    /// Returns the guide of a scene; none without friction.
    pub fn new(scene: &Scene) -> Result<Option<Guide>, Error> {
        let Some(friction) = scene.reduced().friction else {
            return Ok(None);
        };
        let reactor = Reactor::new(scene)?;
        let mu = friction.coefficient;
        Ok(Some(Guide { mu, reactor }))
    }

    /// Returns the normal force, N, under this whole force along the guide, N.
    fn normal(&self, pose: &Pose, [omega, alpha]: CrankRates, along: f64) -> f64 {
        let load = LoadValue {
            torque: 0.0,
            force: along,
        };
        self.reactor.reactions(pose, omega, alpha, &load).guide
    }

    /// Returns the friction, N, on a slider moving in `direction` (±1); `along`, N, is the whole force including it.
    pub fn friction(&self, pose: &Pose, motion: CrankRates, direction: f64, along: f64) -> f64 {
        -self.mu * direction * self.normal(pose, motion, along).abs()
    }

    /// Returns the friction, N, on a slider that a torque on the crank drives, beside this force on the slider, N. NaN
    /// where the guide locks and no torque moves the slider.
    pub fn driven(&self, pose: &Pose, motion: CrankRates, direction: f64, force: f64) -> f64 {
        let without = self.normal(pose, motion, force);
        let slope = self.normal(pose, motion, force + 1.0) - without;
        if self.mu * slope.abs() >= 1.0 {
            return f64::NAN;
        }
        let opposing = -self.mu * direction * without.signum();
        opposing * without / (1.0 - opposing * slope)
    }
}
