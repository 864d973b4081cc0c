//! Number types of least squares: double and double-double precision.

use std::ops::{Add, Div, Mul, Sub};

use super::double_double::DoubleDouble;

/// Operations that least squares needs of a number: one algorithm serves both precisions.
pub trait Real:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + From<f64>
{
    /// Returns the nearest float.
    fn value(self) -> f64;

    /// Returns the square root of a number that is not negative.
    fn root(self) -> Self;
}

impl Real for f64 {
    fn value(self) -> f64 {
        self
    }

    fn root(self) -> f64 {
        self.sqrt()
    }
}

impl Real for DoubleDouble {
    fn value(self) -> f64 {
        DoubleDouble::value(self)
    }

    fn root(self) -> DoubleDouble {
        // Rounding may have left a sum of squares below zero.
        if self.value() <= 0.0 {
            return DoubleDouble::ZERO;
        }
        self.sqrt()
    }
}
