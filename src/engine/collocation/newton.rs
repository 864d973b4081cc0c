//! Simplified Newton's method on a step, for accelerations so steep in the speed that sweeps do not converge (Hairer,
//! Wanner, Solving Ordinary Differential Equations II, 2nd ed., section IV.8).

use nalgebra::{Const, LU, SMatrix, SVector};

use super::super::step::Step;
use super::super::{Batch, Counted, NODES};
use super::state::State;
use super::step::Collocation;
use super::tableau::Tableau;
use crate::numeric::median::range;

/// LU factors of 1 − h ∂f/∂ω A − h² ∂f/∂θ Â, where A integrates accelerations up to the nodes once, and Â twice.
pub(super) struct Newton {
    factors: LU<f64, Const<NODES>, Const<NODES>>,
    /// Derivative ∂f/∂ω at the last node, 1/s.
    pub loss: f64,
}

impl Newton {
    /// Factorizes the matrix from difference quotients of f at the states of a batch with known accelerations. None if
    /// it is not finite, or f is not steep in the speed.
    pub fn new(motion: &Counted<'_>, batch: &Batch, tableau: &Tableau, h: f64) -> Option<Newton> {
        let by_speed = slopes(motion, batch, |batch| &mut batch.omega);
        let by_angle = slopes(motion, batch, |batch| &mut batch.theta);
        let matrix = SMatrix::<f64, NODES, NODES>::from_fn(|i, j| {
            let once = h * by_speed[i] * tableau.speed[j][i];
            let twice = h * h * by_angle[i] * tableau.angle[j][i];
            f64::from(u8::from(i == j)) - once - twice
        });
        let usable = matrix.sum().is_finite() && is_steep(&by_speed, h);
        usable.then(|| Newton {
            factors: matrix.lu(),
            loss: by_speed[NODES - 1],
        })
    }

    /// Returns the number of time constants of the loss in a step of length h (s), at least one.
    pub fn steepness(&self, h: f64) -> f64 {
        (h * self.loss.abs()).max(1.0)
    }

    /// Converts the change made by a sweep to the Newton correction.
    pub fn correct(&self, before: &[f64; NODES], alpha: &mut [f64; NODES]) {
        let change = SVector::<f64, NODES>::from_fn(|i, _| alpha[i] - before[i]);
        if let Some(change) = self.factors.solve(&change) {
            *alpha = std::array::from_fn(|i| before[i] + change[i]);
        }
    }
}

impl Collocation<'_> {
    /// True if the acceleration is steep in the speed at a state, in steps of length h (s).
    pub(super) fn is_steep_at(&self, state: &State, h: f64) -> bool {
        let apart = f64::EPSILON.sqrt() * state.omega.abs().max(1.0);
        let beside = self
            .motion
            .acceleration(state.t, state.angle(), state.omega + apart);
        h * (beside - self.alpha).abs() > apart
    }

    /// Corrects the speed at the end of a step under a steep loss (1/s) by the residual of the acceleration there: a
    /// component that the loss would damp at once persists in Gauss methods (A-stable, not L-stable).
    pub(super) fn with_loss(&mut self, next: State, step: &Step, loss: f64) -> State {
        let next = next.faster((step.end.alpha - self.alpha) / loss);
        self.alpha = self.motion.acceleration(next.t, next.angle(), next.omega);
        next
    }
}

/// True if sweeps do not converge for these ∂f/∂ω, 1/s: |h ∂f/∂ω| > 1, and the slopes differ by at most half of the
/// largest, as the simplified method presumes.
fn is_steep(slopes: &[f64; NODES], h: f64) -> bool {
    let (low, high) = range(slopes);
    let largest = low.abs().max(high.abs());
    h * largest > 1.0 && high - low <= 0.5 * largest
}

/// Computes ∂f at the nodes with respect to a part of the state, by forward differences.
fn slopes(
    motion: &Counted<'_>,
    batch: &Batch,
    part: fn(&mut Batch) -> &mut [f64; NODES],
) -> [f64; NODES] {
    let mut beside = *batch;
    let values = *part(&mut beside);
    let largest = values
        .iter()
        .fold(1.0f64, |most, value| most.max(value.abs()));
    let apart = f64::EPSILON.sqrt() * largest;
    *part(&mut beside) = values.map(|value| value + apart);
    motion.fill(&mut beside);
    std::array::from_fn(|i| (beside.alpha[i] - batch.alpha[i]) / apart)
}
