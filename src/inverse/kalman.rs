//! Kalman filter of a linear model with scalar samples (Särkkä and Svensson, Bayesian Filtering and Smoothing, 2nd ed.
//! 2023, chapter 6), all covariances in units of the variance σ² of a sample.
//!
//! x(k+1) = Φ x(k) + c + w, w ~ N(0, Q);   y(k) = H x(k) + e, e ~ N(0, R).

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use super::matrix::{Matrix, Vector, congruent, dot, sum, times};
use super::state_space::Deviations;

/// Step of the model from a node to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<const N: usize> {
    /// Φ
    pub transition: Matrix<N>,
    /// c
    pub offset: Vector<N>,
    /// Q
    pub noise: Matrix<N>,
}

/// Scalar sample at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample<const N: usize> {
    /// y
    pub value: f64,
    /// Hᵀ
    pub row: Vector<N>,
    /// R
    pub variance: f64,
}

/// Normal distribution of the state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gaussian<const N: usize> {
    /// Mean.
    pub mean: Vector<N>,
    /// Covariance, in units of σ².
    pub covariance: Matrix<N>,
}

/// Prediction error (innovation) of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Innovation<const N: usize> {
    pub error: f64,
    /// Variance of the error, in units of σ².
    pub variance: f64,
    /// K
    pub gain: Vector<N>,
}

/// A node of the filter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filtered<'a, const N: usize> {
    /// The step to this node; none to the first.
    pub step: Option<&'a Step<N>>,
    /// The distribution before the sample, by the former ones.
    pub predicted: &'a Gaussian<N>,
    pub sample: Option<&'a (Sample<N>, Innovation<N>)>,
}

/// Likelihood terms of a model, from the prediction errors v of the samples with variances S.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    /// Σ v²/S
    pub squares: f64,
    /// Σ ln S
    pub log_variances: f64,
    /// Number of samples.
    pub samples: usize,
}

impl<const N: usize> Gaussian<N> {
    /// Returns the distribution one step later.
    #[inline(always)]
    pub fn predicted(&self, step: &Step<N>) -> Gaussian<N> {
        Gaussian {
            mean: sum(times(&step.transition, &self.mean), step.offset),
            covariance: congruent(&step.transition, &self.covariance, &step.noise),
        }
    }

    /// Returns the prediction error of a sample.
    #[inline(always)]
    pub fn innovation(&self, sample: &Sample<N>) -> Innovation<N> {
        let shared = times(&self.covariance, &sample.row);
        let variance = dot(&shared, &sample.row) + sample.variance;
        let per = 1.0 / variance;
        Innovation {
            error: sample.value - dot(&sample.row, &self.mean),
            variance,
            gain: shared.map(|value| value * per),
        }
    }

    /// Updates the distribution by a sample.
    #[inline(always)]
    pub fn update(&mut self, sample: &Sample<N>) -> Innovation<N> {
        let found = self.innovation(sample);
        for i in 0..N {
            self.mean[i] += found.gain[i] * found.error;
            let shared = found.gain[i] * found.variance;
            for j in 0..N {
                self.covariance[i][j] -= shared * found.gain[j];
            }
        }
        found
    }
}

impl Evidence {
    /// Adds the sample of a node.
    #[inline(always)]
    pub fn add<const N: usize>(&mut self, at: &Filtered<'_, N>) {
        if let Some((_, found)) = at.sample {
            self.squares += found.error * found.error / found.variance;
            self.log_variances += found.variance.ln();
            self.samples += 1;
        }
    }
}

impl std::ops::AddAssign for Evidence {
    fn add_assign(&mut self, part: Evidence) {
        self.squares += part.squares;
        self.log_variances += part.log_variances;
        self.samples += part.samples;
    }
}

/// Runs the filter from the prior before the first sample, or from a known distribution after it, and shows each node.
#[inline(always)]
pub(super) fn run<const N: usize>(
    model: &Deviations<'_>,
    known: Option<Gaussian<N>>,
    mut show: impl FnMut(usize, &Filtered<'_, N>),
) -> Gaussian<N> {
    let first = usize::from(known.is_some());
    let mut now = known.unwrap_or_else(|| model.start());
    for node in first..model.stretch.observed.len() {
        let step = (node > 0).then(|| model.step(node - 1));
        if let Some(step) = &step {
            now = now.predicted(step);
        }
        let predicted = now;
        let sample = model.sample(node);
        let sample = sample.map(|sample| (sample, now.update(&sample)));
        let at = Filtered {
            step: step.as_ref(),
            predicted: &predicted,
            sample: sample.as_ref(),
        };
        show(node, &at);
    }
    now
}
