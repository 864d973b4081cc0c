//! Steady rotation plus harmonics: θ = c + Ω τ + Σ a_k cos kΩτ + b_k sin kΩτ, τ counted from the middle of the record.

use nalgebra::{DMatrix, DVector};

use super::condensed::Rows;
use super::design::{columns, harmonics, solve, squares, value, values};
use super::rotation::{most_harmonics, settle, supported, turns};
use super::spread::Spread;
use super::triangle::Triangle;
use super::{Kind, Quality, Samples, Size, State, add_products};
use crate::numeric::parallel;

/// Harmonics with which the rotation is found first.
const FEW: usize = 3;

/// Fewest blocks that are taken for a rotation that is not known yet.
const FEWEST_BLOCKS: usize = 256;

/// A fitted steady rotation with harmonics.
#[derive(Clone, Debug)]
pub struct Fourier {
    middle: f64,
    /// c, Ω, a_1, b_1, a_2, b_2, ...
    parameters: Vec<f64>,
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
            if turns < 1.2 {
                return Err(format!(
                    "a fit by rotation and harmonics needs more than one turn in one sense, here are {turns:.2}"
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
        Ok(Fourier {
            middle,
            quality: Quality {
                squares,
                parameters: parameters.len() as f64,
                sigma: (squares / free).sqrt().max(samples.floor),
                floor: samples.floor,
            },
            spread: Spread::new(&triangle.covariance(), parameters[1]),
            parameters,
            triangle,
            tail,
            errors: None,
        })
    }

    /// Counts what errors of the samples make of the parameters as what may be wrong with them.
    pub(super) fn admit(&mut self, samples: &Samples<'_>, errors: &[Vec<f64>]) {
        let right = samples.products(self.parameters.len(), errors, |t, take| {
            let mut list = Vec::with_capacity(self.parameters.len());
            columns(t - self.middle, &self.parameters, &mut list);
            let columns = list.iter().enumerate();
            columns.for_each(|(term, column)| take(term, column[0]));
        });
        let size = self.parameters.len();
        let mut sum = DMatrix::zeros(size, size);
        for right in &right {
            let error = DVector::from(self.triangle.normal_solve(right));
            sum += &error * error.transpose();
        }
        self.errors = Some(Spread::new(&sum, self.parameters[1]));
    }

    /// Number of harmonics.
    pub fn harmonics(&self) -> usize {
        self.parameters.len() / 2 - 1
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
        value(t - self.middle, &self.parameters)
    }

    /// The curve at many arguments.
    pub fn values(&self, t: &[f64]) -> Vec<f64> {
        parallel::lanes(t, |t| values(&t.map(|t| t - self.middle), &self.parameters))
    }

    /// The curve and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let mut list = Vec::with_capacity(self.parameters.len());
        let value = columns(t - self.middle, &self.parameters, &mut list);
        let mut state = State {
            value: [value[0], value[1], value[2]],
            ..State::default()
        };
        for (column, parameter) in list.iter().zip(&self.parameters) {
            for (rounding, value) in state.rounding.iter_mut().zip(column) {
                *rounding += 4.0 * f64::EPSILON * (value * parameter).abs();
            }
        }
        let angle = self.parameters[1] * (t - self.middle);
        state.covariance = self.spread.at(angle, &list);
        if let Some(errors) = &self.errors {
            state.bias = errors.at(angle, &list);
        }
        let (omega, tau) = (self.parameters[1], t - self.middle);
        let beyond = harmonics(omega * tau).zip(1..).skip(self.harmonics());
        for (variance, ((sin, cos), k)) in self.tail.iter().zip(beyond) {
            let rate = omega * f64::from(k);
            let squared = rate * rate;
            let waves = [
                [cos, -rate * sin, -squared * cos],
                [sin, rate * cos, -squared * sin],
            ];
            for wave in &waves {
                add_products(&mut state.bias, wave, *variance);
            }
        }
        state
    }
}
