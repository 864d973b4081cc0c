//! Intervals of real numbers (Moore, Interval Analysis, 1966). Bounds are rounded to nearest: the enclosed values
//! exceed them by rounding at most.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::{Add, Mul, Neg, Sub};

/// Interval of all numbers from one to another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// Least number.
    pub low: f64,
    /// Greatest number.
    pub high: f64,
}

impl Interval {
    /// Whole line: nothing is known.
    pub const WHOLE: Interval = Interval {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Returns the interval between two bounds; the whole line where one is NaN.
    pub const fn new(low: f64, high: f64) -> Interval {
        if low.is_nan() || high.is_nan() {
            return Interval::WHOLE;
        }
        Interval { low, high }
    }

    /// Returns the interval between two numbers in either order.
    pub fn between(a: f64, b: f64) -> Interval {
        if a <= b {
            Interval::new(a, b)
        } else {
            Interval::new(b, a)
        }
    }

    /// Returns the interval of one number.
    pub const fn point(at: f64) -> Interval {
        Interval::new(at, at)
    }

    /// Returns the middle.
    pub fn middle(self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// Returns half the width.
    pub fn half(self) -> f64 {
        0.5 * (self.high - self.low)
    }

    /// Returns the largest magnitude.
    pub fn largest(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Whether a number lies in the interval.
    pub fn contains(self, at: f64) -> bool {
        self.low <= at && at <= self.high
    }

    /// Returns the least interval that holds both.
    pub fn hull(self, other: Interval) -> Interval {
        Interval::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Returns the interval widened by `by` on both sides.
    pub fn widened(self, by: f64) -> Interval {
        Interval::new(self.low - by, self.high + by)
    }

    /// Encloses the squares.
    pub fn square(self) -> Interval {
        let [a, b] = [self.low * self.low, self.high * self.high];
        let least = if self.contains(0.0) { 0.0 } else { a.min(b) };
        Interval::new(least, a.max(b))
    }

    /// Encloses 1/x; the whole line around zero.
    pub fn reciprocal(self) -> Interval {
        if self.contains(0.0) {
            return Interval::WHOLE;
        }
        Interval::new(1.0 / self.high, 1.0 / self.low)
    }

    /// Encloses the values of a function that does not fall.
    pub fn rising(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval::new(f(self.low), f(self.high))
    }

    /// Encloses the sines.
    pub fn sin(self) -> Interval {
        let peak = |at: f64| ((self.low - at) / TAU).ceil() * TAU + at <= self.high;
        let (a, b) = (self.low.sin(), self.high.sin());
        let width = self.high - self.low;
        if width.is_nan() || width >= TAU {
            return Interval::new(-1.0, 1.0);
        }
        let low = if peak(-FRAC_PI_2) { -1.0 } else { a.min(b) };
        let high = if peak(FRAC_PI_2) { 1.0 } else { a.max(b) };
        Interval::new(low, high)
    }

    /// Encloses the cosines.
    pub fn cos(self) -> Interval {
        (self + Interval::point(FRAC_PI_2)).sin()
    }

    /// Encloses the hyperbolic cosines.
    pub fn cosh(self) -> Interval {
        let [a, b] = [self.low.cosh(), self.high.cosh()];
        let least = if self.contains(0.0) { 1.0 } else { a.min(b) };
        Interval::new(least, a.max(b))
    }
}

impl Add for Interval {
    type Output = Interval;

    fn add(self, other: Interval) -> Interval {
        Interval::new(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Interval;

    fn sub(self, other: Interval) -> Interval {
        Interval::new(self.low - other.high, self.high - other.low)
    }
}

impl Neg for Interval {
    type Output = Interval;

    fn neg(self) -> Interval {
        Interval::new(-self.high, -self.low)
    }
}

impl Mul for Interval {
    type Output = Interval;

    fn mul(self, other: Interval) -> Interval {
        let ends = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        // NaN also of infinities of both signs.
        if ends.iter().sum::<f64>().is_nan() {
            return Interval::WHOLE;
        }
        let [a, b, c, d] = ends;
        Interval {
            low: a.min(b).min(c.min(d)),
            high: a.max(b).max(c.max(d)),
        }
    }
}
