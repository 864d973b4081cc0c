//! Polynomials by weighted least squares on Forsythe's orthogonal basis, of a given degree or the likeliest (Schwarz).

use super::double_double::{DoubleDouble, Real};
use super::orthogonal::{self, Expansion, Term};
use super::powers::Powers;

/// Equations `weight`·p(t) = `target` + noise of equal standard deviation.
#[derive(Clone, Copy, Debug)]
pub struct Equations<'a> {
    /// Arguments, in any order.
    pub t: &'a [f64],
    /// Right-hand sides.
    pub target: &'a [f64],
    /// Weights; none: all 1.
    pub weight: Option<&'a [f64]>,
    /// Least standard deviation of a target: that of its last digit.
    pub floor: f64,
}

/// Error: too few arguments for a polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooFewArguments {
    /// Number of different arguments.
    pub found: usize,
    /// Least number of different arguments that the polynomial needs.
    pub needed: usize,
}

/// Polynomial and its derivatives at one argument.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PolynomialState {
    /// p, p′, p″.
    pub value: [f64; 3],
    /// Covariance of p, p′ and p″, rows of the lower triangle.
    pub covariance: [f64; 6],
    /// Rounding errors of p, p′ and p″.
    pub rounding: [f64; 3],
}

/// Fitted polynomial.
#[derive(Clone, Debug)]
pub struct PolynomialFit {
    /// Coefficients of 1, t, t², ...; NaN where cancellation leaves no digits.
    pub coefficients: Vec<f64>,
    /// Standard errors of the coefficients.
    pub standard_errors: Vec<f64>,
    /// Standard deviation of the noise of a target, at least the floor.
    pub sigma: f64,
    /// Condition number of the matrix of powers, in the Frobenius norm.
    pub condition: f64,
    /// Expansion up to the highest degree that was tried.
    basis: Expansion<f64>,
    /// Standard deviation of the noise by the polynomial of each degree.
    deviations: Vec<f64>,
    rows: usize,
}

impl PolynomialFit {
    /// Fits a polynomial of a degree, or of the degree with the least criterion of Schwarz (Ann. Statist. 6 (1978)
    /// 461). Akaike's criterion takes too high a degree in one record of four, with 1.6 times the error of the second
    /// derivative, which is the wanted quantity.
    ///
    /// # Errors
    /// [`TooFewArguments`] where the equations do not determine the polynomial.
    pub fn new(
        equations: &Equations<'_>,
        degree: Option<usize>,
    ) -> Result<PolynomialFit, TooFewArguments> {
        PolynomialFit::among(equations, degree, degree)
    }

    /// Fits a polynomial of a degree, or of the likeliest one, among those up to `most`, or up to the highest that is chosen.
    ///
    /// # Errors
    /// The errors of [`PolynomialFit::new`].
    pub fn among(
        equations: &Equations<'_>,
        degree: Option<usize>,
        most: Option<usize>,
    ) -> Result<PolynomialFit, TooFewArguments> {
        let most_in_double_double = 10_000;
        if equations.t.len() <= most_in_double_double {
            PolynomialFit::with::<DoubleDouble>(equations, degree, most)
        } else {
            PolynomialFit::with::<f64>(equations, degree, most)
        }
    }

    fn with<T: Real>(
        equations: &Equations<'_>,
        degree: Option<usize>,
        most: Option<usize>,
    ) -> Result<PolynomialFit, TooFewArguments> {
        let Equations {
            t,
            target,
            weight,
            floor,
        } = *equations;
        let rows = t.len();
        let highest_chosen = 12;
        let given = most;
        let most = most.unwrap_or(rows.saturating_sub(3).min(highest_chosen));
        let too_few = |found| TooFewArguments {
            found,
            needed: most + 2,
        };
        if rows < most + 2 {
            return Err(too_few(rows));
        }
        let found: Expansion<T> = orthogonal::fit(t, target, weight, most);
        if found.terms.len() <= most && given.is_some() {
            return Err(too_few(found.terms.len()));
        }
        let basis = found.convert(most, T::value);
        let squares: Vec<f64> = basis.terms.iter().map(|term| term.squares).collect();
        let size = target.iter().fold(0.0f64, |size, y| size.max(y.abs()));
        // Targets that were computed in floats are off by some units in the last place.
        let floor_of = |size: f64| floor.max(2.0 * f64::EPSILON * size);
        let degree = degree.unwrap_or_else(|| likeliest(&squares, rows, floor_of(size)));
        let degree = degree.min(squares.len() - 1);
        let deviation = |(degree, squares): (usize, &f64)| {
            let free = (rows - degree - 1) as f64;
            (squares / free).sqrt().max(floor)
        };
        let deviations: Vec<f64> = squares.iter().enumerate().map(deviation).collect();
        let powers = Powers::new(&found.convert(degree, T::into));
        let sigma = deviations[degree];
        Ok(PolynomialFit {
            coefficients: powers.coefficients,
            standard_errors: powers.errors.iter().map(|e| e * sigma).collect(),
            sigma,
            condition: powers.condition,
            basis,
            deviations,
            rows,
        })
    }

