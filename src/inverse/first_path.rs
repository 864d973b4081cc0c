//! Initial paths of the smoother's iterations.

use std::ops::Range;

use super::estimate::Estimate;
use super::grid::{Grid, NODE_ROTATION, Path};
use super::prior::{Prior, State, Unknown};
use super::problem::Problem;
use super::smoother::Smoothed;
use super::tone::{self, Carrier};
use crate::numeric::parallel;

/// Returns a path along crank angles, rad, with their slopes by differences.
pub(super) fn coarse(problem: &Problem<'_>, theta: &[f64]) -> Path {
    let (times, record) = (&problem.grid.times, &problem.record);
    let last = theta.len() - 1;
    let states = times.iter().enumerate().map(|(node, t)| {
        let next = problem.grid.first[node].clamp(1, last);
        let (a, b) = (record.times[next - 1], record.times[next]);
        let slope = (theta[next] - theta[next - 1]) / (b - a);
        [theta[next - 1] + slope * (t - a), slope, 0.0, 0.0, 0.0]
    });
    Path::whole(states.collect())
}

impl Problem<'_> {
    /// Returns the state of a prior at a time of a smoothed motion.
    fn state_of(&self, prior: Prior, from: &Estimate, t: f64) -> State {
        let [theta, omega, alpha] = from.motion();
        if prior.unknown == Unknown::Acceleration {
            return [theta, omega, alpha, from.state[3], 0.0];
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
        [theta, omega, unknown, 0.0, 0.0]
    }

    /// Returns the states of a prior along a smoothed motion, at ranges of nodes.
    pub fn path_of(&self, prior: Prior, from: &Smoothed, ranges: Vec<Range<usize>>) -> Path {
        let along = |range: &Range<usize>| {
            let first = range.start;
            parallel::list(range.len(), |k| {
                self.state_of(
                    prior,
                    &from.estimates[first + k],
                    self.grid.times[first + k],
                )
            })
        };
        Path {
            states: ranges.iter().flat_map(along).collect(),
            repeating: None,
            ranges,
        }
    }

    /// Returns the states of a smoothed motion along a smoothed motion without mechanics, at all nodes. These become blocks
    /// of samples where the prior leaves nothing but noise within a block.
    pub fn whole_path(&mut self, found: &Smoothed, from: &Smoothed) -> Path {
        let angles = from.estimates.iter().map(|estimate| estimate.state[0]);
        let corner = found.noise.corner.max(found.noise.speed_corner);
        let is_white = self.grid.block == 0.0 && found.noise.correlated.is_none();
        let blocks = Grid::in_blocks(&self.record.times, angles, NODE_ROTATION[0])
            .filter(|blocks| is_white && blocks.resolves(corner));
        let Some(blocks) = blocks else {
            return self.path_of(found.prior, from, self.all());
        };
        let states = parallel::list(blocks.len(), |k| {
            let t = blocks.times[k];
            self.state_of(found.prior, &self.at(from, t), t)
        });
        self.grid = blocks;
        Path::whole(states)
    }
}
