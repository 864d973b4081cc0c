//! The equation read backwards along a fitted motion, with the uncertainty that follows from the fit's.

use crate::mechanism::{Equation, Terms};
use crate::numeric::fit::State;

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
}

/// Reads the equation of a scene backwards.
#[derive(Debug)]
pub(super) struct Backwards<'a> {
    pub equation: &'a Equation,
    /// Whether the forces of the scene act beside the one that is asked for.
    pub beside_forces: bool,
    /// Standard deviation of the samples.
    pub sigma: f64,
}

/// Step in the crank angle (rad) for derivatives of the terms: they are right to about 1e-9.
const STEP: f64 = 1e-5;

impl Backwards<'_> {
    /// Torque that the scene's loads exert at a state.
    fn known(&self, t: f64, theta: f64, omega: f64, terms: &Terms) -> f64 {
        let load = self.equation.loads().value(t, theta, omega, &terms.pose);
        if self.beside_forces {
            load.generalized(&terms.pose)
        } else {
            load.torque
        }
    }

    /// What one state of the motion needs.
    pub fn demand(&self, t: f64, state: &State) -> Demand {
        let [theta, omega, alpha] = state.value;
        let terms = self.equation.terms(theta);
        // One-sided at the limit of a rocker.
        let beside = |step: f64| {
            let there = self.equation.terms(theta + step);
            if there.pose.exists() {
                (step, there)
            } else {
                (0.0, terms)
            }
        };
        let ((up, after), (down, before)) = (beside(STEP), beside(-STEP));
        let needed = |terms: &Terms| self.equation.generalized_force(terms, omega, alpha);
        let known = self.known(t, theta, omega, &terms);
        let torque = needed(&terms) - known;
        let slope = |f: &dyn Fn(&Terms, f64) -> f64| {
            (f(&after, theta + up) - f(&before, theta + down)) / (up - down)
        };
        let by_theta = slope(&|terms, theta| needed(terms) - self.known(t, theta, omega, terms));
        let faster = STEP * omega.abs().max(1e-3);
        let by_omega = 2.0 * terms.inertia.half_dm * omega
            - (self.known(t, theta, omega + faster, &terms)
                - self.known(t, theta, omega - faster, &terms))
                / (2.0 * faster);
        let gradient = [by_theta, by_omega, terms.inertia.m];
        let size = (terms.inertia.m * alpha).abs()
            + (terms.inertia.half_dm * omega * omega).abs()
            + terms.dv.abs()
            + known.abs();
        let rounding = 8.0 * f64::EPSILON * size;
        let error = |gradient: &[f64; 3], more: f64| {
            let noise = self.sigma * self.sigma * state.variance(gradient);
            let variance = noise + state.bias_of(gradient);
            variance.sqrt().hypot(state.rounding_of(gradient) + more)
        };
        let (arm, bend) = (terms.pose.dx, terms.pose.d2x);
        let force = torque / arm;
        let of_force = [
            (by_theta - force * bend) / arm,
            by_omega / arm,
            terms.inertia.m / arm,
        ];
        let r = self.equation.linkage().r;
        Demand {
            torque,
            torque_se: error(&gradient, rounding),
            arm,
            arm_se: error(&[bend, 0.0, 0.0], 4.0 * f64::EPSILON * r),
            force,
            force_se: error(
                &of_force,
                (rounding + 4.0 * f64::EPSILON * r * force.abs()) / arm.abs(),
            ),
        }
    }
}
