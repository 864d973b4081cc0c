//! Polynomials of any degree.

use super::choice::{best, undecided};
use super::{MOST_IN_DOUBLE, Powers, Quality, Samples, Size, State, add_products};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::orthogonal::{self, Expansion};
use crate::numeric::real::Real;

/// The highest degree that is chosen from the samples.
const MOST: usize = 40;

/// Degrees that are added to the best one, so that what is left out stays below what is uncertain.
const MARGIN: usize = 2;

/// What is left out of a polynomial is taken to be as large as its last terms: two, or a tenth of all.
fn last(terms: usize) -> usize {
    (terms / 10).max(2)
}

/// A fitted polynomial, as an expansion in polynomials that are orthonormal over its samples.
#[derive(Clone, Debug)]
pub struct Polynomial {
    middle: f64,
    half: f64,
    centres: Vec<f64>,
    norms: Vec<f64>,
    coefficients: Vec<f64>,
    quality: Quality,
    powers: Powers,
    extended: bool,
    supported: usize,
}

impl Polynomial {
    /// Fits a polynomial. There must be more samples than coefficients.
    pub fn fit(samples: &Samples<'_>, size: Size) -> Polynomial {
        if samples.t.len() <= MOST_IN_DOUBLE {
            Polynomial::with::<DoubleDouble>(samples, size, |x| x)
        } else {
            Polynomial::with::<f64>(samples, size, DoubleDouble::from)
        }
    }

    fn with<T: Real>(
        samples: &Samples<'_>,
        size: Size,
        double: impl Fn(T) -> DoubleDouble,
    ) -> Polynomial {
        let rows = samples.t.len();
        let least = rows as f64 * samples.floor * samples.floor;
        let most = match size {
            Size::Auto => MOST.min((rows.saturating_sub(2)) / 2),
            Size::Fixed(degree) => degree,
        };
        let automatic = size == Size::Auto;
        let mut found: Expansion<T> =
            orthogonal::fit(samples.t, samples.target, samples.weight, |squares| {
                squares.len() <= most && (!automatic || undecided(rows, 1, 1, squares, least))
            });
        if automatic {
            let degree = best(rows, 1, 1, &found.squares, least) + MARGIN;
            found.truncate(degree.min(most));
        }
        let parameters = found.coefficients.len();
        let supported = best(rows, 1, 1, &found.squares, least);
        let squares = found.squares[parameters - 1].value();
        let free = (rows - parameters).max(1) as f64;
        let numbers = |values: &[T]| values.iter().map(|v| v.value()).collect::<Vec<f64>>();
        let convert = |values: &[T]| {
            values
                .iter()
                .map(|v| double(*v))
                .collect::<Vec<DoubleDouble>>()
        };
        let powers = Powers::new(&Expansion {
            middle: found.middle,
            half: found.half,
            centres: convert(&found.centres),
            norms: convert(&found.norms),
            coefficients: convert(&found.coefficients),
            squares: Vec::new(),
        });
        Polynomial {
            middle: found.middle,
            half: found.half,
            centres: numbers(&found.centres),
            norms: numbers(&found.norms),
            coefficients: numbers(&found.coefficients),
            quality: Quality {
                squares,
                parameters: parameters as f64,
                sigma: (squares / free).sqrt().max(samples.floor),
                floor: samples.floor,
            },
            powers,
            extended: T::ROUNDING < f64::EPSILON,
            supported,
        }
    }

    /// Its degree.
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// The degree up to which the samples support its terms.
    pub fn supported_degree(&self) -> usize {
        self.supported
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// The same polynomial in powers of the argument.
    pub fn powers(&self) -> &Powers {
        &self.powers
    }

    /// Whether it was computed in double-double arithmetic.
    pub fn extended(&self) -> bool {
        self.extended
    }

    /// The polynomial at `t`.
    pub fn value(&self, t: f64) -> f64 {
        let s = (t - self.middle) / self.half;
        let (mut before, mut now) = (0.0, 1.0 / self.norms[0]);
        let mut sum = self.coefficients[0] * now;
        for j in 1..self.coefficients.len() {
            let next = (s - self.centres[j - 1]) * now - self.norms[j - 1] * before;
            (before, now) = (now, next * (1.0 / self.norms[j]));
            sum += self.coefficients[j] * now;
        }
        sum
    }

    /// The polynomial and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let s = (t - self.middle) / self.half;
        let per = 1.0 / self.half;
        let mut state = State::default();
        let mut before = [0.0; 3];
        let mut now = [1.0 / self.norms[0], 0.0, 0.0];
        for (j, c) in self.coefficients.iter().enumerate() {
            for (k, q) in now.iter().enumerate() {
                state.value[k] += c * q;
                state.rounding[k] += (c * q).abs();
            }
            add_products(&mut state.covariance, &now, 1.0);
            if j + last(self.coefficients.len()) >= self.coefficients.len() {
                add_products(&mut state.bias, &now, c * c);
            }
            let Some(norm) = self.norms.get(j + 1) else {
                break;
            };
            let (x, back, inverse) = (s - self.centres[j], self.norms[j], 1.0 / norm);
            // q_{-1} is zero, whatever the first norm.
            let next = [
                (x * now[0] - back * before[0]) * inverse,
                (x * now[1] + per * now[0] - back * before[1]) * inverse,
                (x * now[2] + 2.0 * per * now[1] - back * before[2]) * inverse,
            ];
            before = now;
            now = next;
        }
        for rounding in &mut state.rounding {
            *rounding *= 2.0 * f64::EPSILON;
        }
        state
    }
}
