//! Steady rotation plus harmonics: θ = c + Ω τ + Σ a_k cos kΩτ + b_k sin kΩτ, τ counted from the middle of the record.

use super::choice::{best, undecided};
use super::condensed::Rows;
use super::decay::Decay;
use super::design::{columns, combined, harmonics, products, rounding, solve, squares, value};
use super::triangle::Triangle;
use super::{Quality, Samples, Size, State, add_products};

/// Most harmonics that are chosen from the samples.
const MOST: usize = 64;

/// Harmonics with which the rotation is found first.
const FEW: usize = 3;

/// Harmonics beyond the last one whose part in the error is estimated.
const TAIL: usize = 6;

/// The second derivative of a harmonic grows with this power of its number, squared.
const GROWTH: i32 = 4;

/// Corrections of the rotation after which a fit is given up.
const ROUNDS: usize = 40;

/// A step that gains less than this part of what noise gives a parameter settles a fit.
const SETTLED: f64 = 1e-8;

const UNSETTLED: &str = "the fit by rotation and harmonics does not settle";

/// A fitted steady rotation with harmonics.
#[derive(Clone, Debug)]
pub struct Fourier {
    middle: f64,
    /// c, Ω, a_1, b_1, a_2, b_2, ...
    parameters: Vec<f64>,
    triangle: Triangle,
    /// What makes variances of its columns.
    whitening: Vec<f64>,
    /// Variances of the coefficients of the harmonics that follow.
    tail: Vec<f64>,
    /// Changes of the parameters that errors of the samples amount to.
    errors: Vec<Vec<f64>>,
    quality: Quality,
}

