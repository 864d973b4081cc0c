//! Initial paths of the smoother's iterations.

use std::ops::Range;

use super::estimate::Estimate;
use super::grid::{Grid, Path};
use super::model::prior::{Prior, State, Unknown, plain_state};
use super::model::tone::{self, Carrier};
use super::problem::Problem;
use super::smoother::Smoothed;
use crate::numeric::parallel;

/// Returns a path along crank angles, rad, of samples at times, s, with their slopes by differences.
pub(super) fn coarse(grid: &Grid, times: &[f64], theta: &[f64]) -> Path {
    let last = theta.len() - 1;
    let states = grid.times.iter().zip(&grid.first).map(|(t, next)| {
        let next = *next.clamp(&1, &last);
        let (a, b) = (times[next - 1], times[next]);
        let slope = (theta[next] - theta[next - 1]) / (b - a);
        plain_state([theta[next - 1] + slope * (t - a), slope, 0.0])
    });
    Path::whole(states.collect())
}

impl Problem<'_> {
    /// Returns the state of a prior at a time of a smoothed motion.
    fn state_of(&self, prior: Prior, from: &Estimate, t: f64) -> State {
        let [theta, omega, alpha] = from.motion();
        if prior.unknown == Unknown::Acceleration {
            let mut state = plain_state([theta, omega, alpha]);
            state[3] = from.state[3];
            return state;
        }
        let terms = self.equation.terms(theta);
        let tones = tone::sum(&self.record.tones, Carrier::Torque, t);
        let t = self.record.origin + t;
        let known = self.equation.loads().value(t, theta, omega, &terms.pose);
        let torque = self.equation.generalized_force(&terms, omega, alpha)
            - known.generalized(terms.pose.dx)
            - tones;
        let (r, dx) = (self.equation.linkage().r, terms.pose.dx);
        let unknown = match prior.unknown {
            Unknown::Force => torque * dx / (dx * dx + 0.01 * r * r),
            _ => torque,
        };
        plain_state([theta, omega, unknown])
    }

    /// Returns the states of a prior along a motion that was smoothed at all nodes or at these, at ranges of nodes.
    pub fn path_of(&self, prior: Prior, from: &Smoothed, ranges: Vec<Range<usize>>) -> Path {
        let nodes: Vec<usize> = ranges.iter().flat_map(Clone::clone).collect();
        let is_whole = from.estimates.len() == self.grid.len();
        let states = parallel::list(nodes.len(), |k| {
            let estimate = &from.estimates[if is_whole { nodes[k] } else { k }];
            match prior == from.prior {
                true => estimate.state,
                false => {
                    let mut state = self.state_of(prior, estimate, self.grid.times[nodes[k]]);
                    if prior.is_alike(from.prior) {
                        let constants = &estimate.state[from.prior.diffuse()..][..prior.powers];
                        state[prior.diffuse()..][..prior.powers].copy_from_slice(constants);
                    }
                    state
                }
            }
        });
        let repeating = from.repeating.clone();
        Path {
            states,
            repeating: repeating.filter(|_| prior == from.prior),
            ranges,
        }
    }
}
