//! Smallest and largest speeds on panels, from their points and the zeros of the derivative of the speed.

use super::panel::Panel;
use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::{Rule, Values};
use crate::numeric::root;

/// Largest sign·|speed| among the points of a panel, rad/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extreme {
    speed: f64,
    /// Bound of the speed beside the points.
    most: f64,
    /// Points beside which the speed may be larger, one per bit.
    beside: u64,
}

impl Extreme {
    /// Finds the largest of values at points. The larger difference from a neighbour bounds the gain beside a point that
    /// is no smaller than both.
    fn of(values: &[f64]) -> Extreme {
        let speed = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (mut most, mut beside) = (speed, 0);
        for (j, here) in values.iter().enumerate() {
            let before = values[j.saturating_sub(1)];
            let after = values[(j + 1).min(values.len() - 1)];
            let (high, low) = (before.max(after), before.min(after));
            let bound = here + (here - low);
            if *here >= high && bound >= speed {
                most = most.max(bound);
                beside |= 1 << j;
            }
        }
        Extreme {
            speed,
            most,
            beside,
        }
    }
}

impl Panel {
    /// Returns the largest sign·|speed| on the panel, rad/s, given that of some points: at one of them, or beside one
    /// where the derivative of the speed vanishes.
    fn largest_beside(&self, points: &[f64], found: Extreme, sign: f64) -> f64 {
        let bend = self.slope.derivative();
        // The speed is dθ/dx over dt/dx.
        let rate = |x: f64| {
            let bent = match self.piece.d2theta() {
                0.0 => 0.0,
                bent => bent * self.slope.value(x),
            };
            bent - self.piece.dtheta(x) * bend.value(x)
        };
        let mut best = found.speed;
        for j in (0..points.len()).filter(|j| found.beside >> j & 1 == 1) {
            let (from, to) = (
                points[j.saturating_sub(1)],
                points[(j + 1).min(points.len() - 1)],
            );
            // At an extreme the speed is insensitive to the position.
            if let Some(x) = root::within(rate, from, to, 1e-9) {
                best = best.max(sign * self.speed(x).abs());
            }
        }
        best
    }

    /// Returns the largest sign·|speed| between two times (s) after the start of the panel, rad/s.
    pub fn extreme_between(&self, from: f64, until: f64, sign: f64) -> f64 {
        let ends = [from, until].map(|t| self.position(t));
        let half = 0.5 * (ends[1] - ends[0]);
        let count = self.rule.degree() + 1;
        let points = self.rule.values(|x| ends[0] + half * (1.0 + x));
        let values = points.map(|x| sign * self.speed(x).abs());
        self.largest_beside(&points[..count], Extreme::of(&values[..count]), sign)
    }
}

/// Returns the slowest and the fastest point, from dt/dx at the points.
pub(super) fn extremes(piece: &Piece, rule: &Rule, slopes: &Values) -> [Extreme; 2] {
    let half = 0.5 * piece.span().abs();
    let mut speeds = *slopes;
    let speeds = &mut speeds[..=rule.degree()];
    for (speed, x) in speeds.iter_mut().zip(rule.points()) {
        // |dθ/dx| over dt/dx.
        let dtheta = match piece.turning {
            Turning::Nowhere => half,
            _ => piece.dtheta(*x).abs(),
        };
        *speed = -dtheta / *speed;
    }
    let slow = Extreme::of(speeds);
    speeds.iter_mut().for_each(|speed| *speed = -*speed);
    [slow, Extreme::of(speeds)]
}

/// Returns the largest sign·|speed| on panels, rad/s; `sign` is +1 or −1. Only panels whose points admit it are
/// searched between points.
pub(super) fn extreme(panels: &[&Panel], sign: f64) -> f64 {
    let of = |panel: &Panel| panel.extremes[usize::from(sign > 0.0)];
    let at_points = panels.iter().map(|panel| of(panel).speed);
    let mut best = at_points.fold(f64::NEG_INFINITY, f64::max);
    for panel in panels {
        let found = of(panel);
        if found.most > best {
            best = best.max(panel.largest_beside(panel.rule.points(), found, sign));
        }
    }
    best
}
