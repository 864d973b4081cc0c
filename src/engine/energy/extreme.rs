//! Smallest and largest speeds on panels, from their points and the zeros of the derivative of the speed.

use super::panel::Panel;
use super::piece::{Piece, Turning};
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, SERIES_ROUNDING, Values};

/// Best of the points whose value is no smaller than at their neighbours. Beside a point a value gains at most the
/// larger difference from a neighbour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peak {
    point: usize,
    value: f64,
    /// Bound of the values beside the point.
    bound: f64,
    /// Bound of the values beside any other such point.
    rival: f64,
}

impl Peak {
    const NONE: Peak = Peak {
        point: 0,
        value: f64::NEG_INFINITY,
        bound: f64::NEG_INFINITY,
        rival: f64::NEG_INFINITY,
    };

    /// Counts a point in, with the larger difference of its value from a neighbour.
    fn admit(&mut self, point: usize, value: f64, step: f64) {
        let bound = value + step;
        if value > self.value {
            *self = Peak {
                point,
                value,
                bound,
                rival: self.rival.max(self.bound),
            };
        } else {
            self.rival = self.rival.max(bound);
        }
    }
}

/// Visits the points where sign·value is no smaller than beside, with the sign and the larger difference beside.
fn local_extremes(values: &[f64], mut visit: impl FnMut(usize, f64, f64)) {
    let mut before = 0.0f64;
    for (j, value) in values.iter().enumerate() {
        let after = values.get(j + 1).map_or(0.0, |next| next - value);
        if before >= 0.0 && after <= 0.0 {
            visit(j, 1.0, before.max(-after));
        }
        if before <= 0.0 && after >= 0.0 {
            visit(j, -1.0, after.max(-before));
        }
        before = after;
    }
}

/// Returns the slowest and the fastest point from dt/dx at the points; their values are ±dt/dθ over half the length of
/// the piece, the slowest positive.
pub(super) fn extremes(piece: &Piece, rule: &Rule, slopes: &Values) -> [Peak; 2] {
    let mut slowness = *slopes;
    if piece.turning != Turning::Nowhere {
        let half = 0.5 * piece.span.abs();
        for (slowness, x) in slowness.iter_mut().zip(rule.points()) {
            *slowness = half * *slowness / piece.dtheta(*x).abs();
        }
    }
    let slowness = &slowness[..=rule.degree()];
    let mut found = [Peak::NONE; 2];
    local_extremes(slowness, |j, sign, step| {
        found[usize::from(sign < 0.0)].admit(j, sign * slowness[j], step);
    });
    found
}

impl Panel {
    /// Returns the largest sign·|speed| at or beside one of some points, where it is no smaller than at the neighbours and
    /// `known`, rad/s: by Newton's method for a zero of the derivative, kept between the neighbours.
    fn largest_beside(&self, points: &[f64], index: usize, sign: f64, known: f64) -> f64 {
        let bend = self.slope.derivative();
        let twist = bend.derivative();
        // The speed is dθ/dx over dt/dx: its derivative has the sign of this rate.
        let uphill = sign * self.piece.span.signum();
        let rate = |x: f64| {
            let [bend, twist] = bend.values_with(&twist, x);
            let bent = match self.piece.d2theta() {
                0.0 => 0.0,
                bent => bent * self.slope.value(x),
            };
            let dtheta = self.piece.dtheta(x);
            [bent - dtheta * bend, -dtheta * twist].map(|of| uphill * of)
        };
        let [mut low, mut high] =
            [index.saturating_sub(1), (index + 1).min(points.len() - 1)].map(|i| points[i]);
        let mut x = points[index];
        // A step squares the error, to which the speed at an extreme is insensitive.
        let (last_step, resolved) = (1e-5, 1e-9);
        while high - low > resolved {
            let [rate, slope] = rate(x);
            match rate > 0.0 {
                true => low = x,
                false => high = x,
            }
            let newton = x - rate / slope;
            let is_inside = low < newton && newton < high;
            let next = if is_inside {
                newton
            } else {
                0.5 * (low + high)
            };
            let step = (next - x).abs();
            x = next;
            if is_inside && step < last_step {
                break;
            }
        }
        known.max(sign * self.speed(x).abs())
    }

    /// Returns the largest sign·|speed| at and between some points, rad/s; `known` if none is larger.
    fn largest_among(&self, points: &[f64], sign: f64, known: f64) -> f64 {
        let mut speeds = [0.0; MAX_DEGREE + 1];
        let speeds = &mut speeds[..points.len()];
        speeds.copy_from_slice(points);
        self.slope.values(speeds);
        for (speed, x) in speeds.iter_mut().zip(points) {
            *speed = (self.piece.dtheta(*x) / *speed).abs();
        }
        let mut best = known;
        local_extremes(speeds, |j, of, step| {
            if of == sign && exceeds(sign * speeds[j] + step, best) {
                best = best.max(self.largest_beside(points, j, sign, sign * speeds[j]));
            }
        });
        best
    }

    /// Returns the largest sign·|speed| between two times (s) after the start of the panel, rad/s.
    pub fn extreme_between(&self, from: f64, until: f64, sign: f64) -> f64 {
        let ends = [from, until].map(|t| self.position(t));
        let half = 0.5 * (ends[1] - ends[0]);
        let points = self.rule.values(|x| ends[0] + half * (1.0 + x));
        self.largest_among(&points[..=self.rule.degree()], sign, f64::NEG_INFINITY)
    }
}

/// Tells whether a bound exceeds a known value by more than rounding.
fn exceeds(bound: f64, known: f64) -> bool {
    bound - known > SERIES_ROUNDING * known.abs() || known == f64::NEG_INFINITY
}

/// Returns the largest sign·|speed| on panels, rad/s; only panels whose points admit it are searched between them.
pub(super) fn extreme(panels: &[&Panel], sign: f64) -> f64 {
    let peak = |panel: &Panel| panel.extremes[usize::from(sign > 0.0)];
    // A bound beyond zero admits any speed; no rival, none.
    let speed = |panel: &Panel, value: f64| match sign * value < 0.0 {
        true => -0.5 * panel.piece.span.abs() / value,
        false => sign * f64::INFINITY,
    };
    let at_points = panels.iter().map(|panel| speed(panel, peak(panel).value));
    let mut best = at_points.fold(f64::NEG_INFINITY, f64::max);
    for panel in panels {
        let Peak {
            point,
            value,
            bound,
            rival,
        } = peak(panel);
        if exceeds(speed(panel, bound), best) {
            let known = speed(panel, value);
            best = best.max(panel.largest_beside(panel.rule.points(), point, sign, known));
        }
        if exceeds(speed(panel, rival), best) {
            best = panel.largest_among(panel.rule.points(), sign, best);
        }
    }
    best
}
