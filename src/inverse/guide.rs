//! Coulomb friction at the guide of a slider whose motion is known.
//!
//! The motion and the torques on the crank determine the whole force along the guide, and with it the normal force: there
//! is one answer for the slider force. Where a torque on the crank is asked for, friction and normal force depend on each
//! other.

use crate::error::Error;
use crate::mechanism::{LoadValue, Pose, Reactor};
use crate::scene::Scene;

/// The guide of a slider with friction.
#[derive(Debug)]
pub(super) struct Guide {
    mu: f64,
    reactor: Reactor,
}

/// Motion at one sample: speed, rad/s, and acceleration, rad/s², of the crank.
pub(super) type CrankRates = [f64; 2];

impl Guide {
    /// The guide of a scene; none without friction.
    pub fn new(scene: &Scene) -> Result<Option<Guide>, Error> {
        let Some(friction) = scene.reduced().friction else {
            return Ok(None);
        };
        let reactor = Reactor::new(scene)?;
        let mu = friction.coefficient;
        Ok(Some(Guide { mu, reactor }))
    }

    /// The normal force, N, with this whole force along the guide, N.
    fn normal(&self, pose: &Pose, [omega, alpha]: CrankRates, along: f64) -> f64 {
        let load = LoadValue {
            torque: 0.0,
            force: along,
        };
        self.reactor.reactions(pose, omega, alpha, &load).guide
    }

    /// The friction, N, on a slider that moves in `direction` (±1), for a whole force along the guide, N, itself included.
    pub fn friction(&self, pose: &Pose, motion: CrankRates, direction: f64, along: f64) -> f64 {
        -self.mu * direction * self.normal(pose, motion, along).abs()
    }

    /// The friction, N, beside this force on the slider, N, where a torque on the crank drives it. Not a number where
    /// the guide locks itself, and no torque does.
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
