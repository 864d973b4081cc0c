//! How many terms of a polynomial stand out from errors of samples that depend on each other.
//!
//! A polynomial of high degree follows rounding to coarse steps. Beside such a one the samples lie at the same place of
//! their steps for long, and errors that follow from these places look smooth: slight errors of the second derivative. The
//! places are to be taken from fewer terms.

use super::dependent::{Dependent, Follows, Scattered};
use super::{Polynomial, Samples};
use crate::numeric::parallel;

/// Standard deviations from which on a term stands out.
const OUT: f64 = 3.0;

/// The first terms of a polynomial.
pub(super) struct Terms<'a> {
    polynomial: &'a Polynomial,
    coefficients: Vec<f64>,
}

impl Terms<'_> {
    /// The fewest terms beside which no other one stands out from noise and from such errors.
    pub fn outstanding<'a>(
        polynomial: &'a Polynomial,
        samples: &Samples<'_>,
        errors: Dependent<'_>,
    ) -> Terms<'a> {
        let some = Scattered::of(samples);
        let (noise, coefficients) = polynomial.all_terms();
        let size = coefficients.len();
        let terms = |number: usize| Terms {
            polynomial,
            coefficients: coefficients[..number].to_vec(),
        };
        let stands_out = |number: usize| {
            let left = terms(number).left(&some.samples(), &vec![0.0; number]);
            let errors = errors.beside(&some.chosen, &left);
            let products = some.samples().products(size, &errors, |t, take| {
                polynomial.terms(size, t, take);
            });
            let products: Vec<Vec<f64>> = products.into_iter().map(|p| some.weighted(p)).collect();
            let of_errors = |k: usize| -> f64 {
                let products = products.iter().map(|product| product[k]);
                products.map(|product| product * product).sum()
            };
            (number..size).any(|k| coefficients[k].powi(2) > OUT * OUT * (noise + of_errors(k)))
        };
        let (mut low, mut high) = (0, polynomial.degree() + 1);
        while high - low > 1 {
            let middle = usize::midpoint(low, high);
            if stands_out(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        terms(high)
    }
}

impl Follows for Terms<'_> {
    fn size(&self) -> usize {
        self.coefficients.len()
    }

    fn left(&self, samples: &Samples<'_>, less: &[f64]) -> Vec<f64> {
        let pairs = self.coefficients.iter().zip(less);
        let coefficients: Vec<f64> = pairs.map(|(c, less)| c - less).collect();
        samples.left(&parallel::list(samples.t.len(), |i| {
            let mut sum = 0.0;
            let take = |j: usize, term: f64| sum += coefficients[j] * term;
            self.polynomial.terms(self.size(), samples.t[i], take);
            sum
        }))
    }

    fn followed(&self, samples: &Samples<'_>, errors: &[f64]) -> Vec<f64> {
        let terms = |t: f64, take: &mut dyn FnMut(usize, f64)| {
            self.polynomial.terms(self.size(), t, take);
        };
        let errors = [errors.to_vec()];
        samples.products(self.size(), &errors, terms).concat()
    }
}
