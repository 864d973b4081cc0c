//! Fourier coefficients of a cycle from equidistant samples, by the rectangle rule.

use std::f64::consts::TAU;

/// Highest order in the outputs, per turn.
pub const HIGHEST_ORDER: u32 = 12;
/// Samples of a turn: the rectangle rule is exact for signals of orders below this less the highest.
pub const SAMPLES_PER_TURN: u32 = 1024;

/// Returns the means of the columns times cosine and sine of order k of the cycle: half the Fourier coefficients.
pub fn coefficients<const N: usize>(samples: &[[f64; N]], k: u32) -> [[f64; 2]; N] {
    let count = samples.len() as f64;
    let mut sums = [[0.0, 0.0]; N];
    for (index, sample) in samples.iter().enumerate() {
        let (sin, cos) = (TAU * f64::from(k) * index as f64 / count).sin_cos();
        for ([even, odd], value) in sums.iter_mut().zip(sample) {
            *even += value * cos / count;
            *odd += value * sin / count;
        }
    }
    sums
}
