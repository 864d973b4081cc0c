//! A piece of the crank angle and the variable x in [−1, 1] on it.

use std::f64::consts::{PI, TAU};

use crate::numeric::angle::TAU_REST;
use crate::numeric::chebyshev::{MAX_DEGREE, ROUNDING};
use crate::numeric::exact::two_sum;

/// Length of the panels that are tried first, rad: two make a turn.
pub(in crate::engine) const HALF_TURN: f64 = PI + 1e-9;

/// The longest panel from an angle (rad) in a direction, ±1, whose series decays to rounding, rad, by the branch points of what it
/// expands, angle and distance from it: a series decays like ρ⁻ⁿ for the sum of the half axes ρ of the Bernstein ellipse around
/// [−1, 1] that reaches the nearest one (Trefethen, Approximation Theory and Approximation Practice, 2013, theorem 8.1).
pub(super) fn longest_analytic(at: f64, direction: f64, branch_points: [[f64; 2]; 2]) -> f64 {
    let rho = ROUNDING.powf(-1.0 / (MAX_DEGREE as f64 - 1.0));
    let size = 0.5 * (rho + 1.0 / rho);
    // The distances of a point on the ellipse from the ends of the panel add up to the length times its larger half axis.
    let longest = |[angle, height]: [f64; 2]| {
        let ahead = (direction * (angle - at) + PI).rem_euclid(TAU) - PI;
        2.0 * (size * ahead.hypot(height) - ahead) / (size * size - 1.0)
    };
    let [a, b] = branch_points.map(longest);
    a.min(b)
}

/// Which end of a panel is a turning point, where dt/dθ is infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum Turning {
    Nowhere,
    AtStart,
    AtEnd,
}

/// A piece of the motion between two angles, in a variable x in [−1, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::engine) struct Piece {
    /// rad
    pub from: f64,
    /// rad, in either direction
    pub to: f64,
    /// Length with sign, rad. A turning point is no float: next to the start the way to it has digits that the
    /// rounded `to` has lost.
    way: f64,
    pub turning: Turning,
}

impl Piece {
    /// Between two angles, rad.
    pub fn between(from: f64, to: f64, turning: Turning) -> Piece {
        let way = to - from;
        Piece {
            from,
            to,
            way,
            turning,
        }
    }

    /// From an angle to the turning point so far from it, rad, with sign.
    pub fn until_turning(from: f64, way: f64) -> Piece {
        Piece {
            from,
            to: from + way,
            way,
            turning: Turning::AtEnd,
        }
    }

    /// Length with sign, rad.
    pub fn span(&self) -> f64 {
        self.way
    }

    /// The pieces before and after a part of one that turns nowhere.
    pub fn cut(&self, share: f64) -> [Piece; 2] {
        let middle = self.from + share * self.span();
        let part = |from, to| Piece::between(from, to, self.turning);
        [part(self.from, middle), part(middle, self.to)]
    }

    /// The angle, rad, at the variable x from −1 to 1.
    pub fn angle(&self, x: f64) -> f64 {
        match self.turning {
            Turning::AtEnd => self.to - 0.25 * (1.0 - x) * (1.0 - x) * self.span(),
            _ => self.from + self.way_to(x),
        }
    }

    /// How far it is from the start, rad, with sign.
    pub fn way_to(&self, x: f64) -> f64 {
        match self.turning {
            Turning::Nowhere => 0.5 * (1.0 + x) * self.span(),
            Turning::AtStart => 0.25 * (1.0 + x) * (1.0 + x) * self.span(),
            Turning::AtEnd => (1.0 - 0.25 * (1.0 - x) * (1.0 - x)) * self.span(),
        }
    }

    /// dθ/dx
    pub fn stretch(&self, x: f64) -> f64 {
        let share = match self.turning {
            Turning::Nowhere => 0.5,
            Turning::AtStart => 0.5 * (1.0 + x),
            Turning::AtEnd => 0.5 * (1.0 - x),
        };
        share * self.span()
    }

    /// d²θ/dx²
    pub fn stretch_rate(&self) -> f64 {
        match self.turning {
            Turning::Nowhere => 0.0,
            Turning::AtStart => 0.5 * self.span(),
            Turning::AtEnd => -0.5 * self.span(),
        }
    }

    /// The variable x of an angle (rad) of the piece.
    pub fn variable(&self, theta: f64) -> f64 {
        let share = ((theta - self.from) / self.span()).clamp(0.0, 1.0);
        match self.turning {
            Turning::Nowhere => 2.0 * share - 1.0,
            Turning::AtStart => 2.0 * share.sqrt() - 1.0,
            Turning::AtEnd => 1.0 - 2.0 * (1.0 - share).sqrt(),
        }
    }
}

/// Angles that differ by less are the same, rad: some hundred roundings of a sum of turns.
pub(in crate::engine) const SAME_ANGLE: f64 = 1e-12;

/// What the floats for the ends of a turn lack of it, rad.
pub(super) fn missing(start: f64, direction: f64) -> f64 {
    direction * two_sum(start, direction * TAU).1 + TAU_REST
}

/// The end of a panel that begins at `at`: its length, or the next corner before; corners are in rising order.
pub(super) fn next_end(corners: &[f64], at: f64, direction: f64, length: f64) -> f64 {
    let turn = (at / TAU).floor() * TAU;
    let mut end = at + direction * length.min(TAU);
    let near = SAME_ANGLE * at.abs().max(1.0);
    for shift in [-TAU, 0.0, TAU] {
        let place = |corner: &f64| corner + turn + shift;
        let next = if direction > 0.0 {
            let passed = corners.partition_point(|corner| place(corner) - at <= near);
            corners.get(passed)
        } else {
            let ahead = corners.partition_point(|corner| at - place(corner) > near);
            corners[..ahead].last()
        };
        end = match next.map(place) {
            Some(corner) if direction * (corner - end) < 0.0 => corner,
            _ => end,
        };
    }
    end
}
