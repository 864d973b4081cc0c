//! Why an equation has no acceleration somewhere.

use super::Equation;
use crate::numeric::angle::Angle;

/// What keeps the equation from having a finite acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// The rod does not reach the guide, or stands normal to it.
    Blocked,
    /// A load has no finite value: outside its table or the domain of its formula.
    Load,
    /// M is zero.
    NoInertia,
    /// Load or speed are so large that the acceleration has no value in double precision.
    TooLarge,
}

impl Equation {
    /// Why there is no finite acceleration here, if there is none.
    pub fn singularity(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> Option<Singularity> {
        let theta = theta.into();
        let terms = self.terms(theta.rest);
        if !terms.pose.exists() {
            return Some(Singularity::Blocked);
        }
        let load = self.loads().value(t, theta, omega, &terms.pose);
        if !load.is_finite() {
            return Some(Singularity::Load);
        }
        if !self.acceleration(t, theta, omega).is_finite() {
            let some = terms.inertia.m.is_normal();
            return Some(if some {
                Singularity::TooLarge
            } else {
                Singularity::NoInertia
            });
        }
        None
    }
}
