//! Phases without force: free flight until the gap closes, and receding out of an indentation.

use super::run::{Halt, Runner};
use super::step::{Dense, Stages};
use super::{Contact, Phase, Sample};
use crate::numeric::root;

/// A step is looked at in so many pieces; in each the rate of the gap changes its sign at most once.
const PIECES: usize = 8;

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    pub(super) fn fly(&mut self) -> Halt {
        self.h = self.flight_h;
        let before = self.model.gap(&self.y);
        let (mut stages, h) = self.controlled_step(f64::INFINITY)?;
        self.flight_h = self.h;
        let after = self.model.gap(stages.end());
        let fastest = before.1.abs().max(after.1.abs());
        if before.0.min(after.0) > 3.0 * h * fastest {
            return self.accept(stages, h);
        }
        let (dense, then) = self.inside(&mut stages);
        match closing(self.model, &dense) {
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
        let mut stages = self.try_step(h);
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
        let then = self.sample(None, &end);
        stages.set_last_rate(then.rates);
        self.accept_to(&stages, end, then)
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

/// Where inside a step the gap closes first, if it does: by its sign at the ends of the pieces and at the least
/// gaps between them, so that a graze is not missed. A gap of zero at the start that opens is looked at
/// from its end backwards: at the start its sign is rounding.
fn closing<M: Contact<N>, const N: usize>(model: &M, dense: &Dense<N>) -> Option<f64> {
    let gap = |u: f64| model.gap(&dense.at(u));
    let mut before = (0.0, gap(0.0));
    for i in 1..=PIECES {
        let u = i as f64 / PIECES as f64;
        let after = (u, gap(u));
        let opens = i == 1 && before.1.0 <= before.1.1 * 1e-9;
        let mut end = after;
        if after.1.0 >= 0.0 && before.1.1 < 0.0 && after.1.1 > 0.0 {
            let least = root::bracketed(|u| gap(u).1, before.0, after.0)?;
            end = (least, gap(least));
        }
        if end.1.0 < 0.0 {
            let (mut from, mut to) = (before.0, end.0);
            if opens {
                from = 0.5 * to;
                while gap(from).0 <= 0.0 && from > 1e-9 * u {
                    (from, to) = (0.5 * from, from);
                }
            }
            if gap(from).0 <= 0.0 {
                return Some(from);
            }
            return root::bracketed(|u| gap(u).0, from, to);
        }
        before = after;
    }
    None
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