    /// Returns the degree.
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// Returns the root mean squares of the residuals of the polynomials of degree 0, 1, ...
    pub fn residuals(&self) -> impl Iterator<Item = f64> {
        let terms = self.basis.terms.iter();
        terms.map(|term| (term.squares / self.rows as f64).sqrt())
    }

    /// Returns the polynomial and its derivatives at `t`.
    pub fn state(&self, t: f64) -> PolynomialState {
        let mut state = PolynomialState::default();
        for (q, term) in self.basis_at(t).take(self.coefficients.len()) {
            for k in 0..3 {
                let part = term.coefficient * q[k];
                state.value[k] += part;
                state.rounding[k] += 2.0 * f64::EPSILON * part.abs();
                for l in 0..=k {
                    state.covariance[entry(k, l)] += self.sigma * q[k] * (self.sigma * q[l]);
                }
            }
        }
        state
    }

    /// Returns the covariance of p, p′ and p″ at `t` where the degree is in doubt: that of each degree, with the square of its
    /// difference from this polynomial, by the weights of degree 0, 1, ...
    pub fn averaged(&self, t: f64, weights: &[f64]) -> [f64; 6] {
        let own = self.state(t).value;
        let (mut value, mut spread, mut sum) = ([0.0; 3], [0.0; 6], [0.0; 6]);
        for (j, ((q, term), weight)) in self.basis_at(t).zip(weights).enumerate() {
            let variance = self.deviations[j] * self.deviations[j];
            for k in 0..3 {
                value[k] += term.coefficient * q[k];
                for l in 0..=k {
                    let off = (value[k] - own[k]) * (value[l] - own[l]);
                    spread[entry(k, l)] += q[k] * q[l];
                    sum[entry(k, l)] += weight * (variance * spread[entry(k, l)] + off);
                }
            }
        }
        sum
    }

    /// Returns the polynomials of the basis and their first two derivatives at `t`, by the recurrence differentiated twice,
    /// with their terms.
    fn basis_at(&self, t: f64) -> impl Iterator<Item = ([f64; 3], &Term<f64>)> {
        let Expansion {
            middle,
            half,
            terms,
        } = &self.basis;
        let (s, per) = ((t - middle) / half, 1.0 / half);
        let (mut before, mut now) = ([0.0; 3], [1.0 / terms[0].norm, 0.0, 0.0]);
        terms.iter().enumerate().map(move |(j, term)| {
            let found = now;
            if let Some(following) = terms.get(j + 1) {
                let (x, back) = (s - term.centre, term.norm);
                let next = [
                    x * now[0] - back * before[0],
                    x * now[1] + per * now[0] - back * before[1],
                    x * now[2] + 2.0 * per * now[1] - back * before[2],
                ];
                (before, now) = (now, next.map(|q| q / following.norm));
            }
            (found, term)
        })
    }
}

/// Place of an entry in the rows of a lower triangle.
const fn entry(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Returns the degree with the least −2 ln(likelihood) + k ln(n), at the likeliest noise variance above the floor.
fn likeliest(squares: &[f64], rows: usize, floor: f64) -> usize {
    let n = rows as f64;
    let criterion = |degree: usize| {
        let variance = (squares[degree] / n)
            .max(floor * floor)
            .max(f64::MIN_POSITIVE);
        n * variance.ln() + squares[degree] / variance + degree as f64 * n.ln()
    };
    (0..squares.len()).fold(0, |best, degree| {
        if criterion(degree) < criterion(best) {
            degree
        } else {
            best
        }
    })
}
