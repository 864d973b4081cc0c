//! A second run on its way past the states of the first: two runs may end alike and differ before, where a motion comes back to
//! a course of its own.

use super::error_estimate::MARGIN;
use super::result::ErrorEstimate;
use crate::engine::step::Step;

/// First steps of a run that are kept, for a second one to be compared with and to set out from: 1 MB.
pub(super) const STEPS_KEPT: usize = 4096;

/// The second run is compared at the ends of steps of the first.
pub(super) struct Compared<'a> {
    first: &'a [Step],
    next: usize,
    /// Largest distances so far, rad and rad/s of the crank.
    farthest: [f64; 2],
}

impl<'a> Compared<'a> {
    pub fn with(first: &'a [Step]) -> Compared<'a> {
        Compared {
            first,
            next: 0,
            farthest: [0.0; 2],
        }
    }

    /// Compares the states within a step. `rate` is that of the crank angle with the coordinate, at one.
    pub fn pass(&mut self, step: &Step, rate: impl Fn(f64) -> f64) {
        while let Some(first) = self.first.get(self.next)
            && first.end.t <= step.end.t
        {
            let node = &first.end;
            if node.t >= step.start.t {
                let (theta, omega) = step.at(node.t);
                let way = step.angle(theta).minus(first.angle(node.theta));
                let apart = [way, omega - node.omega];
                let rate = rate(node.theta);
                for (farthest, apart) in self.farthest.iter_mut().zip(apart) {
                    *farthest = farthest.max((rate * apart).abs());
                }
            }
            self.next += 1;
        }
    }

    /// Error of the worst of these states and of the end, which is known; none where not all of the run was kept.
    pub fn worst(&self, end: ErrorEstimate) -> Option<ErrorEstimate> {
        let [angle, speed] = self.farthest.map(|farthest| MARGIN * farthest);
        let worst = end.max(ErrorEstimate {
            theta_rad: angle,
            omega_rad_per_s: speed,
        });
        (self.first.len() < STEPS_KEPT).then_some(worst)
    }
}
