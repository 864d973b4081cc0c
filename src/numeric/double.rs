//! Numbers as unevaluated sums of two floats, for what cancels: about 31 digits.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::exact::two_sum;

/// What a number must do for least squares, so that one algorithm serves both precisions.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + From<f64>
{
    /// Relative rounding error of one operation, about.
    const ROUNDING: f64;

    /// The nearest float.
    fn value(self) -> f64;

    /// Square root of a number that is not negative.
    fn root(self) -> Self;
}

impl Real for f64 {
    const ROUNDING: f64 = f64::EPSILON;

    fn value(self) -> f64 {
        self
    }

    fn root(self) -> f64 {
        self.sqrt()
    }
}

/// high + low (Dekker, Numer. Math. 18 (1971) 224).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Double {
    high: f64,
    low: f64,
}

impl Double {
    fn renormalized(high: f64, low: f64) -> Double {
        let sum = high + low;
        Double {
            high: sum,
            low: low - (sum - high),
        }
    }
}

/// The two halves of a float's digits, whose products are exact.
fn halves(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let c = SPLITTER * a;
    let high = c - (c - a);
    (high, a - high)
}

/// a·b as a rounded product and its rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

impl From<f64> for Double {
    fn from(high: f64) -> Double {
        Double { high, low: 0.0 }
    }
}

impl Add for Double {
    type Output = Double;

    fn add(self, other: Double) -> Double {
        let (high, error) = two_sum(self.high, other.high);
        let (low, rest) = two_sum(self.low, other.low);
        let first = Double::renormalized(high, error + low);
        Double::renormalized(first.high, first.low + rest)
    }
}

impl Neg for Double {
    type Output = Double;

    fn neg(self) -> Double {
        Double {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for Double {
    type Output = Double;

    fn sub(self, other: Double) -> Double {
        self + -other
    }
}

impl Mul for Double {
    type Output = Double;

    fn mul(self, other: Double) -> Double {
        let (high, low) = two_product(self.high, other.high);
        Double::renormalized(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Double;

    fn div(self, other: Double) -> Double {
        let first = self.high / other.high;
        let rest = self - other * Double::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Double::from(second);
        Double::renormalized(first, second) + Double::from(rest.high / other.high)
    }
}

impl Real for Double {
    const ROUNDING: f64 = 5e-32;

    fn value(self) -> f64 {
        self.high
    }

    fn root(self) -> Double {
        if self.high <= 0.0 {
            return Double::default();
        }
        let root = Double::from(self.high.sqrt());
        root + (self - root * root) / Double::from(2.0 * root.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_digits() {
        let third = Double::from(1.0) / Double::from(3.0);
        let rest = third * Double::from(3.0) - Double::from(1.0);
        assert!(rest.value().abs() < 1e-31, "{rest:?}");
        let root = Double::from(2.0).root();
        let rest = root * root - Double::from(2.0);
        assert!(rest.value().abs() < 1e-31, "{rest:?}");
        let small = Double::from(1.0) + Double::from(1e-25) - Double::from(1.0);
        assert!((small.value() - 1e-25).abs() < 1e-31, "{small:?}");
    }
}
