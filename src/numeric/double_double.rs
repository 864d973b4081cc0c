//! Numbers of about 31 digits: unevaluated sums of two floats (Dekker, Numer. Math. 18 (1971) 224).

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

use super::exact::two_sum;

/// high + low, where low is at most half a unit in the last place of high.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// The two-sum of numbers of which the first is the larger.
fn quick_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble {
        high,
        low: b - (high - a),
    }
}

/// A product and its rounding error, from factors split into halves of 26 bits.
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
    /// Relative rounding of one operation: some 2⁻¹⁰⁴ (Dekker).
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
    /// A turn, 2 pi.
    pub const TAU: DoubleDouble = DoubleDouble {
        high: 4.0 * DoubleDouble::QUARTER[0],
        low: 4.0 * DoubleDouble::QUARTER[1],
    };
    /// A quarter turn.
    const QUARTER: [f64; 3] = [
        std::f64::consts::FRAC_PI_2,
        6.123233995736766e-17,
        -1.4973849048591698e-33,
    ];

    /// The nearest float.
    pub fn value(self) -> f64 {
        self.high
    }

    /// Square root, not a number below zero: one Newton step from that of the float.
    pub fn sqrt(self) -> DoubleDouble {
        if self.high == 0.0 {
            return DoubleDouble::ZERO;
        }
        let root = self.high.sqrt();
        let (high, low) = product(root, root);
        let rest = self - DoubleDouble { high, low };
        quick_sum(root, rest.high / (2.0 * root))
    }

    /// Sine and cosine: the series around the nearest quarter turn.
    pub fn sin_cos(self) -> (DoubleDouble, DoubleDouble) {
        let quarters = (self.high / DoubleDouble::QUARTER[0]).round();
        let x = DoubleDouble::QUARTER.iter().fold(self, |x, part| {
            let (high, low) = product(quarters, *part);
            x - DoubleDouble { high, low }
        });
        let square = x * x;
        let [odd, even] = inverse_factorials();
        let sum = |factors: &[DoubleDouble; TERMS]| {
            let terms = factors.iter().rev();
            terms.fold(DoubleDouble::ZERO, |sum, factor| sum * square + *factor)
        };
        let (sin, cos) = (x * sum(odd), sum(even));
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}

/// Terms of the series up to an eighth of a turn: (π/4)²⁸/28! is 4e-33.
const TERMS: usize = 14;

/// ±1/n! for odd and for even n.
fn inverse_factorials() -> &'static [[DoubleDouble; TERMS]; 2] {
    static FACTORS: OnceLock<[[DoubleDouble; TERMS]; 2]> = OnceLock::new();
    FACTORS.get_or_init(|| {
        let mut factors = [[DoubleDouble::ZERO; TERMS]; 2];
        let mut inverse = DoubleDouble::ONE;
        for n in 0..2 * TERMS {
            if n > 0 {
                inverse = inverse / n as f64;
            }
            factors[1 - n % 2][n / 2] = if n & 2 == 0 { inverse } else { -inverse };
        }
        factors
    })
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

    /// Long division, three digits of a float each.
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
