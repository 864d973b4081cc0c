//! Comparison of a second run with states of the first: runs that return to one course may agree only at the end.

use std::iter::{Chain, Peekable};
use std::slice::Iter;

use super::result::ErrorEstimate;
use super::second_run::MARGIN;
use crate::engine::step::Step;

/// Number of first steps of a run that are kept: 1 MB.
const FIRST_KEPT: usize = 4096;
/// Largest number of later steps that are kept; when it is reached, every other one is dropped.
const LATER_KEPT: usize = 128;

/// Steps of a run, kept for comparison with a second run and as a predictor for it.
#[derive(Clone, Debug, Default)]
pub(super) struct Checkpoints {
    pub first: Vec<Step>,
    /// Every 2^thinned-th of the later steps.
    later: Vec<Step>,
    thinned: u32,
    passed: u64,
}

impl Checkpoints {
    /// Takes a step of the first run.
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

/// Comparison of a second run with the checkpoints of the first, at the ends of their steps.
pub(super) struct Compared<'a> {
    left: Peekable<Chain<Iter<'a, Step>, Iter<'a, Step>>>,
    /// Largest differences up to now: crank angle, rad, and crank speed, rad/s.
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

    /// Compares states inside a step of the second run. `rate`: derivative of the crank angle at a coordinate.
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

    /// Returns the larger of the known error at the end and the errors at the checkpoints.
    pub fn worst(&self, end: ErrorEstimate) -> ErrorEstimate {
        let [angle, speed] = self.farthest.map(|farthest| MARGIN * farthest);
        end.max(ErrorEstimate {
            theta_rad: angle,
            omega_rad_per_s: speed,
        })
    }
}
