//! Smallest and largest speeds on panels, from their points and the zeros of the derivative of the speed.

use super::panel::Panel;
use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Values};
use crate::numeric::root;

/// Extreme |speed| among the points of a panel, rad/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extreme {
    speed: f64,
    /// Bound of the difference between neighbours, and so of the gain between the points.
    step: f64,
}

impl Panel {
    /// Returns the largest sign·|speed| among some points, rad/s, and beside those that are no smaller than their
    /// neighbours, where the derivative of the speed vanishes. The larger difference from a neighbour bounds the gain.
    fn largest_at(&self, points: &[f64], sign: f64) -> f64 {
        let bend = self.slope.derivative();
        // The speed is dθ/dx over dt/dx.
        let rate = |x: f64| {
            let bent = match self.piece.d2theta() {
                0.0 => 0.0,
                bent => bent * self.slope.value(x),
            };
            bent - self.piece.dtheta(x) * bend.value(x)
        };
        let speed = |x: f64| sign * self.speed(x).abs();
        let mut values = [0.0; MAX_DEGREE + 1];
        let values = &mut values[..points.len()];
        values.copy_from_slice(points);
        self.slope.values(values);
        for (value, x) in values.iter_mut().zip(points) {
            *value = sign * (self.piece.dtheta(*x) / *value).abs();
        }
        let mut best = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for (j, here) in values.iter().enumerate() {
            let (before, after) = (j.saturating_sub(1), (j + 1).min(points.len() - 1));
            let (high, low) = (
                values[before].max(values[after]),
                values[before].min(values[after]),
            );
            if *here < high || here + (here - low) <= best {
                continue;
            }
            // At an extreme the speed is insensitive to the position.
            if let Some(x) = root::within(rate, points[before], points[after], 1e-9) {
                best = best.max(speed(x));
            }
        }
        best
    }

    /// Returns the largest sign·|speed| between two times (s) after the start of the panel, rad/s.
    pub fn extreme_between(&self, from: f64, until: f64, sign: f64) -> f64 {
        let ends = [from, until].map(|t| self.position(t));
        let half = 0.5 * (ends[1] - ends[0]);
        let points = self.rule.values(|x| ends[0] + half * (1.0 + x));
        self.largest_at(&points[..=self.rule.degree()], sign)
    }
}

/// Returns the slowest and the fastest point, from dt/dx at the points.
pub(super) fn extremes(piece: &Piece, rule: &Rule, slopes: &Values) -> [Extreme; 2] {
    let half = 0.5 * piece.span().abs();
    // Time, s, for half the piece at the speed of each point: |dθ/dx| over dt/dx.
    let mut slowness = *slopes;
    if piece.turning != Turning::Nowhere {
        for (slowness, x) in slowness.iter_mut().zip(rule.points()) {
            *slowness = half * *slowness / piece.dtheta(*x).abs();
        }
    }
    let slowness = &slowness[..=rule.degree()];
    let (mut slow, mut fast, mut step) = (slowness[0], slowness[0], 0.0f64);
    for pair in slowness.windows(2) {
        slow = slow.max(pair[1]);
        fast = fast.min(pair[1]);
        step = step.max((pair[1] - pair[0]).abs());
    }
    let step = half * step / (fast * fast);
    [slow, fast].map(|slowness| Extreme {
        speed: half / slowness,
        step,
    })
}

/// Returns the largest sign·|speed| on panels, rad/s; `sign` is +1 or −1. Only panels whose points admit it are
/// searched between points.
pub(super) fn extreme(panels: &[&Panel], sign: f64) -> f64 {
    let of = |panel: &Panel| panel.extremes[usize::from(sign > 0.0)];
    let at_points = panels.iter().map(|panel| sign * of(panel).speed);
    let mut best = at_points.fold(f64::NEG_INFINITY, f64::max);
    for panel in panels {
        let Extreme { speed, step } = of(panel);
        if sign * speed + step > best {
            best = best.max(panel.largest_at(panel.rule.points(), sign));
        }
    }
    best
}
