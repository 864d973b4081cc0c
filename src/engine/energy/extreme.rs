//! Smallest and largest speeds, and when a motion turns back.

use super::Orbit;
use super::panel::Panel;
use super::piece::{Piece, Turning};
use super::segment::After;
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
        let stretch_rate = self.piece.stretch_rate();
        // Speed is stretch/slope.
        let rate =
            |x: f64| stretch_rate * self.slope.value(x) - self.piece.stretch(x) * bend.value(x);
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

impl Orbit {
    /// Smallest and largest speed until a time, with sign.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        if until == 0.0 {
            return (self.speed, self.speed);
        }
        let with_sign = |(low, high): (f64, f64), direction: f64| {
            if direction > 0.0 {
                (low, high)
            } else {
                (-high, -low)
            }
        };
        let mut range = with_sign(self.forward.speed_range(0.0, until), self.direction);
        let mut widen = |part: (f64, f64), direction: f64| {
            let (low, high) = with_sign(part, direction);
            range = (range.0.min(low), range.1.max(high));
        };
        let there = self.forward.duration.0;
        if let Some(later) = self.later.as_ref().filter(|_| until > there) {
            widen(later.speed_range(until), self.direction);
        }
        if self.forward.after != After::TurnsBack || until <= there {
            return range;
        }
        // The way back is the way there, from its end.
        let back = (2.0 * there - until).max(0.0);
        widen(self.forward.speed_range(back, there), -self.direction);
        if let Some(leg) = self.backward.as_ref().filter(|_| until > 2.0 * there) {
            let since = until - 2.0 * there;
            widen(leg.speed_range(0.0, since), -self.direction);
            let end = leg.duration.0;
            if leg.after == After::TurnsBack && since > end {
                let back = (2.0 * end - since).max(0.0);
                widen(leg.speed_range(back, end), self.direction);
            }
        }
        range
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

impl Orbit {
    /// Times (s) of the turning points in a period, or in all of a motion that does not repeat; a start at rest is one at the
    /// end of the period.
    fn turnings(&self) -> Vec<f64> {
        let mut found = Vec::new();
        let there = self.forward.duration.0;
        if self.forward.after == After::TurnsBack {
            found.push(there);
            found.extend(self.from_rest.then_some(2.0 * there));
        }
        let back = self.backward.as_ref();
        let back = back.filter(|back| back.after == After::TurnsBack);
        found.extend(back.map(|back| 2.0 * there + back.duration.0));
        found
    }

    /// When it turns back, until a time.
    pub fn turning_times(&self, until: f64) -> Vec<f64> {
        let once = self.turnings();
        let Some((period, _)) = self.period().filter(|_| !once.is_empty()) else {
            return once.into_iter().filter(|t| *t <= until).collect();
        };
        let rounds = (until / period).ceil() as u64;
        (0..=rounds)
            .flat_map(|round| once.iter().map(move |t| t + round as f64 * period))
            .filter(|t| *t <= until)
            .collect()
    }
}
