//! Kinetic energy on a piece, by integration of the force series, its rounding, and the errors of the time that follow.

use super::panel::Attempt;
use super::piece::{Piece, SAME_ANGLE, Turning};
use super::profile::NotApplicable;
use crate::numeric::chebyshev::{Rule, Series, Values};
use crate::numeric::median::range;
use crate::numeric::{gauss, root};

/// Kinetic energy on a piece, as the integral of the force from its start or end: no difference of large potentials.
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
                let share = self.force.largest() * self.piece.span.abs() / self.kinetic;
                tail * share.min(1.0) <= tolerance || tail <= noise
            }
            _ => tail <= 4.0 * tolerance.max(noise),
        }
    }

    /// Returns the truncation error of the energy due to the force series, J.
    pub fn truncation_error(&self) -> f64 {
        let largest = self.force.largest() * self.piece.span.abs();
        self.force.tail() * largest / self.rule.degree() as f64
    }

    /// Computes K at the points of a piece without turning point: K at its start plus the integral of the force.
    pub fn kinetic_at_points(&self, force: &Values) -> Values {
        let half = 0.5 * self.piece.span;
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
        sum * self.piece.span.signum()
    }

    /// Locates the turning point just before the point `j`, at which the energy is not positive.
    pub fn turns_before(&self, j: usize) -> Attempt {
        let points = self.rule.points();
        if j == 0 {
            return Attempt::Unresolved;
        }
        let work = self.force.integral();
        let half = 0.5 * self.piece.span;
        let x = root::bracketed(
            |x| match self.piece.turning {
                Turning::Nowhere => self.kinetic + half * work.value(x),
                _ => self.mean_force(x),
            },
            points[j - 1],
            points[j],
        );
        match x {
            Some(x) if x > -1.0 => Attempt::TurnsAfter(self.piece.way_to(x)),
            _ => Attempt::Unresolved,
        }
    }

    /// Returns the relative error of the duration of the piece due to an error (J) of the kinetic energy. `slopes` and
    /// `kinetic` are dt/dx and the kinetic energy (J) at the points.
    pub fn duration_error(
        &self,
        sensitivity: &TimeSensitivity,
        slopes: &Values,
        kinetic: &Values,
        error: f64,
    ) -> f64 {
        let (piece, rule) = (&self.piece, self.rule);
        let truncation = self.truncation_error();
        match piece.turning {
            Turning::Nowhere => {
                // dT/dK is the integral of dt/2K.
                let early: Values = std::array::from_fn(|j| 0.5 * slopes[j] / kinetic[j]);
                let least = kinetic.iter().fold(f64::INFINITY, |m, k| m.min(*k));
                error * rule.rounded_integral(&early) / rule.rounded_integral(slopes)
                    + truncation / least
            }
            Turning::AtStart => sensitivity.at_turn(piece, f64::INFINITY, error),
            Turning::AtEnd => {
                sensitivity.at_turn(piece, self.kinetic, error) + truncation / self.kinetic
            }
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
        let span = energy.piece.span.abs();
        // Sum of the last two terms of a series due to rounding of its values, in roundings.
        let last_terms = 8.0;
        let units = last_terms * f64::EPSILON;
        let angle_rounding = units * energy.piece.from.abs() / span;
        let force_error = angle_rounding * (high - low) + last_terms * rounding;
        let of_energy = match energy.piece.turning {
            Turning::Nowhere => force_error * span / energy.kinetic,
            _ => force_error / low.abs().min(high.abs()),
        };
        Noise {
            force: units + force_error / low.abs().max(high.abs()),
            slope: (units + angle_rounding * (heavy - light) / heavy + of_energy)
                .min(units + angle_rounding),
        }
    }
}

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
        // Fraction of the rounding error of an angle in the mean over the 33 points of a panel, about 1/√33.
        let averaged = 0.18;
        let angle_rounding = 0.5 * f64::EPSILON * piece.from.abs().max(piece.to.abs());
        let [start, .., end] = *force;
        let [at_turn, other] = match piece.turning {
            Turning::AtEnd => [end, start],
            _ => [start, end],
        };
        TimeSensitivity {
            at_turn: at_turn.abs(),
            rise: other / at_turn,
            rounding: angle_rounding * (high - low) / piece.span.abs() + noise,
            energy: averaged * angle_rounding * (high - low) + noise * piece.span.abs(),
        }
    }

    /// Returns the error of a turning point at the end, rad, due to an error of the energy (J) and to rounding.
    pub fn turning_point_error(&self, piece: &Piece, energy_error: f64) -> f64 {
        // Rounded factors of both energies move a turning point even where the energy difference is exact.
        let factors = 3.0;
        match piece.turning {
            Turning::AtEnd => (factors * energy_error / self.at_turn).min(piece.span.abs()),
            _ => 0.0,
        }
    }

    /// Returns the relative error of the time on a panel with a turning point, for an error (J) of the kinetic energy
    /// (J) at the other end.
    ///
    /// The model is a force that grows linearly from the turning point, F = F₀ (1 + (q − 1) u): the time is
    /// arcosh(q)/λ, λ² being the slope of the force over the inertia. Errors are large where q is, next to an unstable
    /// equilibrium. For q ≤ 1 they are at most those under a constant force.
    pub fn at_turn(&self, piece: &Piece, kinetic: f64, energy_error: f64) -> f64 {
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
        let of_turning_point = by_force * (self.rounding / self.at_turn).min(2.0);
        if piece.turning == Turning::AtStart {
            return of_turning_point;
        }
        of_turning_point.hypot(0.5 * by_energy * energy_error / kinetic)
    }
}
