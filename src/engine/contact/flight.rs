//! Phases without force: free flight until the gap closes, and release from an indentation.

use super::dop853::{Dense, Stages};
use super::run::{Halt, Runner};
use super::{Contact, Phase, Sample};
use crate::engine::PIECES;
use crate::numeric::root;

/// Largest correction of the end of a step by one step of the midpoint rule, as a fraction of the step: its error, of
/// third order, is 1e-9 of that of the rule over the whole step.
pub(super) const END_CORRECTION: f64 = 1e-3;

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    pub(super) fn fly(&mut self) -> Halt {
        self.h = self.flight_h;
        let before = self.model.gap(&self.y);
        let (mut stages, h) = self.controlled_step(f64::INFINITY)?;
        self.flight_h = self.h;
        let after = self.model.gap(stages.end());
        let fastest = before.1.abs().max(after.1.abs());
        let bend = h * h * self.now.depth_acceleration.abs();
        if before.0.min(after.0) > 3.0 * h * fastest + bend {
            return self.accept(stages, h);
        }
        let (dense, then) = self.inside(&mut stages);
        match closing(self.model, &dense, h) {
            None => {
                let end = self.snapped(*stages.end(), h);
                self.accept_to(&stages, end, then)
            }
            Some(u) => {
                self.cut(u * h, M::gap)?;
                let approach = self.model.approach(self.now.depth_rate);
                self.enter(Phase::Contact { approach });
                Ok(())
            }
        }
    }

    pub(super) fn recede(&mut self, approach: f64) -> Halt {
        let (mut stages, h) = self.controlled_step(f64::INFINITY)?;
        let (dense, then) = self.inside(&mut stages);
        let model = self.model;
        let depth = |u: f64| depth(model, self.phase, &dense.at(u));
        let apart = first_sign_change(|u| depth(u).0);
        let pressed = first_sign_change(|u| -model.pressing(approach, depth(u).1));
        if let Some(u) = apart.filter(|apart| pressed.is_none_or(|pressed| *apart <= pressed)) {
            self.cut(u * h, M::gap)?;
            self.enter(Phase::Flight);
            Ok(())
        } else if let Some(u) = pressed {
            self.cut_at(u * h)?;
            self.enter(Phase::Contact { approach });
            Ok(())
        } else {
            let end = self.snapped(*stages.end(), h);
            self.accept_to(&stages, end, then)
        }
    }

    /// Computes the dense output of a step, and rates and depth at its end.
    pub(super) fn inside(&mut self, stages: &mut Stages<N>) -> (Dense<N>, Sample<N>) {
        let (model, phase) = (self.model, self.phase);
        let near = self.near;
        let then = self.sample(None, &{ *stages.end() });
        stages.set_last_rate(then.rates);
        self.evaluations += 3;
        let mut rates = |_: f64, y: &[f64; N]| model.sample(&near, phase, None, y).rates;
        (stages.dense(&mut rates), then)
    }

    /// Accepts the first part of a step, of length h, s.
    pub(super) fn cut_at(&mut self, h: f64) -> Halt {
        let stages = self.try_step(h);
        self.accept(stages, h)
    }

    /// Accepts the first part of a step, about h (s) long, up to the zero of `value` (Newton, value and rate).
    fn cut(&mut self, h: f64, value: impl Fn(&M, &[f64; N]) -> (f64, f64)) -> Halt {
        let stages = self.try_step(h);
        let mut end = *stages.end();
        for _ in 0..3 {
            let (now, rate) = value(self.model, &end);
            let dt = -now / rate;
            // At an extreme with value zero the rate vanishes.
            if dt == 0.0 || !dt.is_finite() || dt.abs() > END_CORRECTION * h {
                break;
            }
            end = self.nudged(&end, dt, self.phase);
        }
        self.accept_at(stages, end)
    }

    /// Takes a tiny step of length dt (s) from a state in a phase by the midpoint rule.
    pub(super) fn nudged(&mut self, y: &[f64; N], dt: f64, phase: Phase) -> [f64; N] {
        self.evaluations += 2;
        let rates = |y: &[f64; N]| self.model.sample(&self.near, phase, None, y).rates;
        let first = rates(y);
        let middle = std::array::from_fn(|i| y[i] + 0.5 * dt * first[i]);
        let slope = rates(&middle);
        std::array::from_fn(|i| y[i] + dt * slope[i])
    }
}

