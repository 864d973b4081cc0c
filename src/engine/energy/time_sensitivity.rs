//! Error of the time on a panel due to errors of forces and energies.

use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::{Values, range};

/// Variation and rounding of the force on a panel.
pub(super) struct TimeSensitivity {
    /// Force at the turning point, if there is one, N m.
    at_turn: f64,
    /// Ratio of the force at the other end to the force at the turning point.
    rise: f64,
    /// Rounding error of the force at an end, mainly due to the rounded angle, N m.
    rounding: f64,
    /// Rounding error of the energy gained, J.
    pub energy: f64,
}

impl TimeSensitivity {
    /// Computes the sensitivity on a panel; `noise` is the rounding error of the force beyond that of angles, N m.
    pub fn of(piece: &Piece, force: &Values, noise: f64) -> TimeSensitivity {
        let (low, high) = range(force);
        // Fraction of the rounding error of an angle that remains in the mean over the 33 points of a panel, about 1/√33.
        let averaged = 0.18;
        let place = 0.5 * f64::EPSILON * piece.from.abs().max(piece.to.abs());
        let [start, .., end] = *force;
        let [at_turn, other] = match piece.turning {
            Turning::AtEnd => [end, start],
            _ => [start, end],
        };
        TimeSensitivity {
            at_turn: at_turn.abs(),
            rise: other / at_turn,
            rounding: place * (high - low) / piece.span().abs() + noise,
            energy: averaged * place * (high - low) + noise * piece.span().abs(),
        }
    }

    /// Returns the error of a turning point at the end, rad, due to the error `off` (J) of the energy and to rounding.
    pub fn misplaced(&self, piece: &Piece, off: f64) -> f64 {
        // Rounded factors of kinetic and potential energy move a turning point even where the energy difference is exact.
        let factors = 3.0;
        match piece.turning {
            Turning::AtEnd => (factors * off / self.at_turn).min(piece.span().abs()),
            _ => 0.0,
        }
    }

    /// Returns the relative error of the time on a panel with a turning point, for an error `off` (J) of the kinetic
    /// energy (J) at the other end.
    ///
    /// The model is a force that grows linearly from the turning point, F = F₀ (1 + (q − 1) u): the time is
    /// arcosh(q)/λ, λ² being the slope of the force over the inertia. Errors are large where q is, next to an unstable
    /// equilibrium. For q ≤ 1 they are at most those under a constant force.
    pub fn at_turn(&self, piece: &Piece, kinetic: f64, off: f64) -> f64 {
        // A force at the turning point below the rounding of the other is zero.
        let q = self.rise.min(1.0 / f64::EPSILON);
        // Half of the digits of q − 1 have to remain.
        let (by_force, by_energy) = if q > 1.0 + f64::EPSILON.sqrt() {
            let arc = q.acosh();
            (
                ((q - 1.0) / (q + 1.0)).sqrt() / arc,
                q * (q * q - 1.0).sqrt() / arc,
            )
        } else {
            (0.5, 1.0)
        };
        // The error of the turning point is limited by its distance from the equilibrium.
        let misplaced = by_force * (self.rounding / self.at_turn).min(2.0);
        if piece.turning == Turning::AtStart {
            return misplaced;
        }
        misplaced.hypot(0.5 * by_energy * off / kinetic)
    }
}
