//! Chebyshev series on [−1, 1] through values at the Lobatto points: evaluation, integral, derivative (Trefethen,
//! Approximation Theory and Approximation Practice, ch. 3 and 19).

mod rule;
mod transform;

pub use rule::Rule;

use super::LANES;
use multiversion::multiversion;

/// Largest degree of a series.
pub const MAX_DEGREE: usize = 32;

/// Rounding error of the last terms of a series and of an integral by a rule, relative to the largest.
pub const SERIES_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Values at the points of a rule, or coefficients; entries beyond its degree are zero.
pub type Values = [f64; MAX_DEGREE + 1];

/// Returns the largest magnitude of some values.
pub fn largest(values: &[f64]) -> f64 {
    // Four separate maxima, for the processor to compare side by side.
    let mut most = [0.0; 4];
    let larger = |most: f64, value: f64| if value > most { value } else { most };
    let chunks = values.chunks_exact(4);
    let rest = chunks.remainder().iter();
    let of_rest = rest.fold(0.0, |most, value| larger(most, value.abs()));
    for chunk in chunks {
        for k in 0..4 {
            most[k] = larger(most[k], chunk[k].abs());
        }
    }
    most.into_iter().fold(of_rest, larger)
}

/// 1/(2k), factor of Tₖ₋₁ − Tₖ₊₁ in the integral.
const HALF_RECIPROCALS: Values = {
    let mut all = [0.0; MAX_DEGREE + 1];
    let mut k = 1;
    while k <= MAX_DEGREE {
        all[k] = 0.5 / k as f64;
        k += 1;
    }
    all
};

/// Series Σ cₖ Tₖ(x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series {
    degree: usize,
    coefficients: Values,
}

impl Series {
    /// Returns the degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Builds a series from its coefficients.
    pub fn new(degree: usize, coefficients: Values) -> Series {
        Series {
            degree,
            coefficients,
        }
    }

    /// Returns the coefficient of a term.
    pub fn coefficient(&self, index: usize) -> f64 {
        self.coefficients[index]
    }

    fn terms(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }

    /// Returns the value at `x` in [−1, 1].
    pub fn value(&self, x: f64) -> f64 {
        let [value] = clenshaw(self.terms().iter().map(|c| [*c]), [x]);
        value
    }

    /// Returns the values of this series and another of its degree at `x`: two side by side take the time of one.
    pub fn values_with(&self, other: &Series, x: f64) -> [f64; 2] {
        let pairs = self.terms().iter().zip(other.terms());
        clenshaw(pairs.map(|(c, d)| [*c, *d]), [x; 2])
    }

    /// Replaces some places by the values there.
    pub fn values(&self, places: &mut [f64]) {
        values(self.terms(), places);
    }

    /// Returns the integral from −1; the term beyond the degree is left out, for it is as small as the tail.
    pub fn integral(&self) -> Series {
        let c = &self.coefficients;
        let mut result = [0.0; MAX_DEGREE + 1];
        for k in 2..MAX_DEGREE {
            result[k] = (c[k - 1] - c[k + 1]) * HALF_RECIPROCALS[k];
        }
        result[1] = c[0] - 0.5 * c[2];
        result[MAX_DEGREE] = c[MAX_DEGREE - 1] * HALF_RECIPROCALS[MAX_DEGREE];
        result[self.degree + 1..].fill(0.0);
        let (pairs, last) = result.as_chunks::<2>();
        let odd_less_even: f64 = pairs.iter().map(|[even, odd]| odd - even).sum();
        result[0] = odd_less_even - last.iter().sum::<f64>();
        Series::new(self.degree, result)
    }

    /// Returns the weighted sum of series of one degree.
    pub fn blend<'a>(parts: impl Iterator<Item = (&'a Series, f64)>) -> Series {
        let mut sum = Series::new(0, [0.0; MAX_DEGREE + 1]);
        for (series, share) in parts {
            sum.degree = series.degree;
            for (c, part) in sum.coefficients.iter_mut().zip(&series.coefficients) {
                *c += share * part;
            }
        }
        sum
    }

    /// Returns the derivative.
    pub fn derivative(&self) -> Series {
        let mut result = [0.0; MAX_DEGREE + 1];
        for k in (0..self.degree).rev() {
            let after = result.get(k + 2).copied().unwrap_or(0.0);
            result[k] = after + 2.0 * (k + 1) as f64 * self.coefficients[k + 1];
        }
        result[0] *= 0.5;
        Series::new(self.degree, result)
    }

    /// Returns the largest magnitude of the coefficients.
    pub fn largest(&self) -> f64 {
        largest(self.terms())
    }

    /// Returns the sum of the magnitudes of the last two coefficients over the largest: small where they have decayed.
    pub fn tail(&self) -> f64 {
        self.tail_at(self.degree)
    }

    /// Returns the degree at which the coefficients would reach a tail if they decayed further as between half of the
    /// degree and the degree: geometrically, for an analytic function (Trefethen, theorem 8.1). Infinite without decay.
    pub fn degree_of_tail(&self, tail: f64) -> f64 {
        let half = self.degree / 2;
        // Odd and even terms may be of unlike size.
        let at = |k: usize| largest(&self.coefficients[k - 2..=k]);
        let (middle, end, allowed) = (at(half), at(self.degree), tail * self.largest());
        if end <= allowed {
            return self.degree as f64;
        }
        let decay = (middle / end).ln() / (self.degree - half) as f64;
        self.degree as f64 + (end / allowed).ln() / decay.max(0.0)
    }

    /// Returns the tail of the series cut at a smaller degree.
    pub fn tail_at(&self, degree: usize) -> f64 {
        let largest = self.largest();
        if largest == 0.0 {
            return 0.0;
        }
        (self.coefficients[degree - 1].abs() + self.coefficients[degree].abs()) / largest
    }
}

/// Evaluates series side by side, each at its place, by Clenshaw's recurrence; `terms`: the coefficients of all.
#[inline(always)]
fn clenshaw<const N: usize>(
    mut terms: impl DoubleEndedIterator<Item = [f64; N]>,
    x: [f64; N],
) -> [f64; N] {
    let first = terms.next().unwrap_or([0.0; N]);
    let twice = x.map(|x| 2.0 * x);
    let (mut b1, mut b2) = ([0.0; N], [0.0; N]);
    for c in terms.rev() {
        for j in 0..N {
            (b1[j], b2[j]) = ((c[j] - b2[j]) + twice[j] * b1[j], b1[j]);
        }
    }
    std::array::from_fn(|j| (first[j] - b2[j]) + x[j] * b1[j])
}

/// Replaces some places by the values there of the series with some coefficients.
#[multiversion(targets("x86_64+avx2"))]
fn values(terms: &[f64], places: &mut [f64]) {
    for places in places.chunks_mut(2 * LANES) {
        let mut x = [0.0; 2 * LANES];
        x[..places.len()].copy_from_slice(places);
        let values = clenshaw(terms.iter().map(|c| [*c; 2 * LANES]), x);
        places.copy_from_slice(&values[..places.len()]);
    }
}
