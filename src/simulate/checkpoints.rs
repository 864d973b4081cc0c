//! States of a run on its way, for a second run to be compared with: two runs may end alike and differ before, where a motion
//! comes back to a course of its own.

use super::result::ErrorEstimate;
use crate::engine::step::{Node, Step};
use crate::numeric::angle::Angle;

/// Most states that are kept; then every other one goes.
const STATES_KEPT: usize = 128;

/// First steps that are kept whole: 1 MB.
const STEPS_KEPT: usize = 4096;

/// Ends of steps spread over a run.
#[derive(Clone, Debug)]
pub(super) struct Checkpoints {
    kept: Vec<Checkpoint>,
    /// One of so many steps is kept.
    stride: u64,
    steps: u64,
    first: Vec<Step>,
}

#[derive(Clone, Copy, Debug)]
struct Checkpoint {
    turns: f64,
    node: Node,
}

impl Default for Checkpoints {
    fn default() -> Checkpoints {
        Checkpoints {
            kept: Vec::new(),
            stride: 1,
            steps: 0,
            first: Vec::new(),
        }
    }
}

impl Checkpoints {
    /// Takes the end of a step, and the whole step if it is one of the first.
    pub fn pass(&mut self, step: &Step) {
        self.steps += 1;
        if self.first.len() < STEPS_KEPT {
            self.first.push(*step);
        }
        if !self.steps.is_multiple_of(self.stride) {
            return;
        }
        if self.kept.len() == STATES_KEPT {
            let mut odd = false;
            self.kept.retain(|_| {
                odd = !odd;
                !odd
            });
            self.stride *= 2;
        }
        if self.steps.is_multiple_of(self.stride) {
            self.kept.push(Checkpoint {
                turns: step.turns,
                node: step.end,
            });
        }
    }

    /// The first steps.
    pub fn first(&self) -> &[Step] {
        &self.first
    }

    /// For a second run.
    pub fn compared(&self) -> Compared<'_> {
        Compared {
            left: self.kept.iter(),
            next: self.kept.first(),
            farthest: [0.0; 2],
        }
    }
}

/// A second run on its way past the states of the first.
pub(super) struct Compared<'a> {
    left: std::slice::Iter<'a, Checkpoint>,
    next: Option<&'a Checkpoint>,
    /// Largest distances so far, rad and rad/s of the crank.
    farthest: [f64; 2],
}

impl Compared<'_> {
    /// Compares the states within a step. `rate` is that of the crank angle with the coordinate, at one.
    pub fn pass(&mut self, step: &Step, rate: impl Fn(f64) -> f64) {
        while let Some(Checkpoint { turns, node }) =
            self.next.filter(|next| next.node.t <= step.end.t)
        {
            if node.t >= step.start.t {
                let (theta, omega) = step.at(node.t);
                let first = Angle {
                    turns: *turns,
                    rest: node.theta,
                };
                let apart = [step.angle(theta).minus(first), omega - node.omega];
                let rate = rate(node.theta);
                for (farthest, apart) in self.farthest.iter_mut().zip(apart) {
                    *farthest = farthest.max((rate * apart).abs());
                }
            }
            self.next = self.left.next();
        }
    }

    /// Error of the worst of these states; that of the end is known. What is stated is larger than distances by a margin.
    pub fn worst(&self, end: ErrorEstimate, margin: f64) -> ErrorEstimate {
        let [angle, speed] = self.farthest.map(|farthest| margin * farthest);
        end.max(ErrorEstimate {
            theta_rad: angle,
            omega_rad_per_s: speed,
        })
    }
}
