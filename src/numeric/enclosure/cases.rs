//! Enclosures of functions of several cases, analytic where one case serves the whole interval.

use super::{Enclosed, Interval};

impl Enclosed {
    /// Encloses the magnitudes.
    pub fn abs(self) -> Enclosed {
        let Interval { low, high } = self.real;
        if low >= 0.0 {
            self
        } else if high <= 0.0 {
            -self
        } else {
            Enclosed::not_analytic(Interval::new(0.0, self.real.largest()))
        }
    }

    /// Encloses the floors, the largest whole numbers not above.
    pub fn floor(self) -> Enclosed {
        let real = self.real.rising(f64::floor);
        if real.low == real.high {
            Enclosed::point(real.low)
        } else {
            Enclosed::not_analytic(real)
        }
    }

    /// Encloses the signs, −1, 0 or 1.
    pub fn sign(self) -> Enclosed {
        self.of_sign(-1.0, 0.0, 1.0)
    }

    /// Encloses the unit step: 0 below zero, else 1.
    pub fn step(self) -> Enclosed {
        self.of_sign(0.0, 1.0, 1.0)
    }

    /// Encloses the greater of two functions.
    pub fn max(self, other: Enclosed) -> Enclosed {
        let (a, b) = (self.real, other.real);
        if a.low >= b.high {
            self
        } else if b.low >= a.high {
            other
        } else {
            Enclosed::not_analytic(Interval::new(a.low.max(b.low), a.high.max(b.high)))
        }
    }

    /// Encloses the lesser of two functions.
    pub fn min(self, other: Enclosed) -> Enclosed {
        -(-self).max(-other)
    }

    /// Encloses the remainder of division by the magnitude of the other, never negative.
    pub fn modulo(self, other: Enclosed) -> Enclosed {
        let by = other.abs();
        if by.real.low <= 0.0 {
            return Enclosed::UNKNOWN;
        }
        let count = self.divided_by(by).floor();
        match count.deviation {
            0.0 => self - by * count,
            _ => Enclosed::not_analytic(Interval::new(0.0, by.real.high)),
        }
    }
}
