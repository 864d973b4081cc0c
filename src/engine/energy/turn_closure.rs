//! The kinetic energy before a whole turn is complete, seen from where it will be complete.
//!
//! Where forces do no work in a turn, the kinetic energy there is that of the start. Next to an unstable rest,
//! where little of it is left, a short integral from there keeps the digits that the sum over the turn has lost.

use super::profile::Profile;
use crate::numeric::{gauss, root};

/// The end of a whole turn.
pub(super) struct Return<'a> {
    profile: &'a dyn Profile,
    /// rad
    angle: f64,
    /// J
    kinetic: f64,
}

/// From farther away nothing is gained, rad.
const NEAR_END: f64 = 0.5;

impl<'a> Return<'a> {
    /// None where the turns differ.
    pub fn new(profile: &'a dyn Profile, angle: f64, kinetic: f64) -> Option<Return<'a>> {
        profile.repeats().then_some(Return {
            profile,
            angle,
            kinetic,
        })
    }

    fn force(&self, theta: f64) -> f64 {
        self.profile.inertia_and_force(theta).1
    }

    /// The energy integral, J; not positive where the crank does not come.
    fn energy(&self, theta: f64) -> f64 {
        let force = |theta: f64| self.force(theta);
        self.kinetic - gauss::adaptive(&force, theta, self.angle, 0.0)
    }

    fn is_near(&self, theta: f64) -> bool {
        (self.angle - theta).abs() <= NEAR_END
    }

    /// Kinetic energy, J, at an angle, rad; none if it is too far away.
    pub fn kinetic(&self, theta: f64) -> Option<f64> {
        let kinetic = self.is_near(theta).then(|| self.energy(theta))?;
        (kinetic.is_finite() && kinetic > 0.0).then_some(kinetic)
    }

    /// How far the energy of a turning point next to it may be off, J: the end of the turn is a rounded angle.
    pub fn rounding(&self) -> f64 {
        f64::EPSILON * self.angle.abs() * self.force(self.angle).abs()
    }

    /// The turning point near `guess`, after `at`, rad; beyond it, at the rest, the force changes its sign.
    pub fn turning_point(&self, at: f64, guess: f64) -> Option<f64> {
        if !self.is_near(guess) {
            return None;
        }
        let at = self.angle + (at - self.angle).clamp(-NEAR_END, NEAR_END);
        let rest = root::bracketed(|theta| self.force(theta), at, self.angle)?;
        root::bracketed(|theta| self.energy(theta), at, rest)
    }
}
