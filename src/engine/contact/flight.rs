//! Phases without force: free flight until the gap closes, and release from an indentation.

use std::cell::{Cell, OnceCell};

use super::dop853::{Dense, Stages};
use super::first_zero::{Node, first_zero};
use super::run::{Halt, Runner};
use super::{Contact, Phase, Sample};
use crate::engine::PIECES;
use crate::numeric::root;

/// Largest correction of the end of a step by one step of the midpoint rule, as a fraction of the step: its error, of
/// third order, is 1e-9 of that of the rule over the whole step.
pub(super) const END_CORRECTION: f64 = 1e-3;

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    pub(super) fn fly(&mut self) -> Halt {
        let (model, near) = (self.model, self.near);
        let before = model.gap(&near, &self.y, &self.now.rates);
        // Twice the time in which a parabola closes, so that the closing lies inside the step.
        let longest =
            (self.settings.share * 2.0 * closes_after(before)).max(END_CORRECTION * self.flight_h);
        self.h = self.flight_h;
        let (mut stages, h) = self.controlled_step(longest)?;
        self.flight_h = self.h;
        let node = |u: f64, [value, rate, bend]: [f64; 3]| Node {
            u,
            value,
            rate: h * rate,
            curvature: h * h * bend,
        };
        let end = self.snapped(stages.end, h);
        let then = self.sample(None, &end);
        stages.set_last_rate(then.rates);
        let ends = [
            node(0.0, before),
            node(1.0, model.gap(&near, &end, &then.rates)),
        ];
        let (evaluations, dense) = (Cell::new(0), OnceCell::new());
        let rates = |y: &[f64; N]| {
            evaluations.set(evaluations.get() + 1);
            model.sample(&near, Phase::Flight, None, y).rates
        };
        let inside = || dense.get_or_init(|| stages.dense(&mut |_, y| rates(y)));
        let at = |u: f64| {
            let y = inside().at(u);
            node(u, model.gap(&near, &y, &rates(&y)))
        };
        let value = |u: f64| model.gap(&near, &inside().at(u), &then.rates)[0];
        let closing = first_zero(&at, &value, ends);
        self.evaluations += evaluations.get();
        let Some(u) = closing else {
            return self.accept_to(&stages, end, then);
        };
        self.cut(u * h)?;
        let approach = self.model.approach(self.now.depth_rate);
        self.enter(Phase::Contact { approach });
        Ok(())
    }

    pub(super) fn recede(&mut self, approach: f64) -> Halt {
        let (mut stages, h) = self.controlled_step(f64::INFINITY)?;
        let (dense, then) = self.inside(&mut stages);
        let model = self.model;
        let depth = |u: f64| depth(model, self.phase, &dense.at(u));
        let apart = first_sign_change(|u| depth(u).0);
        let pressed = first_sign_change(|u| -model.pressing(approach, depth(u).1));
        if let Some(u) = apart.filter(|apart| pressed.is_none_or(|pressed| *apart <= pressed)) {
            self.cut(u * h)?;
            self.enter(Phase::Flight);
            Ok(())
        } else if let Some(u) = pressed {
            self.cut_at(u * h)?;
            self.enter(Phase::Contact { approach });
            Ok(())
        } else {
            let end = self.snapped(stages.end, h);
            self.accept_to(&stages, end, then)
        }
    }

    /// Computes the dense output of a step, and rates and depth at its end.
    pub(super) fn inside(&mut self, stages: &mut Stages<N>) -> (Dense<N>, Sample<N>) {
        let (model, phase) = (self.model, self.phase);
        let near = self.near;
        let then = self.sample(None, &stages.end);
        stages.set_last_rate(then.rates);
        self.evaluations += 3;
        let mut rates = |_: f64, y: &[f64; N]| model.sample(&near, phase, None, y).rates;
        (stages.dense(&mut rates), then)
    }

    /// Accepts the first part of a step, of length h, s.
    pub(super) fn cut_at(&mut self, h: f64) -> Halt {
        let stages = self.try_step(h);
        let end = self.snapped(stages.end, h);
        self.accept_at(stages, end)
    }

    /// Accepts the first part of a step, about h (s) long, up to the zero of the gap, by Newton's method.
    fn cut(&mut self, h: f64) -> Halt {
        let stages = self.try_step(h);
        let mut end = stages.end;
        for _ in 0..3 {
            let [gap, rate, _] = self.model.gap(&self.near, &end, &self.now.rates);
            let dt = -gap / rate;
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

/// Returns the time, s, after which a gap (m) with its first two derivatives in time closes, if the second is constant.
fn closes_after([gap, rate, bend]: [f64; 3]) -> f64 {
    let gap = gap.max(0.0);
    let square = rate * rate - 2.0 * bend * gap;
    if square < 0.0 || (rate >= 0.0 && bend >= 0.0) {
        f64::INFINITY
    } else if rate < 0.0 {
        2.0 * gap / (square.sqrt() - rate)
    } else {
        (rate + square.sqrt()) / -bend
    }
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
