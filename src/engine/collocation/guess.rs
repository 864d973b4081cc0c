//! The accelerations that the sweeps over a step begin with.

use super::super::step::Step;
use super::super::{Motion, NODES};
use super::series::legendre;
use super::state::State;
use super::step::Collocation;

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
                legendre(coefficients, self.tableau.nodes.map(|c| 1.0 + ratio * c))
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
