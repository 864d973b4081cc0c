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
use super::regression::{COUNT, Each, Posterior, Regression};
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

/// What the coefficients add to θ, ω and u in a step: Simpson's rule for θ̈.
fn responses(step: &Linearised, turns: u8) -> [Each; 3] {
    let [begin, middle, end] = step.angles.map(|angle| harmonics(angle / f64::from(turns)));
    let (h, lever) = (step.h, step.lever);
    let mut found = [[0.0; COUNT]; 3];
    for j in 0..COUNT {
        let (half, whole) = (middle[j] - begin[j], end[j] - begin[j]);
        found[0][j] = h * h * lever * half / 3.0;
        found[1][j] = h * lever * (4.0 * half + whole) / 6.0;
        found[2][j] = whole;
    }
    found
}

/// Derivatives of the state by the coefficients, along the filter.
struct Columns<'a, const N: usize> {
    steps: &'a [Linearised],
    turns: u8,
    of: [Each; N],
}

impl<'a, const N: usize> Columns<'a, N> {
    fn new(model: &Deviations<'a>) -> Self {
        Columns {
            steps: model.steps,
            turns: model.prior.cycle,
            of: [[0.0; COUNT]; N],
        }
    }

    fn step(&mut self, node: usize, step: &Step<N>) {
        let before = self.of;
        let responses = responses(&self.steps[node], self.turns);
        for i in 0..N {
            let mut row = *responses.get(i).unwrap_or(&[0.0; COUNT]);
            for k in 0..N {
                let factor = step.transition[i][k];
                if factor != 0.0 {
                    (0..COUNT).for_each(|j| row[j] += factor * before[k][j]);
                }
            }
            self.of[i] = row;
        }
    }

    /// Takes a sample in; E.
    fn update(&mut self, sample: &Sample<N>, found: &Innovation<N>) -> Each {
        let mut errors = [0.0; COUNT];
        for k in 0..N {
            (0..COUNT).for_each(|j| errors[j] -= sample.row[k] * self.of[k][j]);
        }
        for k in 0..N {
            (0..COUNT).for_each(|j| self.of[k][j] += found.gain[k] * errors[j]);
        }
        errors
    }
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
        for i in 0..COUNT {
            let weighted = errors[i] / found.variance;
            self.to.score[i] -= weighted * found.error;
            let row = &mut self.to.information[i];
            (0..=i).for_each(|j| row[j] += weighted * errors[j]);
        }
    }
}

/// Derivatives of the smoothed states by the coefficients.
pub(super) struct Sensitivities<'a, const N: usize> {
    columns: Columns<'a, N>,
    posterior: &'a Posterior,
    factor: Vec<Each>,
    list: Vec<[Each; N]>,
    shifts: Vec<f64>,
}

impl<'a, const N: usize> Sensitivities<'a, N> {
    pub fn new(model: &Deviations<'a>, posterior: &'a Posterior) -> Self {
        Sensitivities {
            columns: Columns::new(model),
            posterior,
            factor: posterior.factor(),
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
        for (columns, state) in self.list.iter().zip(path) {
            let spread = columns.map(|row| self.spread(&row));
            for i in 0..N {
                state.mean[i] += dot(&columns[i], &self.posterior.coefficients);
                for k in 0..N {
                    state.covariance[i][k] += dot(&spread[i], &spread[k]);
                }
            }
        }
    }

    /// A row times the factor of the covariance.
    fn spread(&self, row: &Each) -> Each {
        let mut found = [0.0; COUNT];
        for (value, factor) in row.iter().zip(&self.factor) {
            (0..COUNT).for_each(|j| found[j] += value * factor[j]);
        }
        found
    }
}

fn dot(a: &Each, b: &Each) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
        let later = self.columns.of;
        let predicted = std::mem::replace(&mut self.list[node + 1], later);
        let responses = responses(&self.columns.steps[node], self.columns.turns);
        let mut before = later;
        for i in 0..N {
            for k in 0..N {
                let share = way.share[i][k];
                (0..COUNT).for_each(|j| before[i][j] -= share * (later[k][j] - predicted[k][j]));
            }
            if let Some(response) = responses.get(i) {
                (0..COUNT).for_each(|j| before[i][j] -= response[j]);
            }
        }
        self.columns.of = [[0.0; COUNT]; N];
        for i in 0..N {
            for k in 0..N {
                let factor = way.inverse[i][k];
                (0..COUNT).for_each(|j| self.columns.of[i][j] += factor * before[k][j]);
            }
        }
    }
}
