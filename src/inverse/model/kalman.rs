//! Kalman filter of a linear model with scalar samples (Särkkä and Svensson, Bayesian Filtering and Smoothing, 2nd ed.
//! 2023, chapter 6), all covariances in units of the variance σ² of a sample.
//!
//! x(k+1) = Φ x(k) + c + w, w ~ N(0, Q);   y(k) = H x(k) + e, e ~ N(0, R).

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use super::matrix::{Matrix, Vector};
use super::state_space::Deviations;

/// Step of the model from a node to the next.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Step<const N: usize> {
    /// Φ, triangular below the second row.
    pub transition: Matrix<N>,
    /// c
    pub offset: Vector<N>,
    /// Q
    pub noise: Matrix<N>,
}

/// Scalar sample at a node, of one of the first two states and, where its noise is correlated, of the last.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Sample {
    /// y
    pub value: f64,
    /// Whether the second state is measured, in the place of the first.
    pub is_second: bool,
    /// Entry of H for that state.
    pub slope: f64,
    /// Whether the last state adds to it.
    pub is_correlated: bool,
    /// R
    pub variance: f64,
}

impl Sample {
    /// Returns H x.
    #[inline(always)]
    pub fn shown<const N: usize>(&self, x: &Vector<N>) -> f64 {
        let own = if self.is_second { x[1] } else { x[0] };
        let correlated = if self.is_correlated { x[N - 1] } else { 0.0 };
        self.slope * own + correlated
    }

    /// Returns H.
    #[inline(always)]
    pub fn row<const N: usize>(&self) -> Vector<N> {
        let mut row = [0.0; N];
        row[usize::from(self.is_second)] = self.slope;
        if self.is_correlated {
            row[N - 1] = 1.0;
        }
        row
    }
}

/// Normal distribution of the state.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Gaussian<const N: usize> {
    /// Mean.
    pub mean: Vector<N>,
    /// Covariance, in units of σ².
    pub covariance: Matrix<N>,
}

/// Prediction error (innovation) of a sample.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Innovation<const N: usize> {
    pub error: f64,
    /// Variance of the error, in units of σ².
    pub variance: f64,
    /// K
    pub gain: Vector<N>,
}

/// A node of the filter.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Filtered<'a, const N: usize> {
    /// The step to this node; none to the first.
    pub step: Option<&'a Step<N>>,
    /// The distribution before the sample, by the former ones.
    pub predicted: &'a Gaussian<N>,
    pub sample: Option<&'a (Sample, Innovation<N>)>,
}

/// Likelihood terms of a model, from the prediction errors v of the samples with variances S.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::inverse) struct Evidence {
    /// Σ v²/S
    pub squares: f64,
    /// Σ ln S
    pub log_variances: f64,
    /// Number of samples.
    pub samples: usize,
}

/// Returns the first column of a row of Φ that is not zero.
#[inline(always)]
fn first(row: usize) -> usize {
    if row < 2 { 0 } else { row }
}

impl<const N: usize> Gaussian<N> {
    /// Returns the distribution one step later.
    #[inline(always)]
    pub fn predicted(&self, step: &Step<N>) -> Gaussian<N> {
        let (a, p) = (&step.transition, &self.covariance);
        let (mut mean, mut covariance) = (step.offset, step.noise);
        let mut half = [[0.0; N]; N];
        for i in 0..N {
            for k in first(i)..N {
                mean[i] += a[i][k] * self.mean[k];
                for j in 0..N {
                    half[i][j] += a[i][k] * p[k][j];
                }
            }
        }
        for j in 0..N {
            for i in 0..=j {
                for k in first(j)..N {
                    covariance[i][j] += half[i][k] * a[j][k];
                }
                covariance[j][i] = covariance[i][j];
            }
        }
        Gaussian { mean, covariance }
    }

    /// Returns the prediction error of a sample.
    #[inline(always)]
    pub fn innovation(&self, sample: &Sample) -> Innovation<N> {
        let shared: Vector<N> = std::array::from_fn(|i| sample.shown(&self.covariance[i]));
        let variance = sample.shown(&shared) + sample.variance;
        let per = 1.0 / variance;
        Innovation {
            error: sample.value - sample.shown(&self.mean),
            variance,
            gain: shared.map(|value| value * per),
        }
    }

    /// Updates the distribution by a sample.
    #[inline(always)]
    pub fn update(&mut self, sample: &Sample) -> Innovation<N> {
        let found = self.innovation(sample);
        for i in 0..N {
            self.mean[i] += found.gain[i] * found.error;
            let shared = found.gain[i] * found.variance;
            for j in i..N {
                self.covariance[i][j] -= shared * found.gain[j];
                self.covariance[j][i] = self.covariance[i][j];
            }
        }
        found
    }
}

impl Evidence {
    /// Adds the sample of a node, if there is one.
    #[inline(always)]
    pub fn add<const N: usize>(&mut self, at: &Filtered<'_, N>) {
        if let Some((_, found)) = at.sample {
            self.take(found);
        }
    }

    /// Adds a sample.
    #[inline(always)]
    pub fn take<const N: usize>(&mut self, found: &Innovation<N>) {
        self.squares += found.error * found.error / found.variance;
        self.log_variances += found.variance.ln();
        self.samples += 1;
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
pub(in crate::inverse) fn run<const N: usize>(
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
