//! A part of the torque that repeats from cycle to cycle: harmonics of the crank angle whose coefficients all cycles share.
//!
//! du = √q dW + dp,   p(θ) = Σ βⱼ φⱼ(θ),   βⱼ ~ N(0, σ² s²/k²ᵐ)   for cos kθ and sin kθ: a periodic Wiener process of order m.
//!
//! The force of a loss grows with the speed: the φⱼ may be ω cos kθ and ω sin kθ too, ω in units of its root mean square.
//!
//! The filter runs once for β = 0, and beside it the derivatives of its state by β follow the same recursion (augmented Kalman
//! filter; de Jong, Ann. Statist. 19 (1991) 1073). A prediction error is then e + E β with the variance that it has without β, and
//! what is left is a linear regression with the information Σ EᵀE/S. The derivatives of p by θ and ω, with the β of the last
//! iteration, are those of the equation of motion, too: u less p is the state of the linear model.

use multiversion::multiversion;
use nalgebra::{DMatrix, DMatrixView, Dyn};

use super::super::model::fixed_interval::{Companion, Later};
use super::super::model::harmonics::responses;
use super::super::model::kalman::{Filtered, Gaussian, Innovation, Sample, Step};
use super::super::model::matrix::{Matrix, transposed};
use super::super::model::repeating::dot;
use super::super::model::sensitivity::Sensitivity;
use super::super::model::state_space::{Deviations, Stretch};
use super::regression::{BLOCK, ROWS_AT_ONCE, Regression};

/// Derivatives of the state by the coefficients, along the filter.
struct Columns<'a, const N: usize> {
    stretch: &'a Stretch,
    /// Derivatives by the coefficients, one row for each state.
    of: Vec<f64>,
    /// Room for the rows after a step, and for E.
    room: Vec<f64>,
    errors: Vec<f64>,
}

impl<'a, const N: usize> Columns<'a, N> {
    fn new(model: &Deviations<'a>) -> Self {
        let count = model.stretch.increments.count;
        Columns {
            stretch: model.stretch,
            of: vec![0.0; N * count],
            room: vec![0.0; N * count],
            errors: vec![0.0; count],
        }
    }

    /// Multiplies the rows by a matrix.
    fn transform(&mut self, matrix: &Matrix<N>) {
        let count = self.errors.len();
        self.room.fill(0.0);
        for (to, factors) in self.room.chunks_exact_mut(count).zip(matrix) {
            for (from, factor) in self.of.chunks_exact(count).zip(factors) {
                add(to, *factor, from);
            }
        }
        std::mem::swap(&mut self.of, &mut self.room);
    }

    /// Takes a step, with what the coefficients add to the state in it.
    fn step(&mut self, node: usize, step: &Step<N>) {
        if self.errors.is_empty() {
            return;
        }
        self.transform(&step.transition);
        let torques = self.stretch.increments.of(node);
        let rows = self.of.chunks_exact_mut(self.errors.len());
        for (row, response) in rows.zip(responses(&self.stretch.steps[node])) {
            for (factor, torque) in response.into_iter().zip(torques) {
                add(row, factor, torque);
            }
        }
    }

    /// Takes a sample in and leaves E in `errors`.
    fn update(&mut self, sample: &Sample, found: &Innovation<N>) {
        let count = self.errors.len().max(1);
        self.errors.fill(0.0);
        for (row, share) in self.of.chunks_exact(count).zip(sample.row::<N>()) {
            add(&mut self.errors, -share, row);
        }
        for (row, gain) in self.of.chunks_exact_mut(count).zip(&found.gain) {
            add(row, *gain, &self.errors);
        }
    }
}

/// Adds a multiple of a row.
#[multiversion(targets("x86_64+avx2"))]
fn add(to: &mut [f64], factor: f64, row: &[f64]) {
    if factor != 0.0 {
        to.iter_mut()
            .zip(row)
            .for_each(|(to, value)| *to += factor * value);
    }
}

/// Companion of filter and smoother that fills the normal equations.
pub(in crate::inverse) struct Regressed<'a, const N: usize> {
    columns: Columns<'a, N>,
    /// Derivatives by the tones; those of a smoother are known.
    tones: Option<Sensitivity<N>>,
    to: Regression,
    /// The smoother's derivatives, if there is one.
    found: Option<Derivatives>,
}

/// Derivatives of smoothed states and prediction errors by the coefficients.
pub(in crate::inverse) struct Derivatives {
    /// The rows of each node, one after the other.
    list: Vec<f64>,
    /// Those of the prediction errors over their standard deviations, one row for each sample.
    errors: Vec<f64>,
    /// Samples that are not on the way back yet.
    left: usize,
}

impl<'a, const N: usize> Regressed<'a, N> {
    /// A companion of the filter along a model, or of the smoother.
    pub fn new(model: &Deviations<'a>, is_smoother: bool) -> Self {
        let count = model.stretch.increments.count;
        let rows = model.stretch.observed.len() * count;
        let tones = (!is_smoother).then(|| Sensitivity::new(model.stretch.tones.count));
        let of_tones = tones.as_ref().map_or(0, |tones| tones.errors.len());
        Regressed {
            columns: Columns::new(model),
            tones,
            to: Regression::new(model.prior, count + of_tones),
            found: (is_smoother && count > 0).then(|| Derivatives {
                list: Vec::with_capacity(rows * N),
                errors: Vec::with_capacity(rows),
                left: 0,
            }),
        }
    }

