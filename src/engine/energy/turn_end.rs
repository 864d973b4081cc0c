//! Kinetic energy shortly before a whole turn is complete, integrated backwards from its end.
//!
//! Where forces do no work in a turn, the kinetic energy at its end is that of the start. Next to an unstable
//! equilibrium, where little is left, a short integral from the end keeps the digits that the sum over the turn loses.

use super::profile::Profile;
use crate::numeric::{gauss, root};

/// End of a whole turn.
pub(super) struct TurnEnd<'a> {
    profile: &'a dyn Profile,
    /// Crank angle at the end, rad.
    angle: f64,
    /// Kinetic energy at the end, J.
    kinetic: f64,
}

/// Longest integral from the end that gains digits, rad.
const LONGEST_INTEGRAL: f64 = 0.5;

impl<'a> TurnEnd<'a> {
    /// Makes the end of a turn; none if the turns differ.
    pub fn new(profile: &'a dyn Profile, angle: f64, kinetic: f64) -> Option<TurnEnd<'a>> {
        profile.repeats().then_some(TurnEnd {
            profile,
            angle,
            kinetic,
        })
    }

    fn force(&self, theta: f64) -> f64 {
        self.profile.inertia_and_force(theta).1
    }

    /// Computes the energy integral, J; not positive where the crank does not arrive.
    fn energy(&self, theta: f64) -> f64 {
        let force = |theta: f64| self.force(theta);
        self.kinetic - gauss::adaptive(&force, &[theta, self.angle], 0.0)
    }

    fn is_near(&self, theta: f64) -> bool {
        (self.angle - theta).abs() <= LONGEST_INTEGRAL
    }

    /// Returns the kinetic energy, J, at an angle, rad; none if the angle is too far from the end.
    pub fn kinetic(&self, theta: f64) -> Option<f64> {
        let kinetic = self.is_near(theta).then(|| self.energy(theta))?;
        (kinetic.is_finite() && kinetic > 0.0).then_some(kinetic)
    }

    /// Returns the error bound of the energy at a turning point near the end, J: the end is a rounded angle.
    pub fn rounding(&self) -> f64 {
        f64::EPSILON * self.angle.abs() * self.force(self.angle).abs()
    }

    /// Locates the turning point near `guess`, after `at`, rad; beyond it the force changes sign at the equilibrium.
    pub fn turning_point(&self, at: f64, guess: f64) -> Option<f64> {
        if !self.is_near(guess) {
            return None;
        }
        let at = self.angle + (at - self.angle).clamp(-LONGEST_INTEGRAL, LONGEST_INTEGRAL);
        let rest = root::bracketed(|theta| self.force(theta), at, self.angle)?;
        root::bracketed(|theta| self.energy(theta), at, rest)
    }
}
