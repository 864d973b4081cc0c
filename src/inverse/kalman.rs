//! Kalman filter and Rauch-Tung-Striebel smoother of a linear model with scalar samples (Särkkä and Svensson, Bayesian
//! Filtering and Smoothing, 2nd ed. 2023, chapters 6 and 12), all covariances in units of the variance σ² of a sample.
//!
//! x(k+1) = Φ x(k) + c + w, w ~ N(0, Q);   y(k) = H x(k) + e, e ~ N(0, R).
#![allow(
    clippy::needless_range_loop,
    reason = "matrices stand in index notation"
)]

/// Column of N numbers.
pub(super) type Vector<const N: usize> = [f64; N];

/// N rows of N numbers.
pub(super) type Matrix<const N: usize> = [[f64; N]; N];

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
    /// H
    pub row: Vector<N>,
    /// R
    pub variance: f64,
}

/// The model: nodes with their samples, if they have one, and the steps between them.
pub(super) trait Model<const N: usize> {
    /// Number of nodes, at least 1.
    fn nodes(&self) -> usize;
    /// The step from a node to the next.
    fn step(&self, node: usize) -> Step<N>;
    /// Φ⁻¹ of the step from a node to the next.
    fn inverse(&self, node: usize) -> Matrix<N>;
    /// What was measured at a node.
    fn sample(&self, node: usize) -> Option<Sample<N>>;
    /// Mean and covariance before the first sample.
    fn start(&self) -> Gaussian<N>;
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

impl Evidence {
    /// Evidence of two stretches that share nothing.
    pub fn plus(self, other: Evidence) -> Evidence {
        Evidence {
            squares: self.squares + other.squares,
            log_variances: self.log_variances + other.log_variances,
            samples: self.samples + other.samples,
        }
    }
}

impl<const N: usize> Gaussian<N> {
    /// The distribution one step later.
    #[inline]
    fn predicted(&self, step: &Step<N>) -> Gaussian<N> {
        let mut mean = times(&step.transition, &self.mean);
        for (value, offset) in mean.iter_mut().zip(step.offset) {
            *value += offset;
        }
        Gaussian {
            mean,
            covariance: congruent(&step.transition, &self.covariance, &step.noise),
        }
    }

    /// Takes a sample in; its prediction error and the variance of that.
    #[inline]
    fn update(&mut self, sample: &Sample<N>) -> (f64, f64) {
        let shared = times(&self.covariance, &sample.row);
        let variance = dot(&shared, &sample.row) + sample.variance;
        let error = sample.value - dot(&sample.row, &self.mean);
        for i in 0..N {
            let gain = shared[i] / variance;
            self.mean[i] += gain * error;
            for j in 0..=i {
                self.covariance[i][j] -= gain * shared[j];
                self.covariance[j][i] = self.covariance[i][j];
            }
        }
        (error, variance)
    }
}

/// The prediction error decomposition of the likelihood.
pub(super) fn evidence<const N: usize>(model: &impl Model<N>) -> Evidence {
    let mut evidence = Evidence::default();
    run(
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
    model: &impl Model<N>,
    mut before: impl FnMut(usize, &Gaussian<N>),
    mut after: impl FnMut(usize, f64, f64),
) -> Gaussian<N> {
    let mut now = model.start();
    for node in 0..model.nodes() {
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
    model: &impl Model<N>,
) -> (Vec<Gaussian<N>>, Vec<Option<f64>>) {
    let nodes = model.nodes();
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
    // Q W, W the inverse of the predicted covariance.
    let share = divided(&step.noise, &predicted.covariance);
    let moved: Vector<N> = std::array::from_fn(|i| later.mean[i] - predicted.mean[i]);
    let noise = times(&share, &moved);
    let back: Vector<N> = std::array::from_fn(|i| later.mean[i] - step.offset[i] - noise[i]);
    // Q − Q W Q
    let mut left = step.noise;
    let mut kept = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            kept[i][j] = f64::from(u8::from(i == j)) - share[i][j];
            for k in 0..N {
                left[i][j] -= share[i][k] * step.noise[k][j];
            }
        }
    }
    let before = congruent(&kept, &later.covariance, &left);
    Gaussian {
        mean: times(inverse, &back),
        covariance: congruent(inverse, &before, &[[0.0; N]; N]),
    }
}

#[inline]
pub(super) fn dot<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> f64 {
    let mut sum = 0.0;
    for i in 0..N {
        sum += a[i] * b[i];
    }
    sum
}

#[inline]
pub(super) fn times<const N: usize>(a: &Matrix<N>, x: &Vector<N>) -> Vector<N> {
    std::array::from_fn(|i| dot(&a[i], x))
}

/// A P Aᵀ + Q, symmetric.
#[inline]
pub(super) fn congruent<const N: usize>(a: &Matrix<N>, p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let mut half = [[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            for j in 0..N {
                half[i][j] += a[i][k] * p[k][j];
            }
        }
    }
    let mut whole = *q;
    for i in 0..N {
        for j in 0..=i {
            whole[i][j] += dot(&half[i], &a[j]);
            whole[j][i] = whole[i][j];
        }
    }
    whole
}

/// A P⁻¹ for a symmetric positive P, by its Cholesky factor after scaling to a unit diagonal; pivots that rounding has made
/// negative count as the rounding itself.
#[inline]
fn divided<const N: usize>(a: &Matrix<N>, p: &Matrix<N>) -> Matrix<N> {
    let scale: Vector<N> = std::array::from_fn(|i| 1.0 / p[i][i].sqrt());
    let mut lower = [[0.0; N]; N];
    for j in 0..N {
        for i in j..N {
            let mut sum = p[i][j] * scale[i] * scale[j];
            for k in 0..j {
                sum -= lower[i][k] * lower[j][k];
            }
            lower[i][j] = if i == j {
                sum.max(f64::EPSILON).sqrt()
            } else {
                sum / lower[j][j]
            };
        }
    }
    let mut solved = *a;
    for row in &mut solved {
        for i in 0..N {
            row[i] *= scale[i];
        }
        for i in 0..N {
            for k in 0..i {
                row[i] -= lower[i][k] * row[k];
            }
            row[i] /= lower[i][i];
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                row[i] -= lower[k][i] * row[k];
            }
            row[i] /= lower[i][i];
        }
        for i in 0..N {
            row[i] *= scale[i];
        }
    }
    solved
}
