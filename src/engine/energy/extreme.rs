//! Smallest and largest speeds on panels.

use super::panel::Panel;
use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::{Rule, Values};
use crate::numeric::root;

/// An extreme |speed| among the points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extreme {
    point: usize,
    /// rad/s
    speed: f64,
    /// How far it differs from its neighbours, rad/s: no more is added between the points.
    step: f64,
}

impl Panel {
    /// Largest speed·sign among the points, rad/s, where `sign` is +1 or −1, with |speed| for speed.
    pub fn extreme_at_points(&self, sign: f64) -> f64 {
        sign * self.extremes[usize::from(sign > 0.0)].speed
    }

    /// A bound of it between the points, rad/s.
    pub fn extreme_bound(&self, sign: f64) -> f64 {
        self.extreme_at_points(sign) + self.extremes[usize::from(sign > 0.0)].step
    }

    /// Extreme speed between the points, rad/s.
    pub fn extreme(&self, sign: f64) -> f64 {
        let index = self.extremes[usize::from(sign > 0.0)].point;
        self.extreme_near(self.rule.points(), index, sign)
    }

    /// Largest sign·|speed| near one of some points: there, or next to it where the derivative of the speed
    /// vanishes.
    fn extreme_near(&self, points: &[f64], index: usize, sign: f64) -> f64 {
        let from = points[index.saturating_sub(1)];
        let to = points[(index + 1).min(self.rule.degree())];
        let bend = self.slope.derivative();
        // Speed is stretch/slope.
        let rate = |x: f64| {
            let stretched = match self.piece.stretch_rate() {
                0.0 => 0.0,
                rate => rate * self.slope.value(x),
            };
            stretched - self.piece.stretch(x) * bend.value(x)
        };
        let at_point = sign * self.speed(points[index]).abs();
        // At an extreme the speed hardly depends on the place.
        root::within(rate, from, to, 1e-9)
            .map_or(at_point, |x| at_point.max(sign * self.speed(x).abs()))
    }

    /// Largest sign·|speed| between two times after the start.
    pub fn extreme_between(&self, from: f64, until: f64, sign: f64) -> f64 {
        let ends = [from, until].map(|t| self.position(t));
        let half = 0.5 * (ends[1] - ends[0]);
        let points = self.rule.values(|x| ends[0] + half * (1.0 + x));
        let value = |index: &usize| sign * self.speed(points[*index]).abs();
        let best = (0..=self.rule.degree()).max_by(|a, b| value(a).total_cmp(&value(b)));
        self.extreme_near(&points, best.unwrap_or(0), sign)
    }
}

/// Slowest and fastest of the points, from dt/dx there.
pub(super) fn extremes(piece: &Piece, rule: &Rule, slopes: &Values) -> [Extreme; 2] {
    let half = 0.5 * piece.span().abs();
    match piece.turning {
        Turning::Nowhere => extremes_of(&slopes[..=rule.degree()], half),
        // |speed| is stretch over slope.
        _ => {
            let mut index = 0;
            let slowness = rule.values(|x| {
                index += 1;
                half * slopes[index - 1] / piece.stretch(x).abs()
            });
            extremes_of(&slowness[..=rule.degree()], half)
        }
    }
}

/// Extremes of the speed, from the time that half the piece would take with the speed of each point, s.
fn extremes_of(slowness: &[f64], half: f64) -> [Extreme; 2] {
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

/// Largest sign·|speed| on panels: those that may have it are looked at between their points.
pub(super) fn extreme(panels: &[&Panel], sign: f64) -> f64 {
    let at_points = panels.iter().map(|panel| panel.extreme_at_points(sign));
    let mut best = at_points.fold(f64::NEG_INFINITY, f64::max);
    for panel in panels {
        if panel.extreme_bound(sign) > best {
            best = best.max(panel.extreme(sign));
        }
    }
    best
}
