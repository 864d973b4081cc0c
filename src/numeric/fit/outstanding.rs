//! How many terms of a polynomial stand out from errors of samples that depend on each other.
//!
//! A polynomial of high degree follows rounding to coarse steps. Beside such a one the samples lie at the same place of
//! their steps for long, and errors that follow from these places look smooth: slight errors of the second derivative. The
//! places are to be taken from fewer terms.

use super::{Polynomial, Samples};

/// Standard deviations from which on a term stands out.
const OUT: f64 = 3.0;

/// Samples that are looked at, about; of more, terms that do not stand out move them by a slight part of their errors.
const MOST: usize = 20_000;

/// Errors, independent of each other, for the samples of these numbers of which a curve leaves so much: one list for each.
pub type Dependent<'a> = &'a dyn Fn(&[usize], &[f64]) -> Vec<Vec<f64>>;

/// The fewest terms beside which no other one stands out from noise and from such errors.
pub(super) fn outstanding(
    polynomial: &Polynomial,
    samples: &Samples<'_>,
    errors: Dependent<'_>,
) -> usize {
    let stride = samples.t.len().div_ceil(MOST);
    // Even strides would see fast errors as slow ones.
    let scattered = |i: usize| {
        let part = (i as f64 * 0.618_033_988_749_895).fract();
        i * stride + (part * stride as f64) as usize
    };
    let chosen: Vec<usize> = (0..samples.t.len() / stride).map(scattered).collect();
    let of = |list: &[f64]| -> Vec<f64> { chosen.iter().map(|i| list[*i]).collect() };
    let (t, target, weight) = (of(samples.t), of(samples.target), samples.weight.map(of));
    let few = Samples {
        t: &t,
        target: &target,
        weight: weight.as_deref(),
        floor: samples.floor,
    };
    let (noise, coefficients) = polynomial.all_terms();
    let stands_out = |terms: usize| {
        let errors = errors(&chosen, &polynomial.left(&few, terms));
        let products = few.products(coefficients.len(), &errors, |t, take| {
            polynomial.terms(coefficients.len(), t, take);
        });
        let of_errors = |k: usize| -> f64 {
            let products = products.iter().map(|product| product[k] * stride as f64);
            products.map(|product| product * product).sum()
        };
        (terms..coefficients.len())
            .any(|k| coefficients[k].powi(2) > OUT * OUT * (noise + of_errors(k)))
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
    high
}