/// Returns the depth of the contact, m, and its rate, m/s.
pub(super) fn depth<M: Contact<N>, const N: usize>(
    model: &M,
    phase: Phase,
    y: &[f64; N],
) -> (f64, f64) {
    let sample = model.sample(&model.near(y), phase, None, y);
    (sample.depth, sample.depth_rate)
}

/// Gap at a fraction u of a step.
#[derive(Clone, Copy)]
struct Gap {
    u: f64,
    /// Gap, m.
    value: f64,
    /// Rate of the gap, m/s.
    rate: f64,
}

/// Returns the fraction of a step of length h (s) at which the gap first closes, if it does.
fn closing<M: Contact<N>, const N: usize>(model: &M, dense: &Dense<N>, h: f64) -> Option<f64> {
    let gap = |u: f64| {
        let (value, rate) = model.gap(&dense.at(u));
        Gap { u, value, rate }
    };
    let mut before = gap(0.0);
    (1..=PIECES).find_map(|i| {
        let after = gap(i as f64 / PIECES as f64);
        let found = closing_between(&gap, before, after, h);
        before = after;
        found
    })
}

/// Returns the first closing of the gap between two positions. The Bézier points of the cubic through the ends bound
/// the gap from below; pieces are bisected until it excludes a closing or narrows all along.
fn closing_between(gap: &impl Fn(f64) -> Gap, from: Gap, to: Gap, h: f64) -> Option<f64> {
    let width = (to.u - from.u) * h;
    let cubic = [
        from.value,
        from.value + from.rate * width / 3.0,
        to.value - to.rate * width / 3.0,
        to.value,
    ];
    let [a, b, c, d] = cubic;
    let middle = gap(0.5 * (from.u + to.u));
    let off = middle.value - 0.125 * (a + 3.0 * (b + c) + d);
    let turned = middle.rate * width - 0.75 * (c + d - a - b);
    // Bound of the deviation from the cubic, as a multiple of that at the middle of the piece.
    let margin = 4.0;
    let doubt = margin * (off.abs() + 0.25 * turned.abs());
    // Its rate is three times the differences of the control points; what is off in four parts changes in one.
    let narrows = 3.0 * (b - a).max(c - b).max(d - c) < -4.0 * doubt;
    // Fraction of a step in which the rate of the gap is taken to change sign at most once.
    let finest = 1.0 / 1024.0;
    if cubic.into_iter().fold(f64::INFINITY, f64::min) > doubt {
        None
    } else if to.u - from.u > finest && !(narrows && a > 0.0) {
        closing_between(gap, from, middle, h).or_else(|| closing_between(gap, middle, to, h))
    } else {
        closing_in(gap, from, to)
    }
}

/// Returns the first closing of the gap in a short piece, by the signs of the gap at its ends and at the minimum
/// between them, which includes a graze. A step that starts with a gap of zero and opens is searched from the end of
/// the piece backwards: at the start the sign is rounding.
fn closing_in(gap: &impl Fn(f64) -> Gap, start: Gap, end: Gap) -> Option<f64> {
    // A gap below what opens in a nanosecond counts as zero.
    let opens = start.u == 0.0 && start.value <= start.rate * 1e-9;
    // Width of the bracket, as a fraction of a step: the step that ends there meets the closing by its own rates.
    let width = 1e-9;
    let mut last = end;
    if end.value >= 0.0 && start.rate < 0.0 && end.rate > 0.0 {
        last = gap(root::bracketed(|u| gap(u).rate, start.u, end.u)?);
    }
    if last.value >= 0.0 {
        return None;
    }
    let (mut from, mut to) = (start.u, last.u);
    if opens {
        from = 0.5 * to;
        while gap(from).value <= 0.0 && from > width * end.u {
            (from, to) = (0.5 * from, from);
        }
    }
    if gap(from).value <= 0.0 {
        return Some(from);
    }
    root::within(|u| gap(u).value, from, to, width)
}

/// Returns the first zero of a value that is positive at the start and sampled as negative later.
fn first_sign_change(value: impl Fn(f64) -> f64) -> Option<f64> {
    let mut before = 0.0;
    for i in 1..=PIECES {
        let u = i as f64 / PIECES as f64;
        if value(u) < 0.0 {
            return root::bracketed(&value, before, u).or(Some(before));
        }
        before = u;
    }
    None
}
