//! Regressors of the tones beside a linear model.

/// Regressors along a stretch of nodes: two amplitudes and a frequency of each tone.
#[derive(Clone, Debug, Default)]
pub(in crate::inverse) struct Regressors {
    /// Number of regressors.
    pub count: usize,
    /// What each adds to θ and to ω in a step, then in the next one.
    pub steps: Vec<[f64; 2]>,
    /// What each adds to the sample of a node, then of the next one.
    pub samples: Vec<f64>,
    /// ln of the unit of the density of the tones before the samples.
    pub log_unit: f64,
}

impl Regressors {
    /// Returns what the regressors add to θ and to ω in a step.
    pub fn of_step(&self, step: usize) -> &[[f64; 2]] {
        &self.steps[step * self.count..][..self.count]
    }

    /// Returns what the regressors add to the sample of a node.
    pub fn of_sample(&self, node: usize) -> &[f64] {
        &self.samples[node * self.count..][..self.count]
    }
}
