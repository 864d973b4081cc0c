//! How many nodes show a function.

use super::{Enclosed, Interval};

/// A piece of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// s
    pub t: Interval,
    /// Crank angle, rad, unwrapped.
    pub angle: Interval,
    /// rad/s
    pub speed: Interval,
}

/// What a function does on a piece of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detail {
    /// Greatest value less the least.
    pub change: f64,
    /// How far it is from a constant in the Bernstein ellipse around the piece; none if it may not be analytic there.
    pub around: Option<f64>,
}

/// Pieces of tables are cubic: fewer nodes show no function of two.
const LEAST_NODES: usize = 4;

impl Detail {
    /// Of a function that is constant, or is not known from anything but its values.
    pub const NONE: Detail = Detail {
        change: 0.0,
        around: Some(0.0),
    };

    /// Of a function that may do anything.
    pub const HIDDEN: Detail = Detail {
        change: f64::INFINITY,
        around: None,
    };

    /// Of an enclosed function.
    pub fn of(function: Enclosed) -> Detail {
        let change = 2.0 * function.real.half();
        Detail {
            change: if change.is_nan() {
                f64::INFINITY
            } else {
                change
            },
            around: function
                .plane
                .map(|plane| plane.radius())
                .filter(|radius| radius.is_finite()),
        }
    }

    /// The sum of two functions.
    pub fn plus(self, other: Detail) -> Detail {
        Detail {
            change: self.change + other.change,
            around: self.around.zip(other.around).map(|(a, b)| a + b),
        }
    }

    /// The function times a factor.
    pub fn times(self, by: f64) -> Detail {
        if self == Detail::NONE {
            return self;
        }
        let change = self.change * by;
        Detail {
            change: if change.is_nan() {
                f64::INFINITY
            } else {
                change
            },
            around: self
                .around
                .map(|around| around * by)
                .filter(|around| around.is_finite()),
        }
    }

    /// Nodes that show it but for `allowed`, where it is enclosed in an ellipse of this size: 4M ρ⁻ⁿ/(ρ − 1) is left. None
    /// where it may not be analytic.
    pub fn nodes(&self, ellipse: f64, allowed: f64) -> Option<usize> {
        let left = 4.0 * self.around? / (allowed * (ellipse - 1.0));
        let terms = (left.ln() / ellipse.ln()).ceil().max(0.0);
        Some((terms as usize).saturating_add(1).max(LEAST_NODES))
    }
}

/// Sizes of the ellipses in which so many nodes leave less than this part. A function that grows slowly, as one with a
/// singularity nearby may, is shown by the smaller one, an entire one rather by the larger.
pub fn ellipses(nodes: usize, part: f64) -> [f64; 2] {
    // The bound is a hundred times the change of the function on the piece.
    let smaller = (part / 100.0).powf(-1.0 / nodes as f64);
    [smaller, smaller * smaller]
}

/// What a function does on a piece, and the least nodes that show it but for `allowed` by these ellipses, where that is no more
/// than `most`.
pub fn shown(
    detail: impl Fn(f64) -> Detail,
    ellipses: [f64; 2],
    allowed: f64,
    most: usize,
) -> (Detail, Option<usize>) {
    let [smaller, larger] = ellipses;
    let first = detail(smaller);
    if first.change <= allowed {
        return (first, Some(1));
    }
    let few = |detail: Detail, ellipse: f64| {
        let nodes = detail.nodes(ellipse, allowed);
        nodes.filter(|nodes| *nodes <= most)
    };
    let nodes = few(first, smaller).or_else(|| {
        first.around?;
        few(detail(larger), larger)
    });
    (first, nodes)
}
