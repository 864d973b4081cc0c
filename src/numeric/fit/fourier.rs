//! Steady rotation plus harmonics: θ = c + Ω τ + Σ a_k cos kΩτ + b_k sin kΩτ, τ counted from the middle of the record.

use nalgebra::{DMatrix, DVector};

use super::condensed::Rows;
use super::dependent::Follows;
use super::design::{solve, squares};
use super::gram::products;
use super::rotation::{most_harmonics, settle, supported, turns};
use super::spread::Spread;
use super::triangle::Triangle;
use super::turn::{Periodic, Waves};
use super::{Kind, Quality, Samples, Size, State, add_products};
use crate::numeric::parallel;

/// Harmonics with which the rotation is found first.
const FEW: usize = 3;

/// Fewest blocks that are taken for a rotation that is not known yet.
const FEWEST_BLOCKS: usize = 256;

/// Fewest turns that tell harmonics from a rotation.
const LEAST_TURNS: f64 = 1.2;

/// A fitted steady rotation with harmonics.
#[derive(Clone, Debug)]
pub struct Fourier {
    middle: f64,
    /// c, Ω, a_1, b_1, a_2, b_2, ...
    parameters: Vec<f64>,
    /// The harmonics with three derivatives in time.
    waves: Periodic<4>,
    /// Sums of the sizes of harmonics and their derivatives.
    sizes: [f64; 3],
    triangle: Triangle,
    spread: Spread,
    /// Variances of the coefficients of the harmonics that follow.
    tail: Vec<f64>,
    /// What errors of the samples that depend on each other amount to.
    errors: Option<Spread>,
    quality: Quality,
}

