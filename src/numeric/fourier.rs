//! Fourier coefficients of a cycle from samples at the nodes of a quadrature.

use std::f64::consts::TAU;

/// Highest order in the outputs, per turn.
pub const HIGHEST_ORDER: u32 = 12;

/// Values at a node of a quadrature over the cycle.
#[derive(Clone, Copy, Debug)]
pub struct Sample<const N: usize> {
    /// Place in the cycle, from 0 to 1.
    pub at: f64,
    /// Weight of the node; the sum over the cycle is 1.
    pub weight: f64,
    /// Values of the columns.
    pub values: [f64; N],
}

/// Returns the means of the columns times cosine and sine of order k of the cycle: half the Fourier coefficients.
pub fn coefficients<const N: usize>(
    samples: impl IntoIterator<Item = Sample<N>>,
    k: u32,
) -> [[f64; 2]; N] {
    let mut sums = [[0.0, 0.0]; N];
    for sample in samples {
        let (sin, cos) = (TAU * f64::from(k) * sample.at).sin_cos();
        for ([even, odd], value) in sums.iter_mut().zip(sample.values) {
            *even += sample.weight * value * cos;
            *odd += sample.weight * value * sin;
        }
    }
    sums
}
