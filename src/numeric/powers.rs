//! Conversion of an orthogonal expansion to powers of its argument, with standard errors and condition number.

use crate::numeric::double_double::{DoubleDouble, Real};
use crate::numeric::orthogonal::{Expansion, Term};

/// Polynomial in powers 1, t, t², ...
#[derive(Clone, Debug, PartialEq)]
pub struct Powers {
    /// Coefficients; NaN where cancellation leaves no digits.
    pub coefficients: Vec<f64>,
    /// Standard errors of the coefficients, for samples of unit variance.
    pub errors: Vec<f64>,
    /// Condition number, in the Frobenius norm, of the matrix of powers of the sampled arguments.
    pub condition: f64,
}

impl Powers {
    /// Converts an expansion in orthonormal polynomials. Where the arguments are far from zero, its powers have huge
    /// coefficients of alternating sign: hence the extended precision.
    pub fn new(expansion: &Expansion<DoubleDouble>) -> Powers {
        let zero = DoubleDouble::default();
        let Expansion { terms, .. } = expansion;
        let count = terms.len();
        let [middle, half] = [expansion.middle, expansion.half].map(DoubleDouble::from);
        let slope = DoubleDouble::ONE / half;
        let mut sums = vec![zero; count];
        let mut sizes = vec![0.0; count];
        let mut squares = vec![zero; count];
        let mut before = vec![zero; count];
        let mut now = vec![zero; count];
        now[0] = DoubleDouble::ONE / terms[0].norm;
        for (j, term) in terms.iter().enumerate() {
            for k in 0..=j {
                let part = term.coefficient * now[k];
                sums[k] += part;
                sizes[k] += part.value().abs();
                squares[k] += now[k] * now[k];
            }
            let Some(following) = terms.get(j + 1) else {
                break;
            };
            let shift = middle * slope + term.centre;
            let next: Vec<DoubleDouble> = (0..count)
                .map(|k| {
                    let lower = if k > 0 { now[k - 1] * slope } else { zero };
                    (lower - shift * now[k] - term.norm * before[k]) / following.norm
                })
                .collect();
            before = now;
            now = next;
        }
        let coefficient = |(sum, size): (&DoubleDouble, &f64)| {
            let lost = 1e3 * DoubleDouble::ROUNDING * size;
            if lost <= 1e-8 * sum.value().abs() || *size == 0.0 {
                sum.value()
            } else {
                f64::NAN
            }
        };
        let total: f64 = squares.iter().map(|square| square.value()).sum();
        Powers {
            coefficients: sums.iter().zip(&sizes).map(coefficient).collect(),
            errors: squares.iter().map(|square| square.root().value()).collect(),
            condition: (total * powers_over(terms, middle, half)).sqrt(),
        }
    }
}

/// Returns the sum of squares of the matrix that expands the powers of t in the orthonormal polynomials: t times a
/// polynomial is a product with the tridiagonal matrix of the recurrence.
fn powers_over(terms: &[Term<DoubleDouble>], middle: DoubleDouble, half: DoubleDouble) -> f64 {
    let count = terms.len();
    let mut column = vec![DoubleDouble::default(); count];
    column[0] = terms[0].norm;
    let mut total = 0.0;
    for _ in 0..count {
        total += column.iter().map(|c| c.value() * c.value()).sum::<f64>();
        column = (0..count)
            .map(|j| {
                let mut sum = (middle + half * terms[j].centre) * column[j];
                if j > 0 {
                    sum += half * terms[j].norm * column[j - 1];
                }
                if j + 1 < count {
                    sum += half * terms[j + 1].norm * column[j + 1];
                }
                sum
            })
            .collect();
    }
    total
}
