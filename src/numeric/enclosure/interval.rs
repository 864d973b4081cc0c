//! Intervals of real numbers (Moore, Interval Analysis, 1966). Bounds are rounded to nearest: what that leaves out is
//! rounding of the values themselves.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::{Add, Mul, Neg, Sub};

/// All numbers from one to another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// The least of them.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

impl Interval {
    /// Every number: nothing is known.
    pub const WHOLE: Interval = Interval {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Between two bounds; the whole line where one is none.
    pub fn new(low: f64, high: f64) -> Interval {
        if low.is_nan() || high.is_nan() {
            return Interval::WHOLE;
        }
        Interval { low, high }
    }

    /// Between two numbers in either order.
    pub fn between(a: f64, b: f64) -> Interval {
        if a <= b {
            Interval::new(a, b)
        } else {
            Interval::new(b, a)
        }
    }

    /// One number.
    pub fn point(at: f64) -> Interval {
        Interval::new(at, at)
    }

    /// The middle of it.
    pub fn middle(self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// Half its width.
    pub fn half(self) -> f64 {
        0.5 * (self.high - self.low)
    }

    /// The largest magnitude in it.
    pub fn largest(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Whether a number lies in it.
    pub fn contains(self, at: f64) -> bool {
        self.low <= at && at <= self.high
    }

    /// The least interval that holds both.
    pub fn hull(self, other: Interval) -> Interval {
        Interval::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Wider by so much on both sides.
    pub fn widened(self, by: f64) -> Interval {
        Interval::new(self.low - by, self.high + by)
    }

    /// Squares.
    pub fn square(self) -> Interval {
        let [a, b] = [self.low * self.low, self.high * self.high];
        let least = if self.contains(0.0) { 0.0 } else { a.min(b) };
        Interval::new(least, a.max(b))
    }

    /// 1/x; the whole line around zero.
    pub fn reciprocal(self) -> Interval {
        if self.contains(0.0) {
            return Interval::WHOLE;
        }
        Interval::new(1.0 / self.high, 1.0 / self.low)
    }

    /// The values of a function that does not fall.
    pub fn rising(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval::new(f(self.low), f(self.high))
    }

    /// Sines.
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

    /// Cosines.
    pub fn cos(self) -> Interval {
        (self + Interval::point(FRAC_PI_2)).sin()
    }

    /// Hyperbolic cosines.
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
        if ends.iter().any(|end| end.is_nan()) {
            return Interval::WHOLE;
        }
        let none = Interval {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        ends.iter().fold(none, |hull, end| Interval {
            low: hull.low.min(*end),
            high: hull.high.max(*end),
        })
    }
}
