//! Kalman filter and Rauch-Tung-Striebel smoother of a linear model with scalar samples (Särkkä and Svensson, Bayesian
//! Filtering and Smoothing, 2nd ed. 2023, chapters 6 and 12), all covariances in units of the variance σ² of a sample.
//!
//! x(k+1) = Φ x(k) + c + w, w ~ N(0, Q);   y(k) = H x(k) + e, e ~ N(0, R).

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use super::state_space::Deviations;

/// N numbers.
pub(super) type Vector<const N: usize> = [f64; N];

/// N rows of N numbers.
pub(super) type Matrix<const N: usize> = [[f64; N]; N];

/// A matrix with these numbers on its diagonal.
pub(super) fn diagonal<const N: usize>(numbers: Vector<N>) -> Matrix<N> {
    let mut matrix = [[0.0; N]; N];
    for (k, number) in numbers.into_iter().enumerate() {
        matrix[k][k] = number;
    }
    matrix
}

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
    #[inline(always)]
    pub fn predicted(&self, step: &Step<N>) -> Gaussian<N> {
        Gaussian {
            mean: sum(times(&step.transition, &self.mean), step.offset),
            covariance: congruent(&step.transition, &self.covariance, &step.noise),
        }
    }

    /// Takes a sample in; its prediction error and the variance of that.
    #[inline(always)]
    pub fn update(&mut self, sample: &Sample<N>) -> (f64, f64) {
        let shared = times(&self.covariance, &sample.row);
        let variance = dot(&shared, &sample.row) + sample.variance;
        let error = sample.value - dot(&sample.row, &self.mean);
        let per = 1.0 / variance;
        for i in 0..N {
            let gain = shared[i] * per;
            self.mean[i] += gain * error;
            for j in 0..N {
                self.covariance[i][j] -= gain * shared[j];
            }
        }
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
#[inline(always)]
fn earlier<const N: usize>(
    step: &Step<N>,
    inverse: &Matrix<N>,
    predicted: &Gaussian<N>,
    later: &Gaussian<N>,
) -> Gaussian<N> {
    // Q W and I - Q W
    let share = shares(&predicted.covariance, &step.noise);
    let mut kept = share.map(|row| row.map(|part| -part));
    (0..N).for_each(|k| kept[k][k] += 1.0);
    let found = sum(later.mean, predicted.mean.map(|value| -value));
    let noise = sum(step.offset, times(&share, &found));
    // Q - Q W Q = (I - Q W) Q
    let left = product(&kept, &step.noise);
    let before = congruent(&kept, &later.covariance, &left);
    Gaussian {
        mean: times(inverse, &sum(later.mean, noise.map(|value| -value))),
        covariance: congruent(inverse, &before, &[[0.0; N]; N]),
    }
}

/// A P Aᵀ + Q, symmetric.
#[inline(always)]
fn congruent<const N: usize>(a: &Matrix<N>, p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let half = product(a, p);
    let mut whole = *q;
    for i in 0..N {
        for j in 0..=i {
            whole[i][j] += dot(&half[i], &a[j]);
            whole[j][i] = whole[i][j];
        }
    }
    whole
}

/// A B
#[inline(always)]
fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let mut whole = [[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            for j in 0..N {
                whole[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    whole
}

/// A x
#[inline(always)]
fn times<const N: usize>(a: &Matrix<N>, x: &Vector<N>) -> Vector<N> {
    std::array::from_fn(|i| dot(&a[i], x))
}

#[inline(always)]
fn dot<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}

#[inline(always)]
fn sum<const N: usize>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Q P⁻¹ for a covariance P and a symmetric Q, by the factors of Cholesky of P, scaled to a unit diagonal to which its rounding
/// is added.
#[inline(always)]
fn shares<const N: usize>(p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let scale: Vector<N> = std::array::from_fn(|k| 1.0 / p[k][k].sqrt());
    // L below the diagonal, and 1/L on it.
    let mut factor = [[0.0; N]; N];
    for j in 0..N {
        let mut pivot = 1.0 + f64::EPSILON;
        for k in 0..j {
            pivot -= factor[j][k] * factor[j][k];
        }
        let pivot = if pivot <= 0.0 { f64::EPSILON } else { pivot };
        let per = 1.0 / pivot.sqrt();
        factor[j][j] = per;
        for i in j + 1..N {
            let mut left = scale[i] * scale[j] * p[i][j];
            for k in 0..j {
                left -= factor[i][k] * factor[j][k];
            }
            factor[i][j] = left * per;
        }
    }
    let solved = |row: &Vector<N>| {
        let mut x: Vector<N> = std::array::from_fn(|k| row[k] * scale[k]);
        for i in 0..N {
            for k in 0..i {
                x[i] -= factor[i][k] * x[k];
            }
            x[i] *= factor[i][i];
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                x[i] -= factor[k][i] * x[k];
            }
            x[i] *= factor[i][i];
        }
        std::array::from_fn(|k| x[k] * scale[k])
    };
    let mut whole = [[0.0; N]; N];
    for i in 0..N {
        whole[i] = solved(&q[i]);
    }
    whole
}
