//! An accepted step: how it is taken, and as those who follow a run see it.

use super::run::{Halt, Runner};
use super::step::{Dense, Stages};
use super::{Contact, Finish, Phase, Sample};
use crate::numeric::root;

/// A part of the motion in one phase.
pub struct AcceptedStep<'a, const N: usize> {
    /// The phase.
    pub phase: Phase,
    /// State at its beginning; the first number is the time, s.
    pub start: [f64; N],
    /// State at its end.
    pub end: [f64; N],
    /// Rates and depth at its beginning.
    pub before: Sample<N>,
    /// Rates and depth at its end.
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

    /// The state at time t (s) inside it, of order 7.
    pub fn at(&mut self, t: f64) -> [f64; N] {
        if t <= self.start[0] {
            return self.start;
        }
        if t >= self.end[0] {
            return self.end;
        }
        let (stages, rates) = (self.stages, &mut self.rates);
        let dense = self.dense.get_or_insert_with(|| stages.dense(rates));
        let linear = (t - self.start[0]) / (self.end[0] - self.start[0]);
        let u = if (dense.at(linear)[0] - t).abs() <= 1e-12 * (self.end[0] - self.start[0]) {
            linear
        } else {
            // Steps whose independent variable is not the time.
            root::bracketed(|u| dense.at(u)[0] - t, 0.0, 1.0).unwrap_or(linear)
        };
        let mut y = dense.at(u);
        y[0] = t;
        y
    }
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    /// Takes a step in time as accepted.
    pub fn accept(&mut self, stages: Stages<N>, h: f64) -> Halt {
        let end = self.snapped(*stages.end(), h);
        self.accept_at(stages, end)
    }

    /// Takes a step in time as accepted, with its end.
    pub fn accept_at(&mut self, mut stages: Stages<N>, end: [f64; N]) -> Halt {
        let then = self.sample(None, &end);
        stages.set_last_rate(then.rates);
        self.accept_to(&stages, end, then)
    }

    /// The end of a step of length h, at the last time if it is that but for rounding.
    pub fn snapped(&self, mut end: [f64; N], h: f64) -> [f64; N] {
        if (self.until - end[0]).abs() <= 1e-10 * h {
            end[0] = self.until;
        }
        end
    }

    /// Takes a step in time as accepted, with its end and the rates there.
    pub fn accept_to(&mut self, stages: &Stages<N>, end: [f64; N], then: Sample<N>) -> Halt {
        let (model, phase, near) = (self.model, self.phase, self.near);
        let end = match phase {
            Phase::Release { .. } => model.receded(&self.y, &end),
            _ => end,
        };
        let mut rates = |_: f64, y: &[f64; N]| model.sample(&near, phase, None, y).rates;
        self.follow(stages, &mut rates, end, then)
    }

    /// Hands a step to the follower and goes to its end.
    pub fn follow(
        &mut self,
        stages: &Stages<N>,
        rates: &mut dyn FnMut(f64, &[f64; N]) -> [f64; N],
        end: [f64; N],
        then: Sample<N>,
    ) -> Halt {
        let mut stretch = AcceptedStep {
            phase: self.phase,
            start: self.y,
            end,
            before: self.now,
            after: then,
            stages,
            rates,
            dense: None,
        };
        self.stop_at_break(&mut stretch)?;
        self.steps += 1;
        let stop = (self.follower)(&mut stretch);
        (self.y, self.now) = (end, then);
        self.near = self.model.near_after(&self.near, &self.y);
        if stop { Err(Finish::Stopped) } else { Ok(()) }
    }
}