    /// Returns the normal equations, and the smoother's derivatives if there is one.
    pub fn into_parts(mut self) -> (Regression, Option<Derivatives>) {
        self.to.multiply();
        (self.to, self.found)
    }

    /// Takes the derivatives to a node, and its sample into the normal equations.
    fn regress(&mut self, node: usize, at: &Filtered<'_, N>) {
        if let Some(step) = at.step {
            self.columns.step(node - 1, step);
        }
        let of_tones = match &mut self.tones {
            Some(tones) => tones.filtered(&self.columns.stretch.tones, node, at),
            None => &[],
        };
        if let Some(derivatives) = &mut self.found {
            derivatives.list.extend(&self.columns.of);
        }
        if let Some((sample, found)) = at.sample {
            self.columns.update(sample, found);
            let (errors, per) = (&self.columns.errors, 1.0 / found.variance.sqrt());
            self.to.take([errors, of_tones], found.error, per);
            if let Some(derivatives) = &mut self.found {
                derivatives.left += 1;
                let scaled = errors.iter().map(|value| value * per);
                derivatives.errors.extend(scaled);
            }
        }
    }
}

impl Derivatives {
    /// Adds what coefficients do to the smoothed states and prediction errors, and to the covariance of θ, ω and u, with a factor A
    /// of their covariance Aᵀ A.
    pub fn add<const N: usize>(
        self,
        coefficients: &[f64],
        factor: &DMatrix<f64>,
        path: &mut [Gaussian<N>],
        innovations: &mut [Option<f64>],
    ) {
        let Derivatives { list, errors, .. } = self;
        let count = coefficients.len();
        let size = N * count;
        let known = innovations.iter_mut().flatten();
        for (row, innovation) in errors.chunks_exact(count).zip(known) {
            *innovation += dot(row, coefficients);
        }
        for (columns, states) in list
            .chunks(ROWS_AT_ONCE * size)
            .zip(path.chunks_mut(ROWS_AT_ONCE))
        {
            let rows: Vec<&[f64]> = columns.chunks_exact(count).collect();
            // θ, ω and u of each node.
            let spreads = [0, 1, 2].map(|i| {
                let (from, shape) = (&columns[i * count..], (count, states.len()));
                let state = DMatrixView::from_slice_with_strides(from, shape.0, shape.1, 1, size);
                spread(factor, state)
            });
            for (k, state) in states.iter_mut().enumerate() {
                for i in 0..N {
                    state.mean[i] += dot(rows[N * k + i], coefficients);
                }
                for i in 0..3 {
                    for j in 0..=i {
                        let shared = spreads[i].column(k).dot(&spreads[j].column(k));
                        state.covariance[i][j] += shared;
                        state.covariance[j][i] = state.covariance[i][j];
                    }
                }
            }
        }
    }
}

/// Returns the product of a lower triangular factor and columns, block by block of rows.
fn spread(factor: &DMatrix<f64>, columns: DMatrixView<'_, f64, Dyn, Dyn>) -> DMatrix<f64> {
    let mut spread = DMatrix::zeros(columns.nrows(), columns.ncols());
    for first in (0..columns.nrows()).step_by(BLOCK) {
        let end = columns.nrows().min(first + BLOCK);
        let factor = factor.view((first, 0), (end - first, end));
        let mut rows = spread.rows_mut(first, end - first);
        rows.gemm(1.0, &factor, &columns.rows(0, end), 0.0);
    }
    spread
}

impl<const N: usize> Companion<N> for Regressed<'_, N> {
    #[inline(always)]
    fn filtered(&mut self, node: usize, at: &Filtered<'_, N>) {
        self.to.evidence.add(at);
        if self.to.count() > 0 {
            self.regress(node, at);
        }
    }

    /// The rows follow the recursion of the smoother's correction.
    fn returned(&mut self, node: usize, at: &Filtered<'_, N>, _: &Later<N>, _: &Gaussian<N>) {
        let columns = &mut self.columns;
        let Some(derivatives) = &mut self.found else {
            return;
        };
        let (count, size) = (columns.errors.len(), columns.of.len());
        if (node + 1) * size == derivatives.list.len() {
            columns.of.fill(0.0);
        }
        if let Some((sample, found)) = at.sample {
            columns.errors.fill(0.0);
            for (row, gain) in columns.of.chunks_exact(count).zip(&found.gain) {
                add(&mut columns.errors, -gain, row);
            }
            derivatives.left -= 1;
            let errors = &derivatives.errors[derivatives.left * count..][..count];
            add(&mut columns.errors, 1.0 / found.variance.sqrt(), errors);
            for (row, share) in columns.of.chunks_exact_mut(count).zip(sample.row::<N>()) {
                add(row, share, &columns.errors);
            }
        }
        let smoothed = &mut derivatives.list[node * size..][..size];
        let shares = &at.predicted.covariance;
        for (to, shares) in smoothed.chunks_exact_mut(count).zip(shares) {
            for (row, share) in columns.of.chunks_exact(count).zip(shares) {
                add(to, *share, row);
            }
        }
        if let Some(step) = at.step {
            columns.transform(&transposed(&step.transition));
        }
    }
}
