//! Nodes of a path, and the path along them.

use std::f64::consts::TAU;
use std::ops::Range;

use super::measurement_model::Turning;
use super::model::prior::State;
use super::model::repeating::Repeating;
use super::scales::root_mean_square;
use crate::numeric::hermite::between;

/// Nodes of the path with their samples.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// Times, s.
    pub times: Vec<f64>,
    /// Index of the first sample of each node, then the number of samples: node k has `first[k]..first[k + 1]`.
    pub first: Vec<usize>,
}

/// Nominal path of a linear model.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// The nodes along which it is known, rising.
    pub ranges: Vec<Range<usize>>,
    /// State at each of these nodes.
    pub states: Vec<State>,
    /// Torque that repeats, as far as it is known.
    pub repeating: Option<Repeating>,
}

/// Motion along nodes.
#[derive(Clone, Debug)]
pub(super) struct Course<'a> {
    pub grid: &'a Grid,
    /// The first node.
    pub first: usize,
    /// θ (rad), ω (rad/s), θ̈ (rad/s²) at each.
    pub motion: Vec<[f64; 3]>,
}

impl Path {
    /// A path along all nodes.
    pub fn whole(states: Vec<State>) -> Path {
        Path {
            ranges: std::iter::once(0..states.len()).collect(),
            states,
            repeating: None,
        }
    }

    /// The states at some nodes of one of its ranges.
    pub fn part(&self, nodes: &Range<usize>) -> &[State] {
        let mut before = 0;
        for range in &self.ranges {
            if range.contains(&nodes.start) {
                before += nodes.start - range.start;
                break;
            }
            before += range.len();
        }
        &self.states[before..before + nodes.len()]
    }

    /// Returns the path along some nodes of its ranges only.
    pub fn along(&self, ranges: Vec<Range<usize>>) -> Path {
        let parts = ranges.iter().map(|range| self.part(range));
        Path {
            states: parts.flatten().copied().collect(),
            repeating: self.repeating.clone(),
            ranges,
        }
    }

    /// Returns the unit of the speed in a torque that repeats, rad/s: the root mean square where none is known yet.
    pub fn speed(&self) -> f64 {
        if let Some(known) = &self.repeating {
            return known.speed;
        }
        root_mean_square(self.states.iter().map(|state| state[1]))
    }

    /// The nodes with their states.
    pub fn nodes(&self) -> impl Iterator<Item = (usize, &State)> {
        self.ranges.iter().flat_map(Clone::clone).zip(&self.states)
    }
}

impl Course<'_> {
    /// Crank angle and speed at a time, by the quintic between its neighbours.
    pub fn at(&self, t: f64) -> Turning {
        let last = self.first + self.motion.len() - 1;
        let a = self.grid.before(t).clamp(self.first, last - 1);
        let times = [self.grid.times[a], self.grid.times[a + 1]];
        between(times, [a, a + 1].map(|k| self.motion[k - self.first]), t)
    }
}

/// Largest way of the crank from node to node, rad, for measured and for computed samples: a step leaves out about 1e-10 rad,
/// or no more than rounding.
pub(super) const NODE_ROTATION: [f64; 2] = [TAU / 50.0, TAU / 400.0];

/// Number of nodes from which on those of a record are as few as may be.
pub(super) const LONG: usize = 50_000;

impl Grid {
    /// Nodes at the samples, computed or measured, and between those that are far apart.
    pub fn new(times: &[f64], angles: &[f64], are_computed: bool) -> Grid {
        let mut grid = Grid::default();
        let way: f64 = angles.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
        // The nodes of a long record are as few as may be.
        let is_long = way > LONG as f64 * NODE_ROTATION[1];
        let longest = NODE_ROTATION[usize::from(are_computed && !is_long)];
        for (i, t) in times.iter().enumerate() {
            grid.times.push(*t);
            grid.first.push(i);
            let Some(next) = times.get(i + 1) else { break };
            let parts = ((angles[i + 1] - angles[i]).abs() / longest)
                .ceil()
                .clamp(1.0, 1e4);
            for k in 1..parts as usize {
                grid.times.push(t + (next - t) * k as f64 / parts);
                grid.first.push(i + 1);
            }
        }
        grid.first.push(times.len());
        grid
    }

    /// The node before a time that has a node after it, or the one of the end beyond which the time is.
    pub fn before(&self, t: f64) -> usize {
        let before = self.times.partition_point(|time| *time <= t);
        before.clamp(1, self.times.len() - 1) - 1
    }

    pub fn len(&self) -> usize {
        self.times.len()
    }
}
