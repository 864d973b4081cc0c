//! Piece of the crank angle with a variable x in [−1, 1].

use std::f64::consts::{PI, TAU};

use crate::numeric::angle::TAU_REST;
use crate::numeric::chebyshev::{MAX_DEGREE, SERIES_ROUNDING};
use crate::numeric::exact::two_sum;

/// Length of the panels tried first, rad: two make a turn.
pub(in crate::engine) const HALF_TURN: f64 = PI + 1e-9;

/// Returns the length (rad) of the longest panel from an angle (rad) in a direction, ±1, whose series decays to
/// rounding, from the branch points of the function, each an angle and the distance from it: the series decays like
/// ρ⁻ⁿ, ρ the sum of the half axes of the Bernstein ellipse around [−1, 1] through the nearest branch point (Trefethen,
/// Approximation Theory and Approximation Practice, 2013, theorem 8.1).
pub(super) fn longest_analytic(at: f64, direction: f64, branch_points: &[[f64; 2]]) -> f64 {
    let rho = SERIES_ROUNDING.powf(-1.0 / (MAX_DEGREE as f64 - 1.0));
    let size = 0.5 * (rho + 1.0 / rho);
    // The distances of a point on the ellipse from the panel ends add up to the length times the larger half axis.
    let longest = |&[angle, height]: &[f64; 2]| {
        let ahead = (direction * (angle - at) + PI).rem_euclid(TAU) - PI;
        2.0 * (size * ahead.hypot(height) - ahead) / (size * size - 1.0)
    };
    branch_points.iter().map(longest).fold(TAU, f64::min)
}

/// State of a motion over the crank angle.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct KineticState {
    /// Crank angle, rad.
    pub angle: f64,
    /// Direction of motion, +1 or −1.
    pub direction: f64,
    /// Kinetic energy, J; zero at a turning point.
    pub kinetic: f64,
    /// Error bound of the kinetic energy beyond its own rounding, J.
    pub energy_error: f64,
}

/// End of a panel that is a turning point, where dt/dθ is infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum Turning {
    Nowhere,
    AtStart,
    AtEnd,
}

/// Piece of the motion between two angles, in a variable x in [−1, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::engine) struct Piece {
    /// Angle at the start, rad.
    pub from: f64,
    /// Angle at the end, rad, in either direction.
    pub to: f64,
    /// Signed length, rad: to a turning point next to `from` it has digits that the rounded `to` has lost.
    pub span: f64,
    pub turning: Turning,
}

impl Piece {
    /// Makes the piece between two angles, rad.
    pub fn between(from: f64, to: f64, turning: Turning) -> Piece {
        Piece {
            from,
            to,
            span: to - from,
            turning,
        }
    }

    /// Makes the piece from an angle to the turning point at a signed distance `way`, rad.
    pub fn until_turning(from: f64, way: f64) -> Piece {
        Piece {
            from,
            to: from + way,
            span: way,
            turning: Turning::AtEnd,
        }
    }

    /// Cuts a piece without turning points at the fraction `share`.
    pub fn cut(&self, share: f64) -> [Piece; 2] {
        let middle = self.from + share * self.span;
        let part = |from, to| Piece::between(from, to, self.turning);
        [part(self.from, middle), part(middle, self.to)]
    }

    /// Returns the angle, rad, at x in [−1, 1].
    pub fn angle(&self, x: f64) -> f64 {
        match self.turning {
            Turning::AtEnd => self.to - 0.25 * (1.0 - x) * (1.0 - x) * self.span,
            _ => self.from + self.way_to(x),
        }
    }

    /// Returns the signed distance from the start at x, rad.
    pub fn way_to(&self, x: f64) -> f64 {
        match self.turning {
            Turning::Nowhere => 0.5 * (1.0 + x) * self.span,
            Turning::AtStart => 0.25 * (1.0 + x) * (1.0 + x) * self.span,
            Turning::AtEnd => (1.0 - 0.25 * (1.0 - x) * (1.0 - x)) * self.span,
        }
    }

    /// Returns dθ/dx, rad.
    pub fn dtheta(&self, x: f64) -> f64 {
        let share = match self.turning {
            Turning::Nowhere => 0.5,
            Turning::AtStart => 0.5 * (1.0 + x),
            Turning::AtEnd => 0.5 * (1.0 - x),
        };
        share * self.span
    }

    /// Returns d²θ/dx², rad.
    pub fn d2theta(&self) -> f64 {
        match self.turning {
            Turning::Nowhere => 0.0,
            Turning::AtStart => 0.5 * self.span,
            Turning::AtEnd => -0.5 * self.span,
        }
    }

    /// Returns the nearest angle of the piece, rad; none if that is another one by more than rounding.
    pub fn nearest(&self, theta: f64) -> Option<f64> {
        let on_it = theta.clamp(self.from.min(self.to), self.from.max(self.to));
        ((theta - on_it).abs() <= SAME_ANGLE).then_some(on_it)
    }

    /// Returns x at an angle (rad) of the piece.
    pub fn variable(&self, theta: f64) -> f64 {
        let share = ((theta - self.from) / self.span).clamp(0.0, 1.0);
        match self.turning {
            Turning::Nowhere => 2.0 * share - 1.0,
            Turning::AtStart => 2.0 * share.sqrt() - 1.0,
            Turning::AtEnd => 1.0 - 2.0 * (1.0 - share).sqrt(),
        }
    }
}

/// Distance below which two angles count as equal, rad: some hundred roundings of a sum of turns.
pub(in crate::engine) const SAME_ANGLE: f64 = 1e-12;

/// Returns the part of a whole turn, rad, that the rounded angles of its ends leave out.
pub(super) fn turn_remainder(start: f64, direction: f64) -> f64 {
    direction * two_sum(start, direction * TAU).1 + TAU_REST
}

/// Returns the end of a panel from `at`, rad: after `length`, or at a corner before; corners are in rising order.
pub(super) fn next_end(corners: &[f64], at: f64, direction: f64, length: f64) -> f64 {
    let turn = (at / TAU).floor() * TAU;
    let mut end = at + direction * length.min(TAU);
    let near = SAME_ANGLE * at.abs().max(1.0);
    for shift in [-TAU, 0.0, TAU] {
        let unwrapped = |corner: &f64| corner + turn + shift;
        let next = if direction > 0.0 {
            let passed = corners.partition_point(|corner| unwrapped(corner) - at <= near);
            corners.get(passed)
        } else {
            let ahead = corners.partition_point(|corner| at - unwrapped(corner) > near);
            corners[..ahead].last()
        };
        end = match next.map(unwrapped) {
            Some(corner) if direction * (corner - end) < 0.0 => corner,
            _ => end,
        };
    }
    end
}
