//! Accepted step: acceptance, and the view of the observer of a run on it.

use super::dop853::{Dense, Stages};
use super::run::{Halt, Runner};
use super::{Contact, Phase, Sample};
use crate::engine::run_in_time::Finish;
use crate::numeric::root;

/// Accepted step of the motion in one phase.
pub struct AcceptedStep<'a, const N: usize> {
    /// Phase of the contact.
    pub phase: Phase,
    /// State at the start of the step; the first number is the time, s.
    pub start: [f64; N],
    /// State at the end of the step.
    pub end: [f64; N],
    /// Rates and depth at the start of the step.
    pub before: Sample<N>,
    /// Rates and depth at the end of the step.
    pub after: Sample<N>,
    pub(super) stages: &'a Stages<N>,
    pub(super) rates: &'a mut dyn FnMut(f64, &[f64; N]) -> [f64; N],
    pub(super) dense: Option<Dense<N>>,
}

impl<const N: usize> AcceptedStep<'_, N> {
    /// Length, s.
    pub fn length(&self) -> f64 {
        self.end[0] - self.start[0]
    }

    /// Returns the state at time t (s) inside the step, of order 7.
    pub fn at(&mut self, t: f64) -> [f64; N] {
        if t <= self.start[0] {
            return self.start;
        }
        if t >= self.end[0] {
            return self.end;
        }
        let (length, stages, rates) = (self.length(), self.stages, &mut self.rates);
        let dense = self.dense.get_or_insert_with(|| stages.dense(rates));
        let linear = (t - self.start[0]) / length;
        let off = |u: f64| dense.number(0, u) - t;
        let u = if off(linear).abs() <= 1e-12 * length {
            linear
        } else {
            // The independent variable of this step is not time.
            root::bracketed(off, 0.0, 1.0).unwrap_or(linear)
        };
        let mut y = dense.at(u);
        y[0] = t;
        y
    }
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    /// Accepts a step in time with its corrected end.
    pub fn accept_at(&mut self, mut stages: Stages<N>, end: [f64; N]) -> Halt {
        let then = self.sample(None, &end);
        stages.set_last_rate(then.rates);
        self.accept_to(&stages, end, then)
    }

    /// Returns the end of a step of length h (s), set to the last time if it differs by rounding only.
    pub fn snapped(&self, mut end: [f64; N], h: f64) -> [f64; N] {
        if (self.until - end[0]).abs() <= 1e-10 * h {
            end[0] = self.until;
        }
        end
    }

    /// Accepts a step in time with its corrected end and the rates there.
    pub fn accept_to(&mut self, stages: &Stages<N>, end: [f64; N], then: Sample<N>) -> Halt {
        let (model, phase, near) = (self.model, self.phase, self.near);
        let end = match phase {
            Phase::Release { .. } => model.receded(&self.y, &end),
            _ => end,
        };
        let mut rates = |_: f64, y: &[f64; N]| model.sample(&near, phase, None, y).rates;
        self.follow(stages, &mut rates, end, then)
    }

    /// Hands a step to the observer and moves on to its end.
    pub fn follow(
        &mut self,
        stages: &Stages<N>,
        rates: &mut dyn FnMut(f64, &[f64; N]) -> [f64; N],
        end: [f64; N],
        then: Sample<N>,
    ) -> Halt {
        let mut step = AcceptedStep {
            phase: self.phase,
            start: self.y,
            end,
            before: self.now,
            after: then,
            stages,
            rates,
            dense: None,
        };
        self.stop_at_break(&mut step)?;
        self.steps += 1;
        let stop = (self.observer)(&mut step);
        (self.y, self.now) = (end, then);
        self.near = self.model.near_after(&self.near, &self.y);
        if stop {
            Err(Some(Finish::Stopped))
        } else {
            Ok(())
        }
    }
}
