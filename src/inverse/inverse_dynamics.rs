//! Inverse dynamics: the equation read backwards along an estimated motion, with the standard errors that follow from its
//! covariance.

use super::guide::Guide;
use super::motion_estimate::MotionEstimate;
use crate::mechanism::{Equation, LoadValue, Pose, Sense, Terms};
use crate::scene::Instant;

/// Torque and lever arm at one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demand {
    /// Torque on the crank that the motion needs beside the torques of the scene, N m.
    pub torque: f64,
    /// Its standard error.
    pub torque_se: f64,
    /// x', m/rad.
    pub arm: f64,
    /// Standard error of x'.
    pub arm_se: f64,
    /// Force on the slider that does the same, N.
    pub force: f64,
    /// Its standard error.
    pub force_se: f64,
    /// Whether the rod is so near to normal to the guide that the terms of the equation grow without bound.
    pub near_limit: bool,
    /// Whether friction of the guide and dry loads are known: without any, or where the slider certainly slides.
    pub friction_known: bool,
}

/// Reads the equation of a scene backwards.
#[derive(Debug)]
pub(super) struct Backwards<'a> {
    pub equation: &'a Equation,
    /// Whether the forces of the scene act beside the one that is asked for.
    pub beside_forces: bool,
    /// The guide, if it has friction.
    pub guide: Option<&'a Guide>,
}

/// Step in the crank angle (rad) for derivatives of the terms: they are right to about 1e-9.
const STEP: f64 = 1e-5;

/// Its sine and cosine.
const STEP_SIN: f64 = STEP - STEP * STEP * STEP / 6.0;
const STEP_COS: f64 = 1.0 - 0.5 * STEP * STEP;

/// cos φ below which force and torque are curved enough over the uncertainty of the crank angle to ask for their second
/// differences.
pub(super) const NEAR_LIMIT: f64 = 0.3;

/// Part of the largest rounding of the terms that is its standard deviation.
const RARE: f64 = 0.5;

