//! Number of nodes that resolve a function on a piece of a motion.

use super::{Enclosed, Interval};

/// Fraction of the allowed error that each corner may leave.
pub const CORNER_SHARE: f64 = 1e-4;

/// Piece of a motion: ranges of time, angle and speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionPiece {
    /// Time, s.
    pub t: Interval,
    /// Crank angle, or coordinate of the configuration curve, rad, unwrapped.
    pub angle: Interval,
    /// Rate of the angle, rad/s.
    pub speed: Interval,
}

/// Variation of a function on a piece of a motion, and in the plane around it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Greatest value less the least.
    pub change: f64,
    /// Bound M of the distance of an analytic function from a constant in the Bernstein ellipse.
    pub around: f64,
    /// Largest deviation from the analytic function on the piece; zero if it is the function itself.
    pub deviation: f64,
}

impl Variation {
    /// Variation of a function that is constant, or is known by its values alone.
    pub const NONE: Variation = Variation {
        change: 0.0,
        around: 0.0,
        deviation: 0.0,
    };

    /// Variation of a function that may do anything.
    pub const HIDDEN: Variation = Variation {
        change: f64::INFINITY,
        around: 0.0,
        deviation: f64::INFINITY,
    };

    /// Returns the variation of an enclosed function.
    pub fn of(function: Enclosed) -> Variation {
        let half = function.real.half();
        if half == 0.0 {
            return Variation::NONE;
        }
        Variation {
            change: 2.0 * half,
            around: function.plane.radius(),
            deviation: function.deviation,
        }
        .known()
    }

    /// Returns the variation, hidden where a bound is not a number.
    fn known(self) -> Variation {
        match (self.change + self.around + self.deviation).is_nan() {
            true => Variation::HIDDEN,
            false => self,
        }
    }

    /// Returns the variation of the sum of two functions.
    pub fn plus(self, other: Variation) -> Variation {
        Variation {
            change: self.change + other.change,
            around: self.around + other.around,
            deviation: self.deviation + other.deviation,
        }
    }

    /// Returns the variation of the function times a factor.
    pub fn times(self, by: f64) -> Variation {
        if self == Variation::NONE {
            return self;
        }
        Variation {
            change: self.change * by,
            around: self.around * by,
            deviation: self.deviation * by,
        }
        .known()
    }

    /// Whether the function deviates from an analytic one by more than a corner may leave.
    fn deviates(&self, allowed: f64) -> bool {
        self.deviation > CORNER_SHARE * allowed
    }

    /// Returns the number of nodes that resolve the function to `allowed`, where it is enclosed in an ellipse of this
    /// size: the error is 4M ρ⁻ⁿ/(ρ − 1). None where the function is not analytic, or may not be.
    pub fn nodes(&self, ellipse: f64, allowed: f64) -> Option<usize> {
        if self.deviates(allowed) || self.around.is_infinite() {
            return None;
        }
        let left = 4.0 * self.around / (allowed * (ellipse - 1.0));
        let terms = (left.ln() / ellipse.ln()).ceil().max(0.0);
        // Pieces of tables are cubics, which four nodes determine.
        let least = 4;
        Some((terms as usize).saturating_add(1).max(least))
    }
}

/// Returns two sizes of ellipses in which this number of nodes leaves less than this part. The smaller serves a
/// function that grows slowly, the larger rather an entire function.
pub fn ellipses(nodes: usize, part: f64) -> [f64; 2] {
    let smaller = least_ellipse(nodes, part);
    [smaller, smaller * smaller]
}

/// Returns about the size of the smallest ellipse in which this number of nodes leaves less than this part of the change
/// of a function on the piece.
fn least_ellipse(nodes: usize, part: f64) -> f64 {
    // The bound 4M/(ρ − 1) is taken as a hundred times the change.
    (part / 100.0).powf(-1.0 / nodes as f64)
}

/// Returns the variation of a function on a piece, and the least number of nodes that resolve it to `allowed` by these
/// ellipses, if no more than `most`.
pub fn resolved(
    variation: impl Fn(f64) -> Variation,
    ellipses: [f64; 2],
    allowed: f64,
    most: usize,
) -> (Variation, Option<usize>) {
    let [smaller, larger] = ellipses;
    let first = variation(smaller);
    if first.change <= allowed {
        return (first, Some(1));
    }
    let few = |variation: Variation, ellipse: f64| {
        let nodes = variation.nodes(ellipse, allowed);
        nodes.filter(|nodes| *nodes <= most)
    };
    let nodes = few(first, smaller).or_else(|| {
        (!first.deviates(allowed)).then_some(())?;
        few(variation(larger), larger)
    });
    (first, nodes)
}

/// Whether this number of nodes resolves to `allowed` a function of this change on the piece, by the smallest ellipse
/// that may serve: a larger one may hold a singularity.
pub fn is_resolved_by_least_ellipse(
    variation: impl Fn(f64) -> Variation,
    change: f64,
    allowed: f64,
    nodes: usize,
) -> bool {
    let ellipse = least_ellipse(nodes, allowed / change);
    let least = || variation(ellipse).nodes(ellipse, allowed);
    ellipse.is_finite() && least().is_some_and(|least| least <= nodes)
}

/// Returns true if a function whose enclosure is unbounded, given by the signed distance from a place that is known to
/// `width`, has no integral there: its product with the distance does not vanish with the distance, as it does beside
/// jumps, roots and logarithms.
pub fn has_pole(function: impl Fn(f64) -> f64, width: f64) -> bool {
    let [near, far] = [8.0 * width, 1024.0 * width];
    let product = |aside: f64| (aside * function(aside)).abs();
    [1.0, -1.0]
        .iter()
        .any(|side| product(side * near) > 0.5 * product(side * far))
}
