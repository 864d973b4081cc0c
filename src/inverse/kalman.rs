//! Kalman filter and Rauch-Tung-Striebel smoother of a linear model with scalar samples (Särkkä and Svensson, Bayesian
//! Filtering and Smoothing, 2nd ed. 2023, chapters 6 and 12), all covariances in units of the variance σ² of a sample.
//!
//! x(k+1) = Φ x(k) + c + w, w ~ N(0, Q);   y(k) = H x(k) + e, e ~ N(0, R).

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use super::matrix::{Matrix, Vector, congruent, dot, product, shares, sum, times};
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

/// Observer of the filter and the smoother.
pub(super) trait Companion<const N: usize> {
    /// Called after the prediction of a step to the next node.
    #[inline(always)]
    fn stepped(&mut self, _node: usize, _step: &Step<N>) {}

    /// Called with the distribution of a node before its sample is used.
    #[inline(always)]
    fn predicted(&mut self, _node: usize, _distribution: &Gaussian<N>) {}

    /// Called after a sample has updated the state.
    #[inline(always)]
    fn updated(&mut self, _node: usize, _sample: &Sample<N>, _found: &Innovation<N>) {}

    /// Called when the smoother returns to a node, with the predicted and the smoothed distribution of the next one.
    #[inline(always)]
    fn returned(&mut self, _node: usize, _way: &Return<N>, _next: [&Gaussian<N>; 2]) {}
}

/// Smoother step from a node to the preceding one: x(k) = Φ⁻¹ (x(k+1) − c − QW (x(k+1) − x̂)).
#[derive(Clone, Copy, Debug)]
pub(super) struct Return<const N: usize> {
    /// Φ⁻¹
    pub inverse: Matrix<N>,
    /// QW
    pub share: Matrix<N>,
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

    /// Updates the distribution by a sample.
    #[inline(always)]
    pub fn update(&mut self, sample: &Sample<N>) -> Innovation<N> {
        let shared = times(&self.covariance, &sample.row);
        let variance = dot(&shared, &sample.row) + sample.variance;
        let error = sample.value - dot(&sample.row, &self.mean);
        let per = 1.0 / variance;
        let gain = shared.map(|value| value * per);
        for i in 0..N {
            self.mean[i] += gain[i] * error;
            for j in 0..N {
                self.covariance[i][j] -= gain[i] * shared[j];
            }
        }
        Innovation {
            error,
            variance,
            gain,
        }
    }
}

impl std::iter::Sum for Evidence {
    fn sum<I: Iterator<Item = Evidence>>(parts: I) -> Evidence {
        parts.fold(Evidence::default(), |sum, part| Evidence {
            squares: sum.squares + part.squares,
            log_variances: sum.log_variances + part.log_variances,
            samples: sum.samples + part.samples,
        })
    }
}

impl<const N: usize> Companion<N> for () {}

impl<const N: usize> Companion<N> for Evidence {
    #[inline(always)]
    fn updated(&mut self, _: usize, _: &Sample<N>, found: &Innovation<N>) {
        self.squares += found.error * found.error / found.variance;
        self.log_variances += found.variance.ln();
        self.samples += 1;
    }
}

/// Computes the prediction error decomposition of the likelihood.
pub(super) fn evidence<const N: usize>(model: &Deviations<'_>) -> Evidence {
    let mut evidence = Evidence::default();
    run::<N>(model, None, &mut evidence);
    evidence
}

/// Runs the filter from the prior before the first sample, or from a known distribution after it.
#[inline(always)]
pub(super) fn run<const N: usize>(
    model: &Deviations<'_>,
    known: Option<Gaussian<N>>,
    companion: &mut impl Companion<N>,
) -> Gaussian<N> {
    let first = usize::from(known.is_some());
    let mut now = known.unwrap_or_else(|| model.start());
    for node in first..model.observed.len() {
        if node > 0 {
            let step = model.step(node - 1);
            now = now.predicted(&step);
            companion.stepped(node - 1, &step);
        }
        companion.predicted(node, &now);
        if let Some(sample) = model.sample(node) {
            let found = now.update(&sample);
            companion.updated(node, &sample, &found);
        }
    }
    now
}

/// Predictions and innovations that the filter leaves to the smoother, and a companion of both.
struct Forward<'a, C, const N: usize> {
    path: Vec<Gaussian<N>>,
    innovations: Vec<Option<f64>>,
    companion: &'a mut C,
}

impl<C: Companion<N>, const N: usize> Companion<N> for Forward<'_, C, N> {
    fn stepped(&mut self, node: usize, step: &Step<N>) {
        self.companion.stepped(node, step);
    }

    fn predicted(&mut self, node: usize, distribution: &Gaussian<N>) {
        self.path.push(*distribution);
        self.companion.predicted(node, distribution);
    }

    fn updated(&mut self, node: usize, sample: &Sample<N>, found: &Innovation<N>) {
        self.innovations[node] = Some(found.error / found.variance.sqrt());
        self.companion.updated(node, sample, found);
    }
}

/// Returns the distribution of the state at each node, given all samples, and the prediction errors over their standard
/// deviations (in units of σ), by node.
///
/// The backward recursion uses Φ⁻¹ and the precision W of the prediction: with ŵ = Q W (x − x̂) for the noise of a step,
/// x(k) = Φ⁻¹ (x(k+1) − c − ŵ) and P(k) = Φ⁻¹ [Q − QWQ + (I − QW) P(k+1) (I − WQ)] Φ⁻ᵀ, without a difference of large
/// numbers where the start is diffuse. Where rounding grows in it, the means are NaN.
pub(super) fn smooth<const N: usize>(
    model: &Deviations<'_>,
    companion: &mut impl Companion<N>,
) -> (Vec<Gaussian<N>>, Vec<Option<f64>>) {
    let nodes = model.observed.len();
    let mut forward = Forward {
        path: Vec::with_capacity(nodes),
        innovations: vec![None; nodes],
        companion,
    };
    let mut now = run(model, None, &mut forward);
    let Forward {
        mut path,
        innovations,
        companion,
    } = forward;
    for node in (0..nodes - 1).rev() {
        let predicted = std::mem::replace(&mut path[node + 1], now);
        let step = model.step(node);
        let way = Return {
            inverse: model.inverse(node),
            share: shares(&predicted.covariance, &step.noise),
        };
        companion.returned(node, &way, [&predicted, &now]);
        now = earlier(&step, &way, &predicted, &now);
        // All samples leave the angle no more variance than the former ones: rounding has grown on the way back.
        if now.covariance[0][0] > 2.0 * path[node].covariance[0][0] {
            now.mean = [f64::NAN; N];
        }
    }
    path[0] = now;
    (path, innovations)
}

/// Returns the smoothed distribution one step before `later`, where the filter predicted `predicted`.
#[inline(always)]
fn earlier<const N: usize>(
    step: &Step<N>,
    way: &Return<N>,
    predicted: &Gaussian<N>,
    later: &Gaussian<N>,
) -> Gaussian<N> {
    // I - Q W
    let mut kept = way.share.map(|row| row.map(|part| -part));
    (0..N).for_each(|k| kept[k][k] += 1.0);
    let found = sum(later.mean, predicted.mean.map(|value| -value));
    let noise = sum(step.offset, times(&way.share, &found));
    // Q - Q W Q = (I - Q W) Q
    let left = product(&kept, &step.noise);
    let before = congruent(&kept, &later.covariance, &left);
    Gaussian {
        mean: times(&way.inverse, &sum(later.mean, noise.map(|value| -value))),
        covariance: congruent(&way.inverse, &before, &[[0.0; N]; N]),
    }
}
