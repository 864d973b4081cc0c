//! Rectangles of complex numbers: interval arithmetic in the plane.

use std::ops::{Add, Mul, Neg, Sub};

use super::Interval;

/// Rectangle of all complex numbers whose real and imaginary parts lie in two intervals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rectangle {
    /// Real parts.
    pub re: Interval,
    /// Imaginary parts.
    pub im: Interval,
}

impl Rectangle {
    /// Returns the rectangle of real and imaginary parts.
    pub const fn new(re: Interval, im: Interval) -> Rectangle {
        Rectangle { re, im }
    }

    /// Returns the rectangle of one real number.
    pub const fn point(at: f64) -> Rectangle {
        Rectangle::new(Interval::point(at), Interval::point(0.0))
    }

    /// Whether all bounds are finite, and far from overflow.
    pub fn is_finite(self) -> bool {
        (self.re.low.abs() + self.re.high.abs() + self.im.low.abs() + self.im.high.abs())
            .is_finite()
    }

    /// Returns the largest distance of a value from the middle.
    pub fn radius(self) -> f64 {
        self.re.half().hypot(self.im.half())
    }

    /// Encloses the squares.
    pub fn square(self) -> Rectangle {
        let product = self.re * self.im;
        Rectangle::new(self.re.square() - self.im.square(), product + product)
    }

    /// Encloses 1/z; none if zero may be inside.
    pub fn reciprocal(self) -> Option<Rectangle> {
        let size = self.re.square() + self.im.square();
        if size.low <= 0.0 {
            return None;
        }
        let by = size.reciprocal();
        Some(Rectangle::new(self.re * by, -(self.im * by)))
    }

    /// Returns the rectangle times a real number.
    pub fn times(self, by: f64) -> Rectangle {
        let by = Interval::point(by);
        Rectangle::new(self.re * by, self.im * by)
    }

    /// Encloses e^z.
    pub fn exp(self) -> Rectangle {
        let size = self.re.rising(f64::exp);
        Rectangle::new(size * self.im.cos(), size * self.im.sin())
    }

    /// Encloses ln z, where the real parts are positive; none elsewhere.
    pub fn ln(self) -> Option<Rectangle> {
        if self.re.low <= 0.0 {
            return None;
        }
        let size = self.re.square() + self.im.square();
        let half = Interval::point(0.5);
        Some(Rectangle::new(
            half * size.rising(f64::ln),
            (self.im * self.re.reciprocal()).rising(f64::atan),
        ))
    }

    /// Encloses the root with a positive real part, where the real parts are positive; none elsewhere.
    pub fn sqrt(self) -> Option<Rectangle> {
        Some(self.ln()?.times(0.5).exp())
    }

    /// Encloses sin z.
    pub fn sin(self) -> Rectangle {
        Rectangle::new(
            self.re.sin() * self.im.cosh(),
            self.re.cos() * self.im.rising(f64::sinh),
        )
    }

    /// Encloses cos z.
    pub fn cos(self) -> Rectangle {
        Rectangle::new(
            self.re.cos() * self.im.cosh(),
            -(self.re.sin() * self.im.rising(f64::sinh)),
        )
    }

    /// Returns i z.
    fn turned(self) -> Rectangle {
        Rectangle::new(-self.im, self.re)
    }

    /// Encloses sinh z = −i sin iz.
    pub fn sinh(self) -> Rectangle {
        -self.turned().sin().turned()
    }

    /// Encloses cosh z = cos iz.
    pub fn cosh(self) -> Rectangle {
        self.turned().cos()
    }

    /// Encloses an analytic function with a given slope, by the mean value theorem on a convex set.
    pub fn by_slope(self, f: impl Fn(f64) -> f64, slope: Rectangle) -> Rectangle {
        let middle = self.re.middle();
        Rectangle::point(f(middle)) + slope * (self - Rectangle::point(middle))
    }
}

impl Add for Rectangle {
    type Output = Rectangle;

    fn add(self, other: Rectangle) -> Rectangle {
        Rectangle::new(self.re + other.re, self.im + other.im)
    }
}

impl Sub for Rectangle {
    type Output = Rectangle;

    fn sub(self, other: Rectangle) -> Rectangle {
        Rectangle::new(self.re - other.re, self.im - other.im)
    }
}

impl Neg for Rectangle {
    type Output = Rectangle;

    fn neg(self) -> Rectangle {
        Rectangle::new(-self.re, -self.im)
    }
}

impl Mul for Rectangle {
    type Output = Rectangle;

    fn mul(self, other: Rectangle) -> Rectangle {
        Rectangle::new(
            self.re * other.re - self.im * other.im,
            self.re * other.im + self.im * other.re,
        )
    }
}
