//! What errors of forces and energies make of the time on a panel.

use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::Values;

/// What is left of the rounding of the angles of a panel in the mean of its 33 points.
const AVERAGED: f64 = 0.18;

/// Kinetic and potential energy are products of three factors each, all rounded, which moves a turning point even where
/// their difference is exact.
const FACTORS: f64 = 3.0;

/// How steep the force is on a panel.
pub(super) struct TimeSensitivity {
    /// Force at the turning point, if there is one, N m,
    at_turn: f64,
    /// and how many times as large it is at the other end.
    rise: f64,
    /// How far the force is off at an end because angles are rounded, N m.
    rounding: f64,
    /// How far the energy that is gained is off, J.
    pub energy: f64,
}

impl TimeSensitivity {
    /// Of a panel on which rounding may change the force by `noise`, N m, beside the rounding of angles.
    pub fn of(piece: &Piece, force: &Values, noise: f64) -> TimeSensitivity {
        let (low, high) = force.iter().fold((f64::MAX, f64::MIN), |(low, high), f| {
            (low.min(*f), high.max(*f))
        });
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
            energy: AVERAGED * place * (high - low) + noise * piece.span().abs(),
        }
    }

    /// How far (rad) a turning point at the end may be off by the kinetic energy (J), and by the energies themselves.
    pub fn misplaced(&self, piece: &Piece, off: f64) -> f64 {
        match piece.turning {
            Turning::AtEnd => (FACTORS * off / self.at_turn).min(piece.span().abs()),
            _ => 0.0,
        }
    }

    /// Relative error of the time on a panel that begins or ends at a turning point, where the kinetic energy (J) at
    /// the other end is off by `off`.
    ///
    /// Both follow from a force that grows evenly from the turning point, F = F₀ (1 + (q − 1) u): the time is
    /// arcosh(q)/λ, λ² the growth of the force by the inertia. That is where the errors become large, for next to an
    /// unstable rest q is large. For q ≤ 1 they are at most those under a constant force.
    pub fn at_turn(&self, piece: &Piece, kinetic: f64, off: f64) -> f64 {
        // A force at the turning point that is less than the rounding of the other is none.
        let q = self.rise.min(1.0 / f64::EPSILON);
        // Half of the digits of q − 1 have to be left.
        let (by_force, by_energy) = if q > 1.0 + f64::EPSILON.sqrt() {
            let arc = q.acosh();
            (
                ((q - 1.0) / (q + 1.0)).sqrt() / arc,
                q * (q * q - 1.0).sqrt() / arc,
            )
        } else {
            (0.5, 1.0)
        };
        // More than as far as the rest the turning point cannot be off.
        let misplaced = by_force * (self.rounding / self.at_turn).min(2.0);
        if piece.turning == Turning::AtStart {
            return misplaced;
        }
        misplaced.hypot(0.5 * by_energy * off / kinetic)
    }
}
