//! Attempted step: first guess, outcome and error estimate.

use super::super::NODES;
use super::super::resolution::Unresolved;
use super::super::step::Step;
use super::guide::guided;
use super::state::State;
use super::step::Collocation;
use crate::numeric::gauss::legendre_series;

/// Accepted step.
pub struct Accepted {
    pub step: Step,
    /// State at the end of the step.
    pub next: State,
    /// Ratio of the next step to this one, by the error.
    pub factor: f64,
}

/// Reason to reject a step.
#[derive(Clone, Copy, Debug)]
pub enum Rejection {
    /// Step too long; ratio of the next try to this length.
    TooLong(f64),
    /// Load missed between the nodes; the step has to end there, or before a pole.
    Unresolved(Unresolved),
    /// Step too long, with a corner at the fraction `at`; the step after the corner has `factor` times the length.
    Corner { at: f64, factor: f64 },
}

impl Rejection {
    /// Rejection of a step with an acceleration that is not finite.
    pub const NOT_FINITE: Rejection = Rejection::TooLong(0.25);
}

impl Collocation<'_> {
    /// Sets times and first guess: accelerations of the guide, of the last step extrapolated, or of the start.
    pub(super) fn prepare(&mut self, state: &State, h: f64) {
        let batch = &mut self.batch;
        batch.turns = state.turns;
        batch.t = self.tableau.nodes.map(|c| state.t + c * h);
        if self.motion.depends_on_time() {
            batch.of_time = self.motion.of_times(&batch.t);
        }
        batch.alpha = match (guided(self.guide, &batch.t), &self.last) {
            (Some(alpha), _) => alpha,
            // A steep acceleration carries errors of the speed, magnified: the speed stays near to where it vanishes.
            _ if self.steep => [0.0; NODES],
            (None, None) => [self.alpha; NODES],
            (None, Some((length, coefficients))) => {
                let ratio = 2.0 * h / length;
                legendre_series(coefficients, self.tableau.nodes.map(|c| 1.0 + ratio * c))
            }
        };
        self.update(state, h);
    }

    /// Scales an error of angle (rad) and speed (rad/s) by the tolerance.
    pub(super) fn in_units(&self, state: &State, angle: f64, speed: f64) -> f64 {
        let angle = angle / (1.0 + state.theta.abs());
        let speed = speed / (1.0 + state.omega.abs());
        angle.max(speed) / self.tolerance
    }

    /// Estimates the rounding error of the accelerations of a step, rad/s², from the rounded angles, near which the
    /// acceleration is steep if the position is close to a limit.
    pub(super) fn rounding(&self, state: &State, h: f64, coefficients: &[f64; NODES]) -> f64 {
        let size = coefficients.iter().map(|c| c.abs()).sum::<f64>();
        let variation = size - coefficients[0].abs();
        let travel = h * state.omega.abs() + 0.5 * h * h * size;
        let steepness = 2.0 * variation / travel.max(f64::MIN_POSITIVE);
        let of_angles = 4.0 * (1.0 + state.theta.abs()) * steepness;
        f64::EPSILON * (8.0 * size + of_angles) + self.by_time
    }

    /// Returns [`Collocation::rounding_of_times`] for accelerations that vary in time only, without an evaluation.
    pub(super) fn possible_rounding_of_times(
        &self,
        state: &State,
        h: f64,
        [_, coefficients @ ..]: &[f64; NODES],
    ) -> f64 {
        let variation = coefficients.iter().map(|c| c.abs()).sum::<f64>();
        self.of_rounded_times(state.t + h, 2.0 * variation / h)
    }

    /// Bounds the error of the polynomial of the accelerations at the ends of a step of length h (s) due to its rounded
    /// times, rad/s²: no shorter step reduces it.
    pub(super) fn rounding_of_times(&self, h: f64) -> f64 {
        // Time shift of the difference quotient of the acceleration: a small fraction of the step.
        let apart = 1e-3 * h;
        let mut later = self.batch;
        later.t = later.t.map(|t| t + apart);
        later.of_time = self.motion.of_times(&later.t);
        self.motion.fill(&mut later);
        let slope = |i: usize| ((later.alpha[i] - self.batch.alpha[i]) / apart).abs();
        let steepest = (0..NODES).map(slope).fold(0.0, f64::max);
        self.of_rounded_times(later.t[NODES - 1], steepest)
    }

    /// Bounds the error of the polynomial of the accelerations, of this slope (rad/s³) at most, at rounded times near t.
    fn of_rounded_times(&self, t: f64, slope: f64) -> f64 {
        self.tableau.lebesgue * f64::EPSILON * t.abs() * slope
    }

    /// Judges a step by its last Legendre term, rad/s²: returns its error in units of the tolerance, and the ratio of the
    /// next step to this one.
    pub(super) fn judged(
        &mut self,
        state: &State,
        h: f64,
        last_term: f64,
        coefficients: &[f64; NODES],
    ) -> (f64, f64) {
        // The error grows as the power NODES of the length: the next step aims at 1 % of the tolerance.
        let next_factor = |error: f64| 0.7 * error.max(1e-20).powf(-1.0 / NODES as f64);
        let error = self.error(state, h, last_term, coefficients);
        let factor = next_factor(error);
        let may_be_rounding =
            || last_term <= self.possible_rounding_of_times(state, h, coefficients);
        let shrinks = || error > 1.0 || factor < 1.0 && may_be_rounding();
        if !self.motion.depends_on_time() || !shrinks() {
            return (error, factor);
        }
        self.by_time = self.rounding_of_times(h);
        let error = self.error(state, h, last_term, coefficients);
        // What is left of a term in its rounding says little of how much longer a step may be.
        (error, next_factor(error).min(1.0 / factor))
    }

    /// Returns the error due to a Legendre term (rad/s²) beyond the last, less the rounding error of accelerations.
    pub(super) fn error(
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

/// Returns the larger of the last two Legendre coefficients, rad/s²: the error of the motion inside a step.
pub(super) fn last_term([.., a, b]: &[f64; NODES]) -> f64 {
    a.abs().max(b.abs())
}