impl Backwards<'_> {
    /// The scene's loads at a state; dry ones against a motion in this sense of the crank, zero: without them.
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

    /// Torque that the scene's loads exert at a state, dry ones against this sense of the crank.
    fn known(&self, t: f64, theta: f64, omega: f64, terms: &Terms, sense: f64) -> f64 {
        if self.equation.loads().are_none() {
            return 0.0;
        }
        let load = self.loads(t, theta, omega, &terms.pose, sense);
        if self.beside_forces {
            load.generalized(&terms.pose)
        } else {
            load.torque
        }
    }

    /// Whether the sense of the motion is certain.
    fn moves(&self, state: &MotionEstimate) -> bool {
        state.value[1].abs() > 5.0 * self.error(state, &[0.0, 1.0, 0.0], 0.0)
    }

    /// What one state of the motion needs.
    pub fn demand(&self, t: f64, state: &MotionEstimate) -> Demand {
        let [theta, omega, alpha] = state.value;
        let terms = self.equation.terms(theta);
        // One-sided at the limit of a rocker.
        let beside = |sense: f64| {
            let Pose { sin, cos, .. } = terms.pose;
            let turned = [
                sin * STEP_COS + sense * cos * STEP_SIN,
                cos * STEP_COS - sense * sin * STEP_SIN,
            ];
            let there = self.equation.linkage().pose_at(turned[0], turned[1]);
            if there.exists() {
                (sense * STEP, self.equation.terms_at(there))
            } else {
                (0.0, terms)
            }
        };
        let ((up, after), (down, before)) = (beside(1.0), beside(-1.0));
        let needed = |terms: &Terms| self.equation.generalized_force(terms, omega, alpha);
        // At rest dry loads may be anything up to their magnitude: the torque is then the middle of what is possible,
        // and its error has the rest in it.
        let moves = self.moves(state);
        let sense = if moves { omega.signum() } else { 0.0 };
        let holding = match moves || !self.equation.loads().are_dry() {
            true => 0.0,
            false => (self.known(t, theta, omega, &terms, 1.0)
                - self.known(t, theta, omega, &terms, 0.0))
            .abs(),
        };
        let known = self.known(t, theta, omega, &terms, sense);
        let torque = needed(&terms) - known;
        let slope = |f: &dyn Fn(&Terms, f64) -> f64| {
            (f(&after, theta + up) - f(&before, theta + down)) / (up - down)
        };
        let by_theta =
            slope(&|terms, theta| needed(terms) - self.known(t, theta, omega, terms, sense));
        let faster = STEP * omega.abs().max(1e-3);
        let by_omega = 2.0 * terms.inertia.half_dm * omega
            - (self.known(t, theta, omega + faster, &terms, sense)
                - self.known(t, theta, omega - faster, &terms, sense))
                / (2.0 * faster);
        let gradient = [by_theta, by_omega, terms.inertia.m];
        let size = (terms.inertia.m * alpha).abs()
            + (terms.inertia.half_dm * omega * omega).abs()
            + terms.dv.abs()
            + known.abs();
        let rounding = 8.0 * f64::EPSILON * size;
        let error = |gradient: &[f64; 3], more: f64| self.error(state, gradient, more);
        let (arm, bend) = (terms.pose.dx, terms.pose.d2x);
        let force = torque / arm;
        let of_force = [
            (by_theta - force * bend) / arm,
            by_omega / arm,
            terms.inertia.m / arm,
        ];
        let r = self.equation.linkage().r;
        let near_limit = terms.pose.cos_phi < NEAR_LIMIT;
        let bent = if near_limit {
            let spread = state.angle_error();
            let [before, after] = [theta - spread, theta + spread].map(|theta| {
                let terms = self.equation.terms(theta);
                let torque = needed(&terms) - self.known(t, theta, omega, &terms, sense);
                [torque, torque / terms.pose.dx]
            });
            [0, 1].map(|i| (0.5 * (before[i] + after[i]) - [torque, force][i]).abs())
        } else {
            [0.0; 2]
        };
        let demand = Demand {
            torque,
            torque_se: error(&gradient, rounding) + bent[0] + holding,
            arm,
            arm_se: error(&[bend, 0.0, 0.0], 4.0 * f64::EPSILON * r),
            force,
            force_se: error(
                &of_force,
                (rounding + 4.0 * f64::EPSILON * r * force.abs()) / arm.abs(),
            ) + bent[1],
            near_limit,
            friction_known: moves || !self.equation.loads().are_dry(),
        };
        match self.guide {
            Some(guide) => self.beside_friction(guide, t, state, demand),
            None => demand,
        }
    }

    /// Standard error of a combination of angle, speed and acceleration, with what else rounding adds.
    fn error(&self, state: &MotionEstimate, gradient: &[f64; 3], more: f64) -> f64 {
        (state.variance(gradient) + (RARE * more).powi(2)).sqrt()
    }

    /// What is needed beside the friction of the guide. At rest that may be anything up to its limit: the torque is then
    /// the middle of what is possible, and its error has the rest in it.
    fn beside_friction(
        &self,
        guide: &Guide,
        t: f64,
        state: &MotionEstimate,
        demand: Demand,
    ) -> Demand {
        let omega = state.value[1];
        let friction_known = self.moves(state);
        let forwards = (demand.arm * omega).signum();
        let along = |direction: f64| move |at: [f64; 3]| self.friction(guide, t, at, direction);
        let rows = [forwards, -forwards].map(|direction| along(direction)(state.value));
        let steps = [
            STEP,
            STEP * omega.abs().max(1e-3),
            STEP * state.value[2].abs().max(1e-3),
        ];
        let mut slopes = [[0.0; 3]; 2];
        for (k, step) in steps.into_iter().enumerate() {
            let beside = |sign: f64| {
                let mut at = state.value;
                at[k] += sign * step;
                along(forwards)(at)
            };
            let (after, before) = (beside(1.0), beside(-1.0));
            for i in 0..2 {
                slopes[i][k] = (after[i] - before[i]) / (2.0 * step);
            }
        }
        let [of_force, of_torque] = slopes.map(|slope| self.error(state, &slope, 0.0));
        let [[force, torque], [_, other]] = rows;
        Demand {
            force: demand.force - force,
            force_se: demand.force_se + of_force,
            torque: demand.torque
                - if friction_known {
                    torque
                } else {
                    0.5 * (torque + other)
                },
            torque_se: demand.torque_se
                + if friction_known {
                    of_torque
                } else {
                    0.5 * (torque - other).abs()
                },
            friction_known,
            ..demand
        }
    }

    /// Friction of the guide, N, where the slider is driven by a force on it, and its moment about the crank, N m, where it
    /// is driven by a torque on the crank, for angle, speed and acceleration.
    fn friction(&self, guide: &Guide, t: f64, at: [f64; 3], direction: f64) -> [f64; 2] {
        let [theta, omega, alpha] = at;
        let terms = self.equation.terms(theta);
        let sense = direction * terms.pose.dx.signum();
        let load = self.loads(t, theta, omega, &terms.pose, sense);
        let needed = self.equation.generalized_force(&terms, omega, alpha);
        let along = (needed - load.torque) / terms.pose.dx;
        let force = if self.beside_forces { load.force } else { 0.0 };
        [
            guide.friction(&terms.pose, [omega, alpha], direction, along),
            guide.driven(&terms.pose, [omega, alpha], direction, force) * terms.pose.dx,
        ]
    }
}
