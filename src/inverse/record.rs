//! Samples at the nodes of a path.

use std::borrow::Cow;

use super::measurement_model::Sensor;
use super::state_space::{Observed, State};
use crate::scene::Measured;

/// Samples with the crank angles that they were read as.
#[derive(Clone, Debug)]
pub(super) struct Record<'a> {
    pub sensor: Sensor<'a>,
    /// Times, s, rising.
    pub times: Cow<'a, [f64]>,
    /// Measured values, rad or m; a crank angle continued over the turns.
    pub values: Vec<f64>,
    /// Weight of each sample: 0 for none, 1 for a full one.
    pub weights: Vec<f64>,
    /// Where each row of the measurement is among the samples, where transitions from code to code stand between them.
    pub rows: Option<Vec<usize>>,
    /// Least standard deviation of a sample, rad or m.
    pub floor: f64,
    /// Time of the scene at time 0 of the record, s.
    pub origin: f64,
}

/// Nodes of the path with their samples.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// Times, s.
    pub times: Vec<f64>,
    /// First sample of each node, and at the end the number of samples: a node has those up to the next one's first.
    pub first: Vec<usize>,
}

/// A path: the nominal one of a linear model.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// One for each node.
    pub states: Vec<State>,
    /// Variance of the crank angle, rad², where the samples are so curved in it that it counts.
    pub variances: Option<Vec<f64>>,
}

/// Largest way of the crank from node to node, rad.
const LONGEST: f64 = 0.12;

impl Grid {
    /// Nodes at the samples and between those that are far apart.
    pub fn new(times: &[f64], angles: &[f64]) -> Grid {
        let mut grid = Grid::default();
        for (i, t) in times.iter().enumerate() {
            grid.times.push(*t);
            grid.first.push(i);
            let Some(next) = times.get(i + 1) else { break };
            let parts = ((angles[i + 1] - angles[i]).abs() / LONGEST)
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

    pub fn len(&self) -> usize {
        self.times.len()
    }
}

impl Record<'_> {
    /// The sample of a row of the measurement.
    pub fn sample_of(&self, row: usize) -> usize {
        self.rows.as_ref().map_or(row, |rows| rows[row])
    }

    /// Number of rows of the measurement.
    pub fn row_count(&self) -> usize {
        self.rows.as_ref().map_or(self.times.len(), Vec::len)
    }

    /// Samples that hardly count.
    pub fn outliers(&self) -> usize {
        match self.rows {
            Some(_) => 0,
            None => self.weights.iter().filter(|w| **w < 0.5).count(),
        }
    }

    /// Whether what was measured is the crank angle itself.
    pub fn is_linear(&self) -> bool {
        self.sensor.measured == Measured::Theta
    }

    /// What the samples of a node show beside a nominal state.
    pub fn observed(&self, grid: &Grid, path: &Path, node: usize, sigma: f64) -> Observed {
        let none = Observed {
            variance: f64::INFINITY,
            ..Observed::default()
        };
        let range = grid.first[node]..grid.first[node + 1];
        let theta = path.states[node][0];
        let (mut weight, mut sum, mut slope) = (0.0, 0.0, 0.0);
        for i in range {
            let (residual, shown) = self.sensor.residual(self.values[i], theta);
            let mut precision = self.weights[i];
            if let Some(variances) = &path.variances {
                // What the curvature of h leaves beside its tangent.
                let bent = 0.5 * shown.curvature * variances[node] / sigma;
                precision /= 1.0 + precision * 2.0 * bent * bent;
            }
            if !(precision > 0.0 && residual.is_finite() && shown.slope.is_finite()) {
                continue;
            }
            weight += precision;
            sum += precision * residual;
            slope += precision * shown.slope;
        }
        if weight == 0.0 {
            return none;
        }
        Observed {
            residual: sum / weight,
            slope: slope / weight,
            variance: 1.0 / weight,
        }
    }
}
