//! Kinetic energy on a piece, by integration of the force series, with its rounding floor.

use super::panel::Tried;
use super::piece::{Piece, SAME_ANGLE, Turning};
use super::profile::NotApplicable;
use crate::numeric::chebyshev::{Rule, Series, Values, range};
use crate::numeric::{gauss, root};

/// Kinetic energy on a piece, as the integral of the force from the start or end of the piece itself, never as a
/// difference of large potentials.
pub(super) struct Energy<'a> {
    pub piece: Piece,
    /// Kinetic energy at the start, J.
    pub kinetic: f64,
    pub rule: &'static Rule,
    pub force: &'a Series,
}

/// Checks that a motion can be computed from a start at an angle (rad) with a kinetic energy (J) under a force (N m),
/// and returns the energy. A speed that the force produces within [`SAME_ANGLE`] cannot be distinguished from rest.
pub(super) fn at_start(theta: f64, kinetic: f64, force: f64) -> Result<f64, NotApplicable> {
    if !kinetic.is_finite() || !force.is_finite() {
        Err(NotApplicable::NotFinite)
    } else if kinetic == 0.0 && force == 0.0 {
        Err(NotApplicable::Equilibrium)
    } else if kinetic > 0.0 && kinetic < SAME_ANGLE * theta.abs().max(1.0) * force.abs() {
        Err(NotApplicable::TooSlow)
    } else {
        Ok(kinetic)
    }
}

impl Energy<'_> {
    /// True if the truncation error of the force is negligible, relative to the force or to the energy. Next to a
    /// turning point the rounding of angles appears as `noise`.
    pub fn is_resolved(&self, tolerance: f64, noise: f64) -> bool {
        let tail = self.force.tail();
        match self.piece.turning {
            Turning::Nowhere => {
                let share = self.force.largest() * self.piece.span().abs() / self.kinetic;
                tail * share.min(1.0) <= tolerance || tail <= noise
            }
            _ => tail <= 4.0 * tolerance.max(noise),
        }
    }

    /// Returns the truncation error of the energy due to the force series, J.
    pub fn left_out(&self) -> f64 {
        let largest = self.force.largest() * self.piece.span().abs();
        self.force.tail() * largest / self.rule.degree() as f64
    }

    /// Computes K at the points of a piece without turning point: K at its start plus the integral of the force.
    pub fn kinetic_at_points(&self, force: &Values) -> Values {
        let half = 0.5 * self.piece.span();
        self.rule
            .integrals(force)
            .map(|work| self.kinetic + half * work)
    }

    /// Computes ∫ F u du over [0, 1] between the turning end (u = 0) and x (u = 1), times the direction: there K = ½
    /// span (1 ± x)² times this, without cancellation. Gauss-Legendre with 18 points is exact for the series.
    pub fn mean_force(&self, x: f64) -> f64 {
        let sum: f64 = gauss::RULE_18
            .iter()
            .map(|(u, weight)| {
                let at = match self.piece.turning {
                    Turning::AtEnd => 1.0 - u * (1.0 - x),
                    _ => u * (1.0 + x) - 1.0,
                };
                weight * u * self.force.value(at)
            })
            .sum();
        sum * self.piece.span().signum()
    }

    /// Locates the turning point just before the point `j`, at which the energy is not positive.
    pub fn turns_before(&self, j: usize) -> Tried {
        let points = self.rule.points();
        if j == 0 {
            return Tried::Unresolved;
        }
        let work = self.force.integral();
        let half = 0.5 * self.piece.span();
        let x = root::bracketed(
            |x| match self.piece.turning {
                Turning::Nowhere => self.kinetic + half * work.value(x),
                _ => self.mean_force(x),
            },
            points[j - 1],
            points[j],
        );
        match x {
            Some(x) if x > -1.0 => Tried::TurnsAfter(self.piece.way_to(x)),
            _ => Tried::Unresolved,
        }
    }
}

/// Rounding floor of the last terms of series, relative to the largest term.
pub(super) struct Noise {
    pub force: f64,
    /// Floor of the series of dt/dx.
    pub slope: f64,
}

impl Noise {
    /// Estimates the floor on a panel from the rounding of angles, by the ranges of inertia and force, and from the
    /// rounding error of the force itself, N m. The kinetic energy is a force times a distance, which is not rounded.
    pub fn of(energy: &Energy<'_>, inertia: &Values, force: &Values, rounding: f64) -> Noise {
        let ((light, heavy), (low, high)) = (range(inertia), range(force));
        let span = energy.piece.span().abs();
        // Sum of the last two terms of a series due to rounding of its values, in roundings.
        let last_terms = 8.0;
        let units = last_terms * f64::EPSILON;
        let place = units * energy.piece.from.abs() / span;
        let off = place * (high - low) + last_terms * rounding;
        let of_energy = match energy.piece.turning {
            Turning::Nowhere => off * span / energy.kinetic,
            _ => off / low.abs().min(high.abs()),
        };
        Noise {
            force: units + off / low.abs().max(high.abs()),
            slope: (units + place * (heavy - light) / heavy + of_energy).min(units + place),
        }
    }
}
