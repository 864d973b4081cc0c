//! Polynomials of any degree.

use super::choice::{best, undecided};
use super::condensed::Rows;
use super::decay::Decay;
use super::{Kind, MOST_IN_DOUBLE, Powers, Quality, Samples, Size, State, add_products};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::orthogonal::{self, Expansion};
use crate::numeric::parallel;
use crate::numeric::real::Real;

/// The highest degree that is chosen from the samples; of so many that arithmetic is double, the lower one.
const MOST: [usize; 2] = [80, 40];

/// Terms beyond the last one whose part in the error is estimated.
const TAIL: usize = 4;

/// Arguments for which it is evaluated at a time.
const LANES: usize = 8;

/// Near the ends of the samples the second derivative of an orthonormal term grows with this power of its degree, squared.
const GROWTH: i32 = 8;

/// A fitted polynomial, as an expansion in polynomials that are orthonormal over its samples.
#[derive(Clone, Debug)]
pub struct Polynomial {
    middle: f64,
    half: f64,
    centres: Vec<f64>,
    norms: Vec<f64>,
    /// One over each norm.
    inverses: Vec<f64>,
    coefficients: Vec<f64>,
    /// Coefficients of terms that were looked at and left out.
    left_out: Vec<f64>,
    /// Variance that noise gives each of all these.
    noise: f64,
    /// Variances of the coefficients of the terms that follow.
    tail: Vec<f64>,
    /// Coefficients that errors of the samples amount to.
    errors: Vec<Vec<f64>>,
    quality: Quality,
    powers: Powers,
    extended: bool,
    supported: usize,
    /// Whether the highest degree that may be chosen leaves out more than little.
    cut_short: bool,
}

impl Polynomial {
    /// Fits a polynomial. There must be more samples than coefficients.
    pub fn fit(samples: &Samples<'_>, size: Size) -> Polynomial {
        Polynomial::to(
            &Kind::Polynomial.rows(samples, size, samples.computed()),
            size,
        )
    }

    /// Fits a polynomial to rows.
    pub(super) fn to(rows: &Rows<'_>, size: Size) -> Polynomial {
        if rows.count <= MOST_IN_DOUBLE {
            Polynomial::with::<DoubleDouble>(rows, size, |x| x)
        } else {
            Polynomial::with::<f64>(rows, size, DoubleDouble::from)
        }
    }

