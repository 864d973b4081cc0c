//! Coulomb friction at the guide of a slider whose motion is known.
//!
//! The motion and the torques on the crank determine the whole force along the guide, and with it the normal force: the
//! slider force is unique. Where the crank torque is unknown, friction and normal force depend on each other.

use crate::error::Error;
use crate::mechanism::{LoadValue, Pose, Reactor};
use crate::scene::Scene;

/// Guide of a slider with friction.
#[derive(Debug)]
pub(super) struct Guide {
    mu: f64,
    reactor: Reactor,
}

/// Crank speed, rad/s, and crank acceleration, rad/s², at one sample.
pub(super) type CrankRates = [f64; 2];

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
