//! A second run on its way past the states of the first: two runs may end alike and differ before, where a motion comes back to
//! a course of its own.

use std::iter::{Chain, Peekable};
use std::slice::Iter;

use super::error_estimate::MARGIN;
use super::result::ErrorEstimate;
use crate::engine::step::Step;

/// First steps of a run that are kept: 1 MB.
const FIRST_KEPT: usize = 4096;
/// Most of the later ones that are kept; then every other one goes.
const LATER_KEPT: usize = 128;

/// Steps of a run, for a second one to be compared with and to set out from.
#[derive(Clone, Debug, Default)]
pub(super) struct Checkpoints {
    pub first: Vec<Step>,
    /// One of 2^thinned steps.
    later: Vec<Step>,
    thinned: u32,
    passed: u64,
}

impl Checkpoints {
    pub fn pass(&mut self, step: &Step) {
        if self.first.len() < FIRST_KEPT {
            self.first.push(*step);
            return;
        }
        self.passed += 1;
        if self.later.len() == LATER_KEPT {
            let mut odd = false;
            self.later.retain(|_| {
                odd = !odd;
                !odd
            });
            self.thinned += 1;
        }
        if self.passed.is_multiple_of(1 << self.thinned) {
            self.later.push(*step);
        }
    }
}

/// The second run is compared at the ends of these steps.
pub(super) struct Compared<'a> {
    left: Peekable<Chain<Iter<'a, Step>, Iter<'a, Step>>>,
    /// Largest distances so far, rad and rad/s of the crank.
    farthest: [f64; 2],
}

impl<'a> Compared<'a> {
    pub fn with(checkpoints: &'a Checkpoints) -> Compared<'a> {
        let Checkpoints { first, later, .. } = checkpoints;
        Compared {
            left: first.iter().chain(later).peekable(),
            farthest: [0.0; 2],
        }
    }

    /// Compares the states within a step. `rate` is that of the crank angle with the coordinate, at one.
    pub fn pass(&mut self, step: &Step, rate: impl Fn(f64) -> f64) {
        while let Some(first) = self.left.next_if(|first| first.end.t <= step.end.t) {
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
        }
    }

    /// Error of the worst of these states and of the end, which is known.
    pub fn worst(&self, end: ErrorEstimate) -> ErrorEstimate {
        let [angle, speed] = self.farthest.map(|farthest| MARGIN * farthest);
        end.max(ErrorEstimate {
            theta_rad: angle,
            omega_rad_per_s: speed,
        })
    }
}
