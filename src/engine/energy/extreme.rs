//! Smallest and largest speeds on panels, from their points and the zeros of the derivative of the speed.

use super::panel::Panel;
use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::{Rule, Values};
use crate::numeric::root;

/// Extreme |speed| among the points of a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extreme {
    point: usize,
    /// Speed, rad/s.
    speed: f64,
    /// Largest difference from a neighbour, rad/s: bounds the gain between the points.
    step: f64,
}

impl Panel {
    /// Returns the largest sign·|speed| near one of some points, rad/s: at the point, or beside it where the derivative
    /// of the speed vanishes.
    fn extreme_near(&self, points: &[f64], index: usize, sign: f64) -> f64 {
        let from = points[index.saturating_sub(1)];
        let to = points[(index + 1).min(self.rule.degree())];
        let bend = self.slope.derivative();
        // The speed is dθ/dx over dt/dx.
        let rate = |x: f64| {
            let bent = match self.piece.d2theta() {
                0.0 => 0.0,
                bent => bent * self.slope.value(x),
            };
            bent - self.piece.dtheta(x) * bend.value(x)
        };
        let at_point = sign * self.speed(points[index]).abs();
        // At an extreme the speed is insensitive to the position.
        root::within(rate, from, to, 1e-9)
            .map_or(at_point, |x| at_point.max(sign * self.speed(x).abs()))
    }

    /// Returns the largest sign·|speed| between two times (s) after the start of the panel, rad/s.
    pub fn extreme_between(&self, from: f64, until: f64, sign: f64) -> f64 {
        let ends = [from, until].map(|t| self.position(t));
        let half = 0.5 * (ends[1] - ends[0]);
        let points = self.rule.values(|x| ends[0] + half * (1.0 + x));
        let value = |index: &usize| sign * self.speed(points[*index]).abs();
        let best = (0..=self.rule.degree()).max_by(|a, b| value(a).total_cmp(&value(b)));
        self.extreme_near(&points, best.unwrap_or(0), sign)
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
    let (mut slow, mut fast) = (0, 0);
    for (j, here) in slowness.iter().enumerate() {
        if *here > slowness[slow] {
            slow = j;
        }
        if *here < slowness[fast] {
            fast = j;
        }
    }
    let speed_at = |j: usize| half / slowness[j];
    [slow, fast].map(|point| {
        let before = speed_at(point.saturating_sub(1));
        let after = speed_at((point + 1).min(slowness.len() - 1));
        let speed = speed_at(point);
        Extreme {
            point,
            speed,
            step: (speed - before).abs().max((speed - after).abs()),
        }
    })
}

/// Returns the largest sign·|speed| on panels, rad/s; `sign` is +1 or −1. Only panels whose bound admits it are
/// searched between points.
pub(super) fn extreme(panels: &[&Panel], sign: f64) -> f64 {
    let of = |panel: &Panel| panel.extremes[usize::from(sign > 0.0)];
    let at_points = panels.iter().map(|panel| sign * of(panel).speed);
    let mut best = at_points.fold(f64::NEG_INFINITY, f64::max);
    for panel in panels {
        let Extreme { point, speed, step } = of(panel);
        if sign * speed + step > best {
            best = best.max(panel.extreme_near(panel.rule.points(), point, sign));
        }
    }
    best
}
