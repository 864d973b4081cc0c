//! Conversion of an orthogonal expansion to powers of its argument, with standard errors and condition number.

use crate::numeric::double_double::DoubleDouble;
use crate::numeric::orthogonal::Expansion;
use crate::numeric::real::Real;

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
        let count = expansion.coefficients.len();
        let (middle, half) = (
            DoubleDouble::from(expansion.middle),
            DoubleDouble::from(expansion.half),
        );
        let slope = DoubleDouble::ONE / half;
        let mut sums = vec![zero; count];
        let mut sizes = vec![0.0; count];
        let mut squares = vec![zero; count];
        let mut before = vec![zero; count];
        let mut now = vec![zero; count];
        now[0] = DoubleDouble::ONE / expansion.norms[0];
        for j in 0..count {
            for k in 0..=j {
                let term = expansion.coefficients[j] * now[k];
                sums[k] += term;
                sizes[k] += term.value().abs();
                squares[k] += now[k] * now[k];
            }
            let Some(norm) = expansion.norms.get(j + 1).filter(|_| j + 1 < count) else {
                break;
            };
            let shift = middle * slope + expansion.centres[j];
            let next: Vec<DoubleDouble> = (0..count)
                .map(|k| {
                    let lower = if k > 0 { now[k - 1] * slope } else { zero };
                    (lower - shift * now[k] - expansion.norms[j] * before[k]) / *norm
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
            condition: (total * powers_over(expansion, middle, half)).sqrt(),
        }
    }
}

/// Returns the sum of squares of the matrix that expands the powers of t in the orthonormal polynomials: t times a
/// polynomial is a product with the tridiagonal matrix of the recurrence.
fn powers_over(
    expansion: &Expansion<DoubleDouble>,
    middle: DoubleDouble,
    half: DoubleDouble,
) -> f64 {
    let count = expansion.coefficients.len();
    let (centres, norms) = (&expansion.centres, &expansion.norms);
    let mut column = vec![DoubleDouble::default(); count];
    column[0] = norms[0];
    let mut total = 0.0;
    for _ in 0..count {
        total += column.iter().map(|c| c.value() * c.value()).sum::<f64>();
        column = (0..count)
            .map(|j| {
                let mut sum = (middle + half * centres[j]) * column[j];
                if j > 0 {
                    sum += half * norms[j] * column[j - 1];
                }
                if j + 1 < count {
                    sum += half * norms[j + 1] * column[j + 1];
                }
                sum
            })
            .collect();
    }
    total
}
