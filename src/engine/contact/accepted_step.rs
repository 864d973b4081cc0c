//! An accepted step as those who follow a run see it.

use super::step::{Dense, Stages};
use super::{Phase, Sample};
use crate::numeric::root;

/// A part of the motion in one phase.
pub struct Stretch<'a, const N: usize> {
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

impl<const N: usize> Stretch<'_, N> {
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
