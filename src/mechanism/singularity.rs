//! Singular states of the equation, at which no finite acceleration exists.

use super::Equation;
use crate::numeric::angle::Angle;

/// Reason why the equation has no finite acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// The rod does not reach the guide, or stands normal to it.
    Blocked,
    /// A load has no finite value: outside its table or the domain of its formula.
    Load,
    /// M is zero.
    NoInertia,
    /// A load or the speed is too large for an acceleration in double precision.
    TooLarge,
}

impl Equation {
    /// Returns the reason why the acceleration is not finite at this state; none if it is finite.
    pub fn singularity(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> Option<Singularity> {
        let theta = theta.into();
        let terms = self.terms(theta.rest);
        if !terms.pose.is_regular() {
            return Some(Singularity::Blocked);
        }
        let load = self.loads().value(t, theta, omega, &terms.pose);
        if !load.is_finite() {
            return Some(Singularity::Load);
        }
        if !self.acceleration(t, theta, omega).is_finite() {
            let some = terms.m.is_normal();
            return Some(if some {
                Singularity::TooLarge
            } else {
                Singularity::NoInertia
            });
        }
        None
    }
}
