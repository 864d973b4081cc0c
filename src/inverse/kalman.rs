//! Kalman filter and Rauch-Tung-Striebel smoother of a linear model with scalar samples (Särkkä and Svensson, Bayesian
//! Filtering and Smoothing, 2nd ed. 2023, chapters 6 and 12), all covariances in units of the variance σ² of a sample.
//!
//! x(k+1) = Φ x(k) + c + w, w ~ N(0, Q);   y(k) = H x(k) + e, e ~ N(0, R).

use nalgebra::{Cholesky, SMatrix, SVector};

use super::state_space::Deviations;

/// Column of N numbers.
pub(super) type Vector<const N: usize> = SVector<f64, N>;

/// N rows of N numbers.
pub(super) type Matrix<const N: usize> = SMatrix<f64, N, N>;

/// One step of the model, from a node to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<const N: usize> {
    /// Φ
    pub transition: Matrix<N>,
    /// c
    pub offset: Vector<N>,
    /// Q
    pub noise: Matrix<N>,
}

/// What was measured at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample<const N: usize> {
    /// y
    pub value: f64,
    /// Hᵀ
    pub row: Vector<N>,
    /// R
    pub variance: f64,
}

/// A normal distribution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gaussian<const N: usize> {
    /// Its mean.
    pub mean: Vector<N>,
    /// Its covariance, in units of σ².
    pub covariance: Matrix<N>,
}

/// What the prediction errors v of the samples, with variances S, tell of a model.
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
    /// The distribution one step later.
    #[inline]
    pub fn predicted(&self, step: &Step<N>) -> Gaussian<N> {
        Gaussian {
            mean: times(&step.transition, &self.mean) + step.offset,
            covariance: congruent(&step.transition, &self.covariance, &step.noise),
        }
    }

    /// Takes a sample in; its prediction error and the variance of that.
    #[inline]
    pub fn update(&mut self, sample: &Sample<N>) -> (f64, f64) {
        let shared = times(&self.covariance, &sample.row);
        let variance = shared.dot(&sample.row) + sample.variance;
        let error = sample.value - sample.row.dot(&self.mean);
        self.mean += shared * (error / variance);
        self.covariance -= Matrix::from_fn(|i, j| shared[i] * shared[j] / variance);
        (error, variance)
    }
}

/// The prediction error decomposition of the likelihood.
pub(super) fn evidence<const N: usize>(model: &Deviations<'_>) -> Evidence {
    let mut evidence = Evidence::default();
    run::<N>(
        model,
        |_, _| (),
        |_, error, variance| {
            evidence.squares += error * error / variance;
            evidence.log_variances += variance.ln();
            evidence.samples += 1;
        },
    );
    evidence
}

/// Runs the filter; `before` sees each node's distribution before its sample, `after` prediction errors and their variances.
pub(super) fn run<const N: usize>(
    model: &Deviations<'_>,
    mut before: impl FnMut(usize, &Gaussian<N>),
    mut after: impl FnMut(usize, f64, f64),
) -> Gaussian<N> {
    let mut now = model.start();
    for node in 0..model.observed.len() {
        if node > 0 {
            now = now.predicted(&model.step(node - 1));
        }
        before(node, &now);
        if let Some(sample) = model.sample(node) {
            let (error, variance) = now.update(&sample);
            after(node, error, variance);
        }
    }
    now
}

/// The distribution of the state at each node, given all samples, and the prediction errors over their standard
/// deviations (in units of σ), by node.
///
/// The way back uses Φ⁻¹ and the precision W of the prediction: with ŵ = Q W (x − x̂) for the noise of a step,
/// x(k) = Φ⁻¹ (x(k+1) − c − ŵ) and P(k) = Φ⁻¹ [Q − QWQ + (I − QW) P(k+1) (I − WQ)] Φ⁻ᵀ, which has no difference of large
/// numbers where the start is diffuse.
pub(super) fn smooth<const N: usize>(
    model: &Deviations<'_>,
) -> (Vec<Gaussian<N>>, Vec<Option<f64>>) {
    let nodes = model.observed.len();
    let mut path = Vec::with_capacity(nodes);
    let mut innovations = vec![None; nodes];
    let last = run(
        model,
        |_, predicted| path.push(*predicted),
        |node, error, variance| innovations[node] = Some(error / variance.sqrt()),
    );
    let mut now = last;
    for node in (0..nodes - 1).rev() {
        let predicted = std::mem::replace(&mut path[node + 1], now);
        now = earlier(&model.step(node), &model.inverse(node), &predicted, &now);
    }
    path[0] = now;
    (path, innovations)
}

/// The smoothed distribution one step before `later`, where the filter predicted `predicted`.
#[inline]
fn earlier<const N: usize>(
    step: &Step<N>,
    inverse: &Matrix<N>,
    predicted: &Gaussian<N>,
    later: &Gaussian<N>,
) -> Gaussian<N> {
    // Q W
    let share = precision(&predicted.covariance, &step.noise).transpose();
    let noise = times(&share, &(later.mean - predicted.mean));
    let kept = Matrix::identity() - share;
    let left = step.noise - product(&share, &step.noise);
    let before = congruent(&kept, &later.covariance, &left);
    Gaussian {
        mean: times(inverse, &(later.mean - step.offset - noise)),
        covariance: congruent(inverse, &before, &Matrix::zeros()),
    }
}

/// A P Aᵀ + Q, symmetric.
#[inline]
fn congruent<const N: usize>(a: &Matrix<N>, p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let half = product(a, p);
    let mut whole = product(&half, &a.transpose()) + q;
    whole.fill_upper_triangle_with_lower_triangle();
    whole
}

/// A B, in loops that are short enough to be unrolled.
#[inline]
fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let column = |b: &[f64; N]| times(a, &Vector::from(*b)).into();
    Matrix::from(b.data.0.map(|b| column(&b)))
}

/// A x
#[inline]
fn times<const N: usize>(a: &Matrix<N>, x: &Vector<N>) -> Vector<N> {
    let mut sum = [0.0; N];
    for (column, x) in a.data.0.iter().zip(&x.data.0[0]) {
        for (sum, a) in sum.iter_mut().zip(column) {
            *sum += a * x;
        }
    }
    Vector::from(sum)
}

/// P⁻¹ A for a covariance P, scaled to a unit diagonal to which its rounding is added.
#[inline]
fn precision<const N: usize>(p: &Matrix<N>, a: &Matrix<N>) -> Matrix<N> {
    let scale = p.diagonal().map(|variance| 1.0 / variance.sqrt());
    let mut unit = p.component_mul(&(scale * scale.transpose()));
    for k in 0..N {
        unit[(k, k)] += f64::EPSILON;
    }
    let scaled = Matrix::from_fn(|i, j| scale[i] * a[(i, j)]);
    match Cholesky::new_with_substitute(unit, f64::EPSILON) {
        Some(factor) => {
            let solved = factor.solve(&scaled);
            Matrix::from_fn(|i, j| scale[i] * solved[(i, j)])
        }
        None => Matrix::from_element(f64::NAN),
    }
}