    fn with<T: Real>(
        samples: &Rows<'_>,
        size: Size,
        double: impl Fn(T) -> DoubleDouble,
    ) -> Polynomial {
        let rows = samples.count;
        let least = rows as f64 * samples.floor * samples.floor;
        let automatic = size == Size::Auto;
        let most = match size {
            Size::Auto => {
                MOST[usize::from(rows > MOST_IN_DOUBLE)].min((rows.saturating_sub(2)) / 2)
            }
            Size::Fixed(degree) => degree,
        };
        let enough = |squares: &[T]| {
            let supported = best(rows, 1, 1, squares, least);
            let decay = Decay::of_sums(rows, squares, supported, least);
            let degree = match size {
                Size::Auto => decay.enough(supported, most, GROWTH),
                Size::Fixed(degree) => Some(degree),
            };
            (degree, decay)
        };
        let numbers = |values: &[T]| values.iter().map(|v| v.value()).collect::<Vec<f64>>();
        let left = T::from(samples.left);
        let all = |squares: &[T]| squares.iter().map(|s| *s + left).collect::<Vec<T>>();
        let (t, weight, target) = samples.columns();
        let mut found: Expansion<T> = orthogonal::fit(t, target, weight, |squares| {
            let squares = &all(squares);
            squares.len() <= most
                && (!automatic
                    || undecided(rows, 1, 1, squares, least)
                    || squares.len() <= enough(squares).0.unwrap_or(most))
                || squares.len() > most && squares.len() <= most + TAIL
        });
        found.squares = all(&found.squares);
        let (degree, decay) = enough(&found.squares);
        let cut_short = degree.is_none();
        let degree = degree.unwrap_or(most).min(found.coefficients.len() - 1);
        let beyond = degree + 1..found.coefficients.len().min(degree + 1 + TAIL);
        let tail = decay.beyond(beyond, GROWTH);
        let (centres, norms) = (found.centres.clone(), found.norms.clone());
        let left_out = numbers(&found.coefficients[degree + 1..]);
        found.truncate(degree);
        let parameters = found.coefficients.len();
        let supported = best(rows, 1, 1, &found.squares, least);
        let squares = found.squares[parameters - 1].value();
        let free = (rows - parameters).max(1) as f64;
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
            centres: numbers(&centres),
            inverses: norms.iter().map(|norm| 1.0 / norm.value()).collect(),
            norms: numbers(&norms),
            tail,
            errors: Vec::new(),
            left_out,
            noise: decay.noise(),
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
            cut_short,
        }
    }

    /// One of the same degree.
    pub(super) fn again(&self, rows: &Rows<'_>) -> Polynomial {
        Polynomial {
            cut_short: self.cut_short,
            ..Polynomial::to(rows, Size::Fixed(self.degree()))
        }
    }

    /// Counts what errors of the samples make of the polynomial as what may be wrong with it.
    pub(super) fn admit(&mut self, samples: &Samples<'_>, errors: &[Vec<f64>]) {
        let size = self.coefficients.len();
        let terms = |t: f64, take: &mut dyn FnMut(usize, f64)| self.terms(size, t, take);
        self.errors = samples.products(size, errors, terms);
    }

    /// Variance that noise gives the coefficient of a term, and the coefficients of all terms that were looked at.
    pub(super) fn all_terms(&self) -> (f64, Vec<f64>) {
        let all = [&self.coefficients[..], &self.left_out].concat();
        (self.noise, all)
    }

    /// The first orthonormal terms at `t`, one after the other.
    pub(super) fn terms(&self, count: usize, t: f64, mut take: impl FnMut(usize, f64)) {
        let s = (t - self.middle) / self.half;
        let (mut before, mut now) = (0.0, self.inverses[0]);
        take(0, now);
        for j in 1..count {
            let next = (s - self.centres[j - 1]) * now - self.norms[j - 1] * before;
            (before, now) = (now, next * self.inverses[j]);
            take(j, now);
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

    /// Whether the samples support more terms than were allowed.
    pub(super) fn is_cut_short(&self) -> bool {
        self.cut_short
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
        let mut sum = 0.0;
        let terms = self.coefficients.len();
        self.terms(terms, t, |j, q| sum += self.coefficients[j] * q);
        sum
    }

    /// The polynomial at many arguments, several of them side by side.
    pub fn values(&self, t: &[f64]) -> Vec<f64> {
        parallel::lanes::<LANES>(t, |t| {
            let s = t.map(|t| (t - self.middle) / self.half);
            let (mut before, mut now) = ([0.0; LANES], [self.inverses[0]; LANES]);
            let mut sum = now.map(|q| self.coefficients[0] * q);
            let terms = self.coefficients.iter().zip(&self.inverses).skip(1);
            let recurrence = self.centres.iter().zip(&self.norms);
            for ((coefficient, inverse), (centre, norm)) in terms.zip(recurrence) {
                for lane in 0..LANES {
                    let next = (s[lane] - centre) * now[lane] - norm * before[lane];
                    (before[lane], now[lane]) = (now[lane], next * inverse);
                    sum[lane] += coefficient * now[lane];
                }
            }
            sum
        })
    }

    /// The polynomial and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let s = (t - self.middle) / self.half;
        let per = 1.0 / self.half;
        let mut state = State::default();
        let mut before = [0.0; 3];
        let mut now = [self.inverses[0], 0.0, 0.0];
        let mut errors = vec![[0.0; 3]; self.errors.len()];
        let terms = self.coefficients.len();
        for j in 0..terms + self.tail.len() {
            if let Some(c) = self.coefficients.get(j) {
                for (k, q) in now.iter().enumerate() {
                    state.value[k] += c * q;
                    state.rounding[k] += (c * q).abs();
                }
                add_products(&mut state.covariance, &now, 1.0);
                for (error, coefficients) in errors.iter_mut().zip(&self.errors) {
                    error
                        .iter_mut()
                        .zip(now)
                        .for_each(|(e, q)| *e += coefficients[j] * q);
                }
            } else {
                add_products(&mut state.bias, &now, self.tail[j - terms]);
            }
            let Some(inverse) = self.inverses.get(j + 1) else {
                break;
            };
            let (x, back) = (s - self.centres[j], self.norms[j]);
            // q_{-1} is zero, whatever the first norm.
            let next = [
                (x * now[0] - back * before[0]) * inverse,
                (x * now[1] + per * now[0] - back * before[1]) * inverse,
                (x * now[2] + 2.0 * per * now[1] - back * before[2]) * inverse,
            ];
            before = now;
            now = next;
        }
        for error in &errors {
            add_products(&mut state.bias, error, 1.0);
        }
        for rounding in &mut state.rounding {
            *rounding *= 2.0 * f64::EPSILON;
        }
        state
    }
}