impl Fourier {
    /// Fits rotation and harmonics.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn fit(samples: &Samples<'_>, size: Size) -> Result<Fourier, String> {
        let rows = Rows::new(samples, 1);
        let fit = Fourier::to(&rows, size)?;
        let periods = fit.harmonics() as f64 * fit.turns(rows.span);
        match rows.blocks() {
            // Half a period of the last harmonic in a block is what its nodes can tell.
            Some(blocks) if 2.0 * periods > blocks as f64 => {
                Fourier::to(&Rows::from(samples), size)
            }
            _ => Ok(fit),
        }
    }

    /// Turns in a span.
    fn turns(&self, [first, last]: [f64; 2]) -> f64 {
        self.parameters[1].abs() * (last - first) / std::f64::consts::TAU
    }

    /// Fits rotation and harmonics to rows.
    pub(super) fn to(samples: &Rows<'_>, size: Size) -> Result<Fourier, String> {
        let [first, last] = samples.span;
        let middle = 0.5 * first + 0.5 * last;
        let line = solve(samples, middle, &[0.0, 0.0], 0)?.1;
        let mut parameters = vec![line[0], line[1]];
        // The line through an incomplete turn is off: few harmonics settle with it what many would blur.
        let mut few = parameters.clone();
        few.resize(2 + 2 * FEW.min(most_harmonics(samples)), 0.0);
        if settle(samples, middle, &mut few).is_ok() {
            parameters = few;
        }
        let mut tail = Vec::new();
        let rounds = if size == Size::Auto { 3 } else { 2 };
        for _ in 0..rounds {
            let turns = parameters[1].abs() * (last - first) / std::f64::consts::TAU;
            if turns < 1.2 {
                return Err(format!(
                    "a fit by rotation and harmonics needs more than one turn in one sense, here are {turns:.2}"
                ));
            }
            let (count, beyond) = supported(samples, middle, &parameters, size)?;
            tail = beyond;
            parameters.resize(2 + 2 * count, 0.0);
            settle(samples, middle, &mut parameters)?;
        }
        Fourier::new(samples, middle, parameters, tail)
    }

    /// A fit with as many harmonics, one step of Gauss and Newton's method from this one.
    pub fn again(&self, samples: &Samples<'_>) -> Result<Fourier, String> {
        let samples = &Rows::new(samples, 1);
        let mut parameters = self.parameters.clone();
        let (_, step) = solve(samples, self.middle, &parameters, self.harmonics())?;
        parameters.iter_mut().zip(&step).for_each(|(p, s)| *p += s);
        Fourier::new(samples, self.middle, parameters, self.tail.clone())
    }

    fn new(
        samples: &Rows<'_>,
        middle: f64,
        parameters: Vec<f64>,
        tail: Vec<f64>,
    ) -> Result<Fourier, String> {
        let (triangle, _) = solve(samples, middle, &parameters, parameters.len() / 2 - 1)?;
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
            parameters,
            whitening: triangle.whitening(),
            triangle,
            tail,
            errors: Vec::new(),
        })
    }

    /// Counts what errors of the samples make of the parameters as what may be wrong with them.
    pub(super) fn admit(&mut self, samples: &Samples<'_>, errors: &[Vec<f64>]) {
        let right = products(samples, self.middle, &self.parameters, errors);
        self.errors = right
            .iter()
            .map(|right| self.triangle.normal_solve(right))
            .collect();
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
        for error in &self.errors {
            add_products(&mut state.bias, &combined(error, &list), 1.0);
        }
        let mut weights = self.whitening.as_slice();
        for last in 0..list.len() {
            let (row, rest) = weights.split_at(last + 1);
            add_products(&mut state.covariance, &combined(row, &list), 1.0);
            weights = rest;
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

fn most_harmonics(samples: &Rows<'_>) -> usize {
    MOST.min((samples.count / 2).saturating_sub(2) / 2)
}

/// The number of harmonics that the samples support at about this rotation, if it is not given, and the variances of
/// the coefficients of those that follow.
fn supported(
    samples: &Rows<'_>,
    middle: f64,
    parameters: &[f64],
    size: Size,
) -> Result<(usize, Vec<f64>), String> {
    let rows = samples.count;
    let least = rows as f64 * samples.floor * samples.floor;
    let most = most_harmonics(samples);
    let mut tried = match size {
        Size::Fixed(count) => (count + 2).min(most.max(count)),
        Size::Auto => 4.min(most),
    };
    loop {
        let line = &parameters[..2];
        let (triangle, _) = solve(samples, middle, line, tried)?;
        let squares = triangle
            .squares()
            .into_iter()
            .skip(2)
            .map(|s| samples.left + s);
        let squares: Vec<f64> = squares.collect();
        // Both parameters of a harmonic come together.
        let pairs: Vec<f64> = squares.iter().step_by(2).copied().collect();
        let found = best(rows, 2, 2, &pairs, least);
        if tried < most && size == Size::Auto && undecided(rows, 2, 2, &pairs, least) {
            tried = (2 * tried).min(most);
            continue;
        }
        let free = rows.saturating_sub(2 + 2 * tried).max(1) as f64;
        let noise = (pairs[tried] / free).max(least / rows as f64);
        let mut terms = vec![0.0];
        terms.extend(pairs.windows(2).map(|pair| (pair[0] - pair[1]).max(0.0)));
        let decay = Decay::of(&terms, 2.0, noise, found.max(1));
        let count = match size {
            Size::Fixed(count) => count,
            Size::Auto => decay.enough(found, most, GROWTH),
        };
        let weights: f64 = samples.iter().map(|(_, weight, _)| weight * weight).sum();
        let beyond = count + 1..count + 1 + TAIL;
        let tail = beyond.map(|k| 2.0 * decay.variance(k) / weights);
        return Ok((count, tail.collect()));
    }
}

/// Gauss and Newton's method for all parameters; a step that does not lessen the squares is halved.
fn settle(samples: &Rows<'_>, middle: f64, parameters: &mut Vec<f64>) -> Result<(), String> {
    let count = parameters.len() / 2 - 1;
    let free = (samples.count - parameters.len()).max(1) as f64;
    let mut before = squares(samples, middle, parameters);
    for _ in 0..ROUNDS {
        let (triangle, step) = solve(samples, middle, parameters, count)?;
        let sums = triangle.squares();
        let noise = (before / free).max(samples.floor * samples.floor);
        // What the step should gain, in units of what one parameter gains from noise.
        if sums[0] - sums[sums.len() - 1] <= SETTLED * noise {
            return Ok(());
        }
        let mut part = 1.0;
        let (next, after) = loop {
            let moved = parameters.iter().zip(&step).map(|(p, s)| p + part * s);
            let moved: Vec<f64> = moved.collect();
            let after = squares(samples, middle, &moved);
            if after < before || part < 1e-3 {
                break (moved, after);
            }
            part *= 0.5;
        };
        if after >= before {
            // At rounding there is nothing left to gain.
            let gain = sums[0] - sums[sums.len() - 1];
            let none = gain < 1e-6 * before || gain < rounding(samples, middle, parameters);
            return if none {
                Ok(())
            } else {
                Err(UNSETTLED.to_owned())
            };
        }
        *parameters = next;
        before = after;
    }
    Err(UNSETTLED.to_owned())
}