impl Fourier {
    /// Fits rotation and harmonics.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn fit(samples: &Samples<'_>, size: Size) -> Result<Fourier, String> {
        let rows = Kind::Fourier.rows(samples, size, samples.computed());
        let fit = Fourier::to(&rows, size)?;
        if fit.is_seen_by(&rows) {
            return Ok(fit);
        }
        Fourier::to(&Rows::from(samples), size)
    }

    /// Whether blocks of samples are narrow enough for the last harmonic: half a period is what the nodes of one can tell.
    pub(super) fn is_seen_by(&self, rows: &Rows<'_>) -> bool {
        let waves = 2.0 * self.harmonics() as f64 * turns(self.parameters[1], rows.span);
        rows.blocks().is_none_or(|blocks| waves <= blocks as f64)
    }

    /// Fits rotation and harmonics to rows.
    pub(super) fn to(rows: &Rows<'_>, size: Size) -> Result<Fourier, String> {
        let [first, last] = rows.span;
        let middle = 0.5 * first + 0.5 * last;
        let line = solve(rows, middle, &[0.0, 0.0], 0)?.1;
        let levels = rows.levels(FEWEST_BLOCKS);
        let mut parameters = vec![line[0], line[1]];
        // The line through an incomplete turn is off: few harmonics settle with it what many would blur.
        let mut few = parameters.clone();
        few.resize(2 + 2 * FEW.min(most_harmonics(rows)), 0.0);
        if settle(&levels, middle, &mut few).is_ok() {
            parameters = few;
        }
        let mut tail = Vec::new();
        let mut before = 0;
        let rounds = if size == Size::Auto { 3 } else { 2 };
        for _ in 0..rounds {
            let turns = turns(parameters[1], rows.span);
            if turns < LEAST_TURNS {
                return Err(format!(
                    "a fit by rotation and harmonics needs {LEAST_TURNS} turns of steady rotation, here are {turns:.2}"
                ));
            }
            let (count, beyond) = supported(&levels, middle, &parameters, size)?;
            tail = beyond;
            parameters.resize(2 + 2 * count, 0.0);
            settle(&levels, middle, &mut parameters)?;
            if count == before {
                break;
            }
            before = count;
        }
        Fourier::new(rows, middle, parameters, tail)
    }

    /// A fit with as many harmonics, one step of Gauss and Newton's method from this one.
    pub(super) fn again(&self, rows: &Rows<'_>) -> Result<Fourier, String> {
        Fourier::new(
            rows,
            self.middle,
            self.parameters.clone(),
            self.tail.clone(),
        )
    }

    /// One step of Gauss and Newton's method from parameters that are near.
    fn new(
        samples: &Rows<'_>,
        middle: f64,
        mut parameters: Vec<f64>,
        tail: Vec<f64>,
    ) -> Result<Fourier, String> {
        let (triangle, step) = solve(samples, middle, &parameters, parameters.len() / 2 - 1)?;
        parameters.iter_mut().zip(&step).for_each(|(p, s)| *p += s);
        let squares = squares(samples, middle, &parameters);
        let free = (samples.count - parameters.len()).max(1) as f64;
        let waves = waves(&parameters);
        let size = |derivative: usize| {
            waves
                .iter()
                .map(|[a, b]| a[derivative].hypot(b[derivative]))
                .sum()
        };
        Ok(Fourier {
            middle,
            quality: Quality {
                squares,
                parameters: parameters.len() as f64,
                sigma: (squares / free).sqrt().max(samples.floor),
                floor: samples.floor,
            },
            sizes: std::array::from_fn(size),
            waves: Periodic::new(waves, samples.count),
            spread: Spread::new(&triangle.covariance(), parameters[1], samples.count),
            parameters,
            triangle,
            tail,
            errors: None,
        })
    }

    /// Counts what errors of the samples make of the parameters as what may be wrong with them.
    pub(super) fn admit(&mut self, samples: &Samples<'_>, errors: &[Vec<f64>]) {
        let size = self.parameters.len();
        let mut sum = DMatrix::zeros(size, size);
        for errors in errors {
            let right = products(samples, self.middle, &self.parameters, errors);
            let error = DVector::from(self.triangle.normal_solve(&right));
            sum += &error * error.transpose();
        }
        self.errors = Some(Spread::new(&sum, self.parameters[1], samples.t.len()));
    }

    /// Number of harmonics.
    pub fn harmonics(&self) -> usize {
        self.parameters.len() / 2 - 1
    }

    /// How often samples this far apart count in the curve at the next one, in all: each harmonic with both its terms, as
    /// much as it goes on alike.
    pub(super) fn shared(&self, step: f64) -> f64 {
        let alike = |k: usize| (k as f64 * self.parameters[1] * step).cos();
        2.0 + (1..=self.harmonics()).map(|k| 2.0 * alike(k)).sum::<f64>()
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// c, Ω, a_1, b_1, a_2, b_2, ..., their standard errors for samples of unit variance, and the condition number of
    /// the design matrix.
    pub fn coefficients(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let (errors, condition) = self.triangle.errors();
        (self.parameters.clone(), errors, condition)
    }

    /// The curve at `t`.
    pub fn value(&self, t: f64) -> f64 {
        let angle = self.parameters[1] * (t - self.middle);
        self.parameters[0] + angle + self.waves.at(angle)[0]
    }

    /// The curve at many arguments.
    pub fn values(&self, t: &[f64]) -> Vec<f64> {
        parallel::list(t.len(), |i| self.value(t[i]))
    }

    /// The curve and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let (omega, tau) = (self.parameters[1], t - self.middle);
        let angle = omega * tau;
        let [wave, first, second, third] = self.waves.at(angle);
        let speed = omega + first;
        // Derivatives by the speed of rotation.
        let rotation = [
            tau * speed,
            speed + tau * second,
            2.0 * second + tau * third,
        ];
        let by_omega = rotation.map(|value| value / omega);
        let constant = self.parameters[0];
        let mut state = State {
            value: [constant + angle + wave, speed, second],
            covariance: self.spread.at(angle, &by_omega),
            ..State::default()
        };
        let sizes = self.sizes.iter().zip(&rotation);
        for (rounding, (size, rotation)) in state.rounding.iter_mut().zip(sizes) {
            *rounding = 4.0 * f64::EPSILON * (size + rotation.abs());
        }
        state.rounding[0] += 4.0 * f64::EPSILON * constant.abs();
        if let Some(errors) = &self.errors {
            state.bias = errors.at(angle, &by_omega);
        }
        for (variance, k) in self.tail.iter().zip(self.harmonics() + 1..) {
            // Cosine and sine of the same variance add the same everywhere.
            let rate = omega * k as f64;
            add_products(&mut state.bias, &[1.0, 0.0, -rate * rate], *variance);
            add_products(&mut state.bias, &[0.0, rate, 0.0], *variance);
        }
        state
    }
}

impl Follows for Fourier {
    fn size(&self) -> usize {
        self.parameters.len()
    }

    fn left(&self, samples: &Samples<'_>, less: &[f64]) -> Vec<f64> {
        let parameters: Vec<f64> = self
            .parameters
            .iter()
            .zip(less)
            .map(|(p, l)| p - l)
            .collect();
        let waves = Periodic::new(waves(&parameters), samples.t.len());
        samples.left(&parallel::list(samples.t.len(), |i| {
            let angle = parameters[1] * (samples.t[i] - self.middle);
            parameters[0] + angle + waves.at(angle)[0]
        }))
    }

    fn followed(&self, samples: &Samples<'_>, errors: &[f64]) -> Vec<f64> {
        let right = products(samples, self.middle, &self.parameters, errors);
        self.triangle.normal_solve(&right)
    }
}

/// The harmonics of a curve with three derivatives in time.
fn waves(parameters: &[f64]) -> Waves<4> {
    let mut waves = vec![[[0.0; 4]; 2]];
    for (pair, k) in parameters[2..].chunks_exact(2).zip(1..) {
        let [a, b] = [pair[0], pair[1]];
        let rate = parameters[1] * f64::from(k);
        let [first, second, third] = [rate, -rate * rate, -rate * rate * rate];
        waves.push([
            [a, first * b, second * a, third * b],
            [b, -first * a, second * b, -third * a],
        ]);
    }
    waves
}
