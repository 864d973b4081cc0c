//! Products of the matrices of a rule with values at its points.
//!
//! The points are symmetric: even and odd parts of a function are transformed apart, with half the points each. Degrees
//! are constants, for the compiler to keep the sums in registers, two in each.

use multiversion::multiversion;

use super::{MAX_DEGREE, Values};

/// Entries of a half of the points: half of the largest degree, the middle point, and one that completes pairs of rows.
pub(super) const HALF_LENGTH: usize = MAX_DEGREE / 2 + 2;

/// Vector over half of the points or coefficients.
pub(super) type HalfVector = [f64; HALF_LENGTH];

/// Matrices of the even and the odd part, by columns.
pub(super) struct Matrices {
    pub even: [HalfVector; HALF_LENGTH],
    pub odd: [HalfVector; HALF_LENGTH],
}

impl Matrices {
    pub fn new() -> Matrices {
        Matrices {
            even: [[0.0; HALF_LENGTH]; HALF_LENGTH],
            odd: [[0.0; HALF_LENGTH]; HALF_LENGTH],
        }
    }

    /// Returns the coefficients, where the matrices give the even and the odd ones.
    pub fn coefficients<const DEGREE: usize, const ROWS: usize>(&self, values: &Values) -> Values {
        let [even, odd] = products::<DEGREE, ROWS>(self, values);
        let mut coefficients = [0.0; MAX_DEGREE + 1];
        for k in 0..DEGREE / 2 {
            coefficients[2 * k] = even[k];
            coefficients[2 * k + 1] = odd[k];
        }
        coefficients[DEGREE] = even[DEGREE / 2];
        coefficients
    }

    /// Returns the integrals from −1 to each point, where the matrices give the integrals from 0: the even part has an
    /// odd integral, and the reverse.
    pub fn integrals<const DEGREE: usize, const ROWS: usize>(&self, values: &Values) -> Values {
        let [odd, even] = products::<DEGREE, ROWS>(self, values);
        let from_start = odd[0] - even[0];
        let mut integrals = [0.0; MAX_DEGREE + 1];
        for j in 0..=DEGREE / 2 {
            integrals[j] = from_start + even[j] - odd[j];
            integrals[DEGREE - j] = from_start + even[j] + odd[j];
        }
        integrals[0] = 0.0;
        integrals
    }
}

/// Multiplies by the even and the odd part of values at the points of a degree; `ROWS` is even and more than half the
/// degree. A function of its own: where the results go on scattered, the sums would be kept one by one.
#[multiversion(targets("x86_64+avx2"))]
fn products<const DEGREE: usize, const ROWS: usize>(
    matrices: &Matrices,
    values: &Values,
) -> [[f64; ROWS]; 2] {
    let [mut of_even, mut of_odd] = [[0.0; ROWS]; 2];
    for j in 0..DEGREE / 2 {
        let (minus, plus) = (values[j], values[DEGREE - j]);
        let (even, odd) = (plus + minus, plus - minus);
        for k in 0..ROWS {
            of_even[k] += matrices.even[j][k] * even;
            of_odd[k] += matrices.odd[j][k] * odd;
        }
    }
    let middle = values[DEGREE / 2];
    for (sum, entry) in of_even.iter_mut().zip(&matrices.even[DEGREE / 2]) {
        *sum += entry * middle;
    }
    [of_even, of_odd]
}
