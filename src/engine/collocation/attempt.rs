//! What a step is asked for, how that begins and ends, and its errors.

use super::super::step::Step;
use super::super::{Motion, NODES};
use super::state::State;
use super::step::Collocation;
use crate::numeric::gauss::legendre_series;

/// A step that holds.
pub struct Accepted {
    pub step: Step,
    /// The state at its end.
    pub next: State,
    /// The next step may be longer by this.
    pub factor: f64,
}

/// A step that does not hold.
#[derive(Clone, Copy, Debug)]
pub enum Failed {
    /// The next try is to have this part of its length.
    TooLong(f64),
    /// Something is hidden between its nodes: it has to end at this part of it.
    Hides(f64),
    /// The step is too long and seems to meet a corner at a part `at` of it; the one after the corner is to have `factor` times its length.
    Meets { at: f64, factor: f64 },
}

/// A step that is to be tried.
#[derive(Clone, Copy, Debug)]
pub struct Try {
    /// Length, s.
    pub h: f64,
    /// Whether it begins and ends at a corner, where the acceleration may jump.
    pub corners: [bool; 2],
}

impl Collocation<'_> {
    /// Times, and the first guess: the accelerations of the guide, those of the last step continued, or that of the start.
    pub(super) fn prepare(&mut self, state: &State, h: f64) {
        let batch = &mut self.batch;
        batch.turns = state.turns;
        let timed = self.motion.depends_on_time();
        for (i, c) in self.tableau.nodes.iter().enumerate() {
            batch.t[i] = state.t + c * h;
            if timed {
                batch.of_time[i] = self.motion.of_time(batch.t[i]);
            }
        }
        batch.alpha = match (guided(self.guide, &batch.t), &self.last) {
            (Some(alpha), _) => alpha,
            (None, None) => [self.alpha; NODES],
            (None, Some((length, coefficients))) => {
                let ratio = 2.0 * h / length;
                legendre_series(coefficients, self.tableau.nodes.map(|c| 1.0 + ratio * c))
            }
        };
        self.update(state, h);
    }
}

/// Accelerations (rad/s²) of a known run at times (s) in rising order; none where it has no step, and of steps that are not as exact
/// inside as at their ends.
fn guided(guide: &[Step], t: &[f64; NODES]) -> Option<[f64; NODES]> {
    let past = guide.partition_point(|step| step.end.t < t[0]);
    let mut steps = guide[past..].iter();
    let mut step = steps.next()?;
    let mut alpha = [0.0; NODES];
    for (alpha, t) in alpha.iter_mut().zip(t) {
        while step.end.t < *t {
            step = steps.next()?;
        }
        let knows = step.start.t <= *t && step.has_polynomial();
        *alpha = knows.then(|| step.acceleration_at(*t))?;
    }
    Some(alpha)
}

/// Part of a step over which the change of the acceleration with time is taken.
const TIME_APART: f64 = 1e-3;

impl Collocation<'_> {
    /// An error of angle and speed in units of what is allowed.
    pub(super) fn in_units(&self, state: &State, angle: f64, speed: f64) -> f64 {
        let angle = angle / (1.0 + state.theta.abs());
        let speed = speed / (1.0 + state.omega.abs());
        angle.max(speed) / self.tolerance
    }

    /// Rounding of the accelerations of a step. They are those of rounded angles, and steep where the position is near to a
    /// limit.
    pub(super) fn rounding(&self, state: &State, h: f64, coefficients: &[f64; NODES]) -> f64 {
        let size = coefficients.iter().map(|c| c.abs()).sum::<f64>();
        let variation = size - coefficients[0].abs();
        let travel = h * state.omega.abs() + 0.5 * h * h * size;
        let steepness = 2.0 * variation / travel.max(f64::MIN_POSITIVE);
        let of_angles = 4.0 * (1.0 + state.theta.abs()) * steepness;
        f64::EPSILON * (8.0 * size + of_angles) + self.by_time
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
