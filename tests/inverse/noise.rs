//! Reproducible noise for measurements.

use std::f64::consts::TAU;

/// Generator of uniform and normal numbers (xorshift, Box-Muller).
pub struct Random(pub u64);

impl Random {
    /// Returns a uniform number from 0 to below 1.
    pub fn even(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a normal number of mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.even()).ln()).sqrt() * (TAU * self.even()).cos()
    }
}
