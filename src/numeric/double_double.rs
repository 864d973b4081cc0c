//! Double-double numbers of about 31 digits: unevaluated sums of two floats (Dekker, Numer. Math. 18 (1971) 224).

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::exact::two_sum;

/// Number high + low, where low is at most half a unit in the last place of high.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// Returns the two-sum of numbers of which the first is the larger in magnitude.
fn quick_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble {
        high,
        low: b - (high - a),
    }
}

/// Returns a product and its rounding error, from factors split into halves of 26 bits.
fn product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    let p = a * b;
    (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
}

impl DoubleDouble {
    /// Relative rounding error of one operation: about 2⁻¹⁰⁴ (Dekker).
    pub const ROUNDING: f64 = f64::EPSILON * f64::EPSILON;
    /// Zero.
    pub const ZERO: DoubleDouble = DoubleDouble {
        high: 0.0,
        low: 0.0,
    };
    /// One.
    pub const ONE: DoubleDouble = DoubleDouble {
        high: 1.0,
        low: 0.0,
    };

    /// Returns the nearest float.
    pub fn value(self) -> f64 {
        self.high
    }

    /// Returns the square root, by one Newton step from that of the float; NaN below zero.
    pub fn sqrt(self) -> DoubleDouble {
        if self.high == 0.0 {
            return DoubleDouble::ZERO;
        }
        let root = self.high.sqrt();
        let (high, low) = product(root, root);
        let rest = self - DoubleDouble { high, low };
        quick_sum(root, rest.high / (2.0 * root))
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> DoubleDouble {
        DoubleDouble { high, low: 0.0 }
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;

    fn neg(self) -> DoubleDouble {
        DoubleDouble {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl<T: Into<DoubleDouble>> Add<T> for DoubleDouble {
    type Output = DoubleDouble;

    fn add(self, other: T) -> DoubleDouble {
        let other = other.into();
        let (high, error) = two_sum(self.high, other.high);
        let (low, rest) = two_sum(self.low, other.low);
        let sum = quick_sum(high, error + low);
        quick_sum(sum.high, sum.low + rest)
    }
}

impl<T: Into<DoubleDouble>> Sub<T> for DoubleDouble {
    type Output = DoubleDouble;

    fn sub(self, other: T) -> DoubleDouble {
        self + -other.into()
    }
}

impl<T: Into<DoubleDouble>> Mul<T> for DoubleDouble {
    type Output = DoubleDouble;

    fn mul(self, other: T) -> DoubleDouble {
        let other = other.into();
        let (high, low) = product(self.high, other.high);
        quick_sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl<T: Into<DoubleDouble>> Div<T> for DoubleDouble {
    type Output = DoubleDouble;

    /// Divides by long division, with three quotient digits of one float each.
    fn div(self, other: T) -> DoubleDouble {
        let other = other.into();
        let first = self.high / other.high;
        let rest = self - other * first;
        let second = rest.high / other.high;
        let rest = rest - other * second;
        quick_sum(first, second) + rest.high / other.high
    }
}

impl<T: Into<DoubleDouble>> AddAssign<T> for DoubleDouble {
    fn add_assign(&mut self, other: T) {
        *self = *self + other;
    }
}
