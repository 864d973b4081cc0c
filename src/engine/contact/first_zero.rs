//! First zero of a smooth function of a step, enclosed by Bernstein coefficients.

use crate::numeric::hermite::Quintic;
use crate::numeric::root;

/// Value of a function at a fraction u of a step, with its derivatives over u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// Fraction of the step.
    pub u: f64,
    /// Value.
    pub value: f64,
    /// First derivative.
    pub rate: f64,
    /// Second derivative.
    pub curvature: f64,
}

/// Returns the fraction of a step at which a function first falls to zero, if it does between two nodes; `at` returns
/// nodes between them, `value` the value alone. A function that rises from zero at the first node counts as positive there.
///
/// The quintic Hermite polynomial through both nodes stands for the function. Its error vanishes as u³(1 − u)³ and is
/// at most its deviation from the cubic Hermite polynomial. The Bernstein coefficients of the lower bound prove that the
/// function stays positive, those of its derivative that it falls all along; else the piece is halved.
pub(super) fn first_zero(
    at: &impl Fn(f64) -> Node,
    value: &impl Fn(f64) -> f64,
    [from, to]: [Node; 2],
) -> Option<f64> {
    let piece = Piece::new(&from, &to);
    // Fraction of a step in which the derivative is taken to change its sign at most once.
    let finest = 1.0 / 1024.0;
    if piece.is_positive() {
        None
    } else if piece.falls() {
        falls_to_zero(value, from, to)
    } else if to.u - from.u > finest {
        let middle = at(0.5 * (from.u + to.u));
        first_zero(at, value, [from, middle]).or_else(|| first_zero(at, value, [middle, to]))
    } else {
        let rises_again = to.value >= 0.0 && from.rate < 0.0 && to.rate > 0.0;
        let last = match rises_again {
            true => at(root::bracketed(|u| at(u).rate, from.u, to.u)?),
            false => to,
        };
        falls_to_zero(value, from, last)
    }
}

/// Locates the zero of a function that falls between two nodes, by Newton's method with the slope of the quintic.
fn falls_to_zero(value: &impl Fn(f64) -> f64, from: Node, to: Node) -> Option<f64> {
    if to.value >= 0.0 {
        return None;
    } else if from.value <= 0.0 {
        return Some(from.u);
    }
    let width = to.u - from.u;
    let ends = [from, to].map(|at| [width * at.rate, 0.5 * width * width * at.curvature]);
    let quintic = Quintic::new(ends[0], ends[1], to.value - from.value);
    let mut s = root::bracketed(|s| from.value + quintic.at(s)[0], 0.0, 1.0)?;
    let slope = quintic.at(s)[1];
    // Three digits or more a step; the step that ends there meets the zero by its own rates.
    for _ in 0..4 {
        let next = s - value(from.u + width * s) / slope;
        let moved = (next - s).abs();
        s = next;
        if moved < f64::EPSILON.sqrt() {
            break;
        }
    }
    match (0.0..=1.0).contains(&s) {
        true => Some(from.u + width * s),
        false => root::bracketed(value, from.u, to.u),
    }
}

/// Quintic Hermite polynomial between two nodes in the Bernstein basis.
struct Piece {
    coefficients: [f64; 6],
    /// Bound of the error in the middle, where it is largest.
    error: f64,
}

impl Piece {
    fn new(from: &Node, to: &Node) -> Piece {
        let width = to.u - from.u;
        let (v0, v1) = (width * from.rate, width * to.rate);
        let (c0, c1) = (width * width * from.curvature, width * width * to.curvature);
        // What rises from zero is zero but for rounding.
        let start = if from.rate > 0.0 {
            from.value.max(0.0)
        } else {
            from.value
        };
        let coefficients = [
            start,
            start + v0 / 5.0,
            start + 0.4 * v0 + c0 / 20.0,
            to.value - 0.4 * v1 + c1 / 20.0,
            to.value - v1 / 5.0,
            to.value,
        ];
        // Second derivatives of the cubic at its ends.
        let rise = 6.0 * (to.value - start);
        let bent = [rise - 4.0 * v0 - 2.0 * v1, 4.0 * v1 + 2.0 * v0 - rise];
        // The difference is u²(1 − u)² times half the linear interpolation of those of the curvatures.
        let error = (c0 - bent[0]).abs().max((c1 - bent[1]).abs()) / 32.0;
        Piece {
            coefficients,
            error,
        }
    }

    /// True if the lower bound of the function is positive but at the start.
    fn is_positive(&self) -> bool {
        let b = &self.coefficients;
        // Degree 6: u³(1 − u)³ is a twentieth of the middle polynomial of the basis, and 1/64 in the middle.
        let lowered = 0.5 * (b[2] + b[3]) - 3.2 * self.error;
        let [first, last] = [(b[0] + 5.0 * b[1]) / 6.0, (5.0 * b[4] + b[5]) / 6.0];
        let inner = [
            first,
            (b[1] + 2.0 * b[2]) / 3.0,
            lowered,
            (2.0 * b[3] + b[4]) / 3.0,
            last,
        ];
        b[0] >= 0.0 && b[5] > 0.0 && inner.into_iter().all(|each| each > 0.0)
    }

    /// True if the function falls all along.
    fn falls(&self) -> bool {
        let b = &self.coefficients;
        let s: [f64; 5] = std::array::from_fn(|i| 5.0 * (b[i + 1] - b[i]));
        // Degree 5: the derivative of u³(1 − u)³ is 3/10 of the difference of the two middle polynomials of the basis.
        let steeper = 64.0 * 0.3 * self.error;
        let inner = [
            0.2 * (s[0] + 4.0 * s[1]),
            0.2 * (2.0 * s[1] + 3.0 * s[2]) + steeper,
            0.2 * (3.0 * s[2] + 2.0 * s[3]) + steeper,
            0.2 * (4.0 * s[3] + s[4]),
        ];
        s[0] < 0.0 && s[4] < 0.0 && inner.into_iter().all(|each| each < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with the first change of sign among many places, for a sine on a slope, up to nearly a period.
    #[test]
    fn the_first_zero_is_found_and_no_other() {
        for case in 0..4000u32 {
            let part = |k: u32| {
                f64::from(case.wrapping_mul(2_654_435_761).rotate_left(7 * k) % 997) / 997.0
            };
            let (high, slope) = (1.2 * part(0), 4.0 * part(1) - 2.0);
            let (size, turn, phase) = (part(2), 6.0 * part(3), 6.3 * part(4));
            let value = |u: f64| high + slope * u + size * ((turn * u + phase).sin() - phase.sin());
            let at = |u: f64| Node {
                u,
                value: value(u),
                rate: slope + size * turn * (turn * u + phase).cos(),
                curvature: -size * turn * turn * (turn * u + phase).sin(),
            };
            let found = first_zero(&at, &value, [at(0.0), at(1.0)]);
            let places = (0..=20_000).map(|i| f64::from(i) / 20_000.0);
            let first = places.clone().find(|u| *u > 0.0 && value(*u) < 0.0);
            match (found, first) {
                (Some(u), Some(first)) => {
                    assert!((0.0..1e-4).contains(&(first - u)), "{case}: {u} {first}")
                }
                (Some(u), None) => assert!(value(u).abs() < 1e-6, "{case}: {u}"),
                (None, Some(u)) => panic!("{case}: none before {u}"),
                (None, None) => {}
            }
        }
    }
}
