//! Phases without force: free flight until the gap closes, and receding out of an indentation.

use super::run::{Halt, Runner};
use super::step::{Dense, Stages};
use super::{Contact, Phase, Sample};
use crate::engine::PIECES;
use crate::numeric::root;

/// A piece is cut in two until it is this part of a step, or the cubic through its ends says that the gap stays open or
/// narrows all along; in a piece as short as this the rate of the gap changes its sign at most once.
const FINEST_PIECE: f64 = 1.0 / 1024.0;
/// The gap may be off the cubic by this times what it is off in the middle of a piece.
const CUBIC_MARGIN: f64 = 4.0;
/// A closing is sought to this part of a step: the step that ends there meets it by its own rates.
const NEAR_CLOSING: f64 = 1e-9;

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
        match (apart, pressed) {
            (None, None) => {
                let end = self.snapped(*stages.end(), h);
                self.accept_to(&stages, end, then)
            }
            (Some(u), other) if other.is_none_or(|other| u <= other) => {
                self.cut(u * h, M::gap)?;
                self.enter(Phase::Flight);
                Ok(())
            }
            (_, Some(u)) | (Some(u), None) => {
                self.cut_at(u * h)?;
                self.enter(Phase::Contact { approach });
                Ok(())
            }
        }
    }

    /// The motion inside a step, and rates and depth at its end.
    pub(super) fn inside(&mut self, stages: &mut Stages<N>) -> (Dense<N>, Sample<N>) {
        let (model, phase) = (self.model, self.phase);
        let near = self.near;
        let then = self.sample(None, &{ *stages.end() });
        stages.set_last_rate(then.rates);
        self.evaluations += 3;
        let mut rates = |_: f64, y: &[f64; N]| model.sample(&near, phase, None, y).rates;
        (stages.dense(&mut rates), then)
    }

    /// Accepts the beginning of a step, of length h.
    pub(super) fn cut_at(&mut self, h: f64) -> Halt {
        let stages = self.try_step(h);
        self.accept(stages, h)
    }

    /// Accepts the beginning of a step, of about length h, ended where a value with its rate vanishes.
    fn cut(&mut self, h: f64, value: impl Fn(&M, &[f64; N]) -> (f64, f64)) -> Halt {
        let (model, phase) = (self.model, self.phase);
        let stages = self.try_step(h);
        let mut end = *stages.end();
        for _ in 0..3 {
            let (now, rate) = value(model, &end);
            let dt = -now / rate;
            // Where the value is extreme at zero its rate says nothing.
            if dt == 0.0 || !dt.is_finite() || dt.abs() > 1e-3 * h {
                break;
            }
            let near = self.near;
            end = nudged(&end, dt, |y| model.sample(&near, phase, None, y).rates);
            self.evaluations += 2;
        }
        self.accept_at(stages, end)
    }
}

/// Depth of the contact and its rate.
pub(super) fn depth<M: Contact<N>, const N: usize>(
    model: &M,
    phase: Phase,
    y: &[f64; N],
) -> (f64, f64) {
    let sample = model.sample(&model.near(y), phase, None, y);
    (sample.depth, sample.depth_rate)
}

/// A tiny step by the midpoint rule.
pub(super) fn nudged<const N: usize>(
    y: &[f64; N],
    dt: f64,
    rates: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let first = rates(y);
    let middle = std::array::from_fn(|i| y[i] + 0.5 * dt * first[i]);
    let slope = rates(&middle);
    std::array::from_fn(|i| y[i] + dt * slope[i])
}

/// The gap at a part u of a step.
#[derive(Clone, Copy)]
struct Gap {
    u: f64,
    /// m
    value: f64,
    /// m/s
    rate: f64,
}

/// Where inside a step of length h (s) the gap closes first, if it does.
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

/// First closing of the gap between two places. The control points of the cubic bound it from below.
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
    let doubt = CUBIC_MARGIN * (off.abs() + 0.25 * turned.abs());
    // Its rate is three times the differences of the control points; what is off in four parts of a piece changes in one.
    let narrows = 3.0 * (b - a).max(c - b).max(d - c) < -4.0 * doubt;
    if cubic.into_iter().fold(f64::INFINITY, f64::min) > doubt {
        None
    } else if to.u - from.u > FINEST_PIECE && !(narrows && a > 0.0) {
        closing_between(gap, from, middle, h).or_else(|| closing_between(gap, middle, to, h))
    } else {
        closing_in(gap, from, to)
    }
}

/// First closing of the gap in a short piece: by the sign of the gap at its ends and at the least gap between them, so that a graze
/// is not missed. A gap of zero at the start of a step that opens is looked at from the end of the piece backwards:
/// at the start its sign is rounding.
fn closing_in(gap: &impl Fn(f64) -> Gap, start: Gap, end: Gap) -> Option<f64> {
    let opens = start.u == 0.0 && start.value <= start.rate * 1e-9;
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
        while gap(from).value <= 0.0 && from > 1e-9 * end.u {
            (from, to) = (0.5 * from, from);
        }
    }
    if gap(from).value <= 0.0 {
        return Some(from);
    }
    root::within(|u| gap(u).value, from, to, NEAR_CLOSING)
}

/// Where a value that is positive at the start is first found to be negative.
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
