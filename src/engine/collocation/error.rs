//! Errors of a step, in units of what is allowed, and what of them is rounding.

use super::super::{Motion, NODES};
use super::attempt::Failed;
use super::series::rounding;
use super::state::State;
use super::step::Collocation;

/// Part of a step over which the change of the acceleration with time is taken.
const TIME_APART: f64 = 1e-3;

impl Collocation<'_> {
    /// An error of angle and speed in units of what is allowed.
    pub(super) fn in_units(&self, state: &State, angle: f64, speed: f64) -> f64 {
        let angle = angle / (1.0 + state.theta.abs());
        let speed = speed / (1.0 + state.omega.abs());
        angle.max(speed) / self.tolerance
    }

    pub(super) fn rounding(&self, state: &State, h: f64, coefficients: &[f64; NODES]) -> f64 {
        rounding(state, h, coefficients) + self.by_time
    }

    /// A step that does not hold, with what the rounding of its times does to the acceleration: no shorter step mends it.
    pub(super) fn too_long(&mut self, h: f64, factor: f64) -> Failed {
        if self.motion.depends_on_time() {
            let apart = TIME_APART * h;
            let mut later = self.batch;
            later.t = later.t.map(|t| t + apart);
            later.of_time = later.t.map(|t| self.motion.of_time(t));
            self.motion.fill(&mut later);
            let slope = |i: usize| ((later.alpha[i] - self.batch.alpha[i]) / apart).abs();
            let steepest = (0..NODES).map(slope).fold(0.0, f64::max);
            self.by_time = f64::EPSILON * later.t[NODES - 1].abs() * steepest;
        }
        Failed::TooLong(factor)
    }

    /// Error of the motion inside the step: what the first term beyond the last would add.
    pub(super) fn error(&self, state: &State, h: f64, coefficients: &[f64; NODES]) -> f64 {
        let [.., a, b] = coefficients;
        self.error_of(state, h, a.abs().max(b.abs()), coefficients)
    }

    /// What a term of this size beyond the last would add; rounding of the acceleration is no such term.
    pub(super) fn error_of(
        &self,
        state: &State,
        h: f64,
        term: f64,
        coefficients: &[f64; NODES],
    ) -> f64 {
        let term = (term.abs() - self.rounding(state, h, coefficients)).max(0.0);
        let n = 2.0 * NODES as f64;
        self.in_units(state, h * h * term / (n * n), h * term / n)
    }
}
