//! A part of the torque that repeats from cycle to cycle: harmonics of the crank angle whose coefficients all cycles share.
//!
//! du = √q dW + dp,   p(θ) = Σ βⱼ φⱼ(θ),   βⱼ ~ N(0, σ² s²/k²ᵐ)   for cos kθ and sin kθ: a periodic Wiener process of order m.
//!
//! The filter runs once for β = 0, and beside it the derivatives of its state by β follow the same recursion (augmented Kalman
//! filter; de Jong, Ann. Statist. 19 (1991) 1073). A prediction error is then e + E β with the variance that it has without β, and
//! what is left is a linear regression with the information Σ EᵀE/S.

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use super::kalman::{Companion, Gaussian, Innovation, Return, Sample, Step};
use super::linearised::Linearised;
use super::matrix::{Matrix, dot};
use super::regression::{COUNT, Each, Posterior, ROWS, Regression};
use super::state_space::Deviations;

/// cos kθ and sin kθ of the cycle angle.
fn harmonics(angle: f64) -> Each {
    let (sin, cos) = angle.sin_cos();
    let mut list = [0.0; COUNT];
    let (mut c, mut s) = (1.0, 0.0);
    for pair in list.chunks_exact_mut(2) {
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
        pair.copy_from_slice(&[c, s]);
    }
    list
}

/// Harmonics in the middle and at the end of each step less those at its begin, along a path with these crank angles at begins,
/// middles and ends, rad.
pub(super) fn increments(angles: impl Iterator<Item = [f64; 3]>, turns: u8) -> Vec<[Each; 2]> {
    let mut known = None;
    let of = |[begin, middle, end]: [f64; 3]| {
        let at = |angle: f64| harmonics(angle / f64::from(turns));
        let begin = known.unwrap_or_else(|| at(begin));
        let next = at(end);
        known = Some(next);
        let mut found = [at(middle), next];
        for list in &mut found {
            (0..COUNT).for_each(|j| list[j] -= begin[j]);
        }
        found
    };
    angles.map(of).collect()
}

/// Derivatives of the state by the coefficients, along the filter.
struct Columns<'a, const N: usize> {
    steps: &'a [Linearised],
    increments: &'a [[Each; 2]],
    of: [Each; N],
}

impl<'a, const N: usize> Columns<'a, N> {
    fn new(model: &Deviations<'a>) -> Self {
        Columns {
            steps: model.steps,
            increments: model.increments,
            of: [[0.0; COUNT]; N],
        }
    }

    /// Adds `sign` times what the coefficients add to the state in a step: Simpson's rule for θ̈.
    fn respond(&self, node: usize, sign: f64, rows: &mut [Each; N]) {
        let Linearised { h, lever, .. } = self.steps[node];
        let [half, whole] = &self.increments[node];
        add(&mut rows[0], sign * h * h * lever / 3.0, half);
        add(&mut rows[1], sign * h * lever * (2.0 / 3.0), half);
        add(&mut rows[1], sign * h * lever / 6.0, whole);
        add(&mut rows[2], sign, whole);
    }

    fn step(&mut self, node: usize, step: &Step<N>) {
        let mut after = transformed(&step.transition, &self.of);
        self.respond(node, 1.0, &mut after);
        self.of = after;
    }

    /// Takes a sample in; E.
    fn update(&mut self, sample: &Sample<N>, found: &Innovation<N>) -> Each {
        let mut errors = [0.0; COUNT];
        for k in 0..N {
            add(&mut errors, -sample.row[k], &self.of[k]);
        }
        for k in 0..N {
            add(&mut self.of[k], found.gain[k], &errors);
        }
        errors
    }
}

/// Adds a multiple of a row.
#[inline(always)]
fn add(to: &mut Each, factor: f64, row: &Each) {
    if factor != 0.0 {
        for j in 0..COUNT {
            to[j] += factor * row[j];
        }
    }
}

/// A matrix times rows.
#[inline(always)]
fn transformed<const N: usize>(matrix: &Matrix<N>, rows: &[Each; N]) -> [Each; N] {
    let mut found = [[0.0; COUNT]; N];
    for i in 0..N {
        for k in 0..N {
            add(&mut found[i], matrix[i][k], &rows[k]);
        }
    }
    found
}

/// Filter and normal equations.
pub(super) struct Regressed<'a, const N: usize> {
    columns: Columns<'a, N>,
    to: &'a mut Regression,
}

impl<'a, const N: usize> Regressed<'a, N> {
    pub fn new(model: &Deviations<'a>, to: &'a mut Regression) -> Self {
        Regressed {
            columns: Columns::new(model),
            to,
        }
    }
}

impl<const N: usize> Companion<N> for Regressed<'_, N> {
    fn stepped(&mut self, node: usize, step: &Step<N>) {
        self.columns.step(node, step);
    }

    fn updated(&mut self, _: usize, sample: &Sample<N>, found: &Innovation<N>) {
        let errors = self.columns.update(sample, found);
        self.to
            .take(&errors, found.error, 1.0 / found.variance.sqrt());
    }
}

/// Derivatives of the smoothed states by the coefficients.
pub(super) struct Sensitivities<'a, const N: usize> {
    columns: Columns<'a, N>,
    posterior: &'a Posterior,
    list: Vec<[Each; N]>,
    shifts: Vec<f64>,
}

impl<'a, const N: usize> Sensitivities<'a, N> {
    pub fn new(model: &Deviations<'a>, posterior: &'a Posterior) -> Self {
        Sensitivities {
            columns: Columns::new(model),
            posterior,
            list: Vec::with_capacity(model.observed.len()),
            shifts: vec![0.0; model.observed.len()],
        }
    }

    /// Adds what the coefficients do to the smoothed states and prediction errors.
    pub fn add(&mut self, path: &mut [Gaussian<N>], innovations: &mut [Option<f64>]) {
        self.list[0] = self.columns.of;
        for (shift, innovation) in self.shifts.iter().zip(innovations) {
            *innovation = innovation.map(|value| value + shift);
        }
        for (columns, states) in self.list.chunks(ROWS).zip(path.chunks_mut(ROWS)) {
            let spread = self.posterior.spread(columns.as_flattened());
            for (k, state) in states.iter_mut().enumerate() {
                let spread = spread.columns(N * k, N);
                for i in 0..N {
                    state.mean[i] += dot(&columns[k][i], &self.posterior.coefficients);
                    for j in 0..N {
                        state.covariance[i][j] += spread.column(i).dot(&spread.column(j));
                    }
                }
            }
        }
    }
}

impl<const N: usize> Companion<N> for Sensitivities<'_, N> {
    fn stepped(&mut self, node: usize, step: &Step<N>) {
        self.columns.step(node, step);
    }

    fn predicted(&mut self, _: usize, _: &Gaussian<N>) {
        self.list.push(self.columns.of);
    }

    fn updated(&mut self, node: usize, sample: &Sample<N>, found: &Innovation<N>) {
        let errors = self.columns.update(sample, found);
        self.shifts[node] = dot(&errors, &self.posterior.coefficients) / found.variance.sqrt();
    }

    fn returned(&mut self, node: usize, way: &Return<N>) {
        let mut before = self.columns.of;
        let mut off = std::mem::replace(&mut self.list[node + 1], before);
        for k in 0..N {
            for j in 0..COUNT {
                off[k][j] -= before[k][j];
            }
        }
        for i in 0..N {
            for k in 0..N {
                add(&mut before[i], way.share[i][k], &off[k]);
            }
        }
        self.columns.respond(node, -1.0, &mut before);
        self.columns.of = transformed(&way.inverse, &before);
    }
}
