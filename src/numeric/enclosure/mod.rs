//! Enclosures of a function over an interval and over a complex neighbourhood of it, by interval arithmetic.
//!
//! A function that is analytic there, and differs from a constant by M at most, is a polynomial of degree n but for
//! 2M ρ⁻ⁿ/(ρ − 1), where ρ is the size of the Bernstein ellipse inside (Trefethen, Approximation Theory and
//! Approximation Practice, theorem 8.2): n + 1 nodes resolve it but for twice that error. Functions of several cases
//! (abs, min, floor, ...) are analytic where one case serves the whole interval; this case is continued into the plane.
//! Elsewhere a function is a constant but for half its range, which adds to the error that nodes leave.

mod arithmetic;
mod cases;
mod interval;
mod partition;
mod rectangle;
mod variation;

use std::f64::consts::{FRAC_PI_2, LOG10_E, PI};
use std::ops::Neg;

pub use interval::Interval;
pub use partition::{PanelResolution, partition};
pub use rectangle::Rectangle;
pub use variation::{
    CORNER_SHARE, MotionPiece, Variation, ellipses, has_pole, is_resolved_by_least_ellipse,
    resolved,
};

/// Enclosure of values over an interval and around it in the complex plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosed {
    /// Values over the interval.
    pub real: Interval,
    /// Values of an analytic function around the interval.
    pub plane: Rectangle,
    /// Largest deviation from the analytic function over the interval; zero if it is the function itself.
    pub deviation: f64,
}

impl Enclosed {
    /// Enclosure of an unknown function.
    pub const UNKNOWN: Enclosed = Enclosed {
        real: Interval::WHOLE,
        plane: Rectangle::point(0.0),
        deviation: f64::INFINITY,
    };

    /// Encloses a constant.
    pub fn point(value: f64) -> Enclosed {
        Enclosed {
            real: Interval::point(value),
            plane: Rectangle::point(value),
            deviation: 0.0,
        }
    }

    /// Encloses a variable over an interval, and in the Bernstein ellipse of this size around it.
    pub fn variable(real: Interval, ellipse: f64) -> Enclosed {
        let half = real.half();
        let [along, across] =
            [ellipse + 1.0 / ellipse, ellipse - 1.0 / ellipse].map(|axis| 0.5 * half * axis);
        let plane = Rectangle::new(real.widened(along - half), Interval::new(-across, across));
        Enclosed {
            real,
            plane,
            deviation: 0.0,
        }
    }

    /// Encloses a function that is not known to be analytic.
    pub fn not_analytic(real: Interval) -> Enclosed {
        let half = real.half();
        if !half.is_finite() {
            return Enclosed {
                real,
                ..Enclosed::UNKNOWN
            };
        }
        Enclosed {
            real,
            plane: Rectangle::point(real.middle()),
            deviation: half,
        }
    }

    /// Returns the enclosure of real values, and of those in the plane where the function is analytic.
    fn new(real: Interval, plane: Option<Rectangle>) -> Enclosed {
        match plane.filter(|plane| plane.is_finite()) {
            Some(plane) => Enclosed {
                real,
                plane,
                deviation: 0.0,
            },
            None => Enclosed::not_analytic(real),
        }
    }

    /// Returns the values in the plane, if the function is analytic.
    fn analytic(self) -> Option<Rectangle> {
        (self.deviation == 0.0).then_some(self.plane)
    }

    /// Applies an entire function.
    fn map(self, real: fn(Interval) -> Interval, plane: fn(Rectangle) -> Rectangle) -> Enclosed {
        Enclosed::new(real(self.real), self.analytic().map(plane))
    }

    /// Applies a function that rises over the interval, with its continuation into the plane.
    fn rising(
        self,
        f: impl Fn(f64) -> f64,
        plane: impl FnOnce(Rectangle) -> Option<Rectangle>,
    ) -> Enclosed {
        Enclosed::new(self.real.rising(f), self.analytic().and_then(plane))
    }

    /// Returns a constant that depends on the sign of the argument.
    fn of_sign(self, negative: f64, zero: f64, positive: f64) -> Enclosed {
        let Interval { low, high } = self.real;
        if low > 0.0 || low == 0.0 && zero == positive {
            Enclosed::point(positive)
        } else if high < 0.0 {
            Enclosed::point(negative)
        } else {
            Enclosed::not_analytic(Interval::new(negative, positive))
        }
    }

    /// Encloses the squares.
    pub fn square(self) -> Enclosed {
        self.map(Interval::square, Rectangle::square)
    }

    /// Encloses 1/z.
    pub fn reciprocal(self) -> Enclosed {
        let plane = self.analytic().and_then(Rectangle::reciprocal);
        Enclosed::new(self.real.reciprocal(), plane)
    }

    /// Encloses the quotients.
    pub fn divided_by(self, other: Enclosed) -> Enclosed {
        self * other.reciprocal()
    }

    /// Encloses the sines.
    pub fn sin(self) -> Enclosed {
        self.map(Interval::sin, Rectangle::sin)
    }

    /// Encloses the cosines.
    pub fn cos(self) -> Enclosed {
        self.map(Interval::cos, Rectangle::cos)
    }

    /// Encloses the tangents.
    pub fn tan(self) -> Enclosed {
        let within_a_branch = self.real.high - self.real.low < PI && !self.real.cos().contains(0.0);
        if within_a_branch {
            self.rising(f64::tan, |z| Some(z.sin() * z.cos().reciprocal()?))
        } else {
            Enclosed::UNKNOWN
        }
    }

    /// Encloses the inverse sines.
    pub fn asin(self) -> Enclosed {
        if self.real.largest() > 1.0 {
            return Enclosed::UNKNOWN;
        }
        self.rising(f64::asin, |z| {
            let slope = (Rectangle::point(1.0) - z.square()).sqrt()?.reciprocal()?;
            Some(z.by_slope(f64::asin, slope))
        })
    }

    /// Encloses the inverse cosines.
    pub fn acos(self) -> Enclosed {
        Enclosed::point(FRAC_PI_2) - self.asin()
    }

    /// Encloses the inverse tangents.
    pub fn atan(self) -> Enclosed {
        self.rising(f64::atan, |z| {
            let size = Rectangle::point(1.0) + z.square();
            // Elsewhere the branch points ±i are near.
            (size.re.low > 0.0).then_some(())?;
            Some(z.by_slope(f64::atan, size.reciprocal()?))
        })
    }

    /// Encloses the hyperbolic sines.
    pub fn sinh(self) -> Enclosed {
        self.rising(f64::sinh, |z| Some(z.sinh()))
    }

    /// Encloses the hyperbolic cosines.
    pub fn cosh(self) -> Enclosed {
        self.map(Interval::cosh, Rectangle::cosh)
    }

    /// Encloses the hyperbolic tangents: (1 − u)/(1 + u), u = e^(−2z), does not overflow on the right; tanh is odd.
    pub fn tanh(self) -> Enclosed {
        let right = |z: Rectangle| {
            let one = Rectangle::point(1.0);
            let u = z.times(-2.0).exp();
            Some((one - u) * (one + u).reciprocal()?)
        };
        self.rising(f64::tanh, |z| match z.re.middle() < 0.0 {
            true => right(-z).map(Neg::neg),
            false => right(z),
        })
    }

    /// Encloses e^z.
    pub fn exp(self) -> Enclosed {
        self.rising(f64::exp, |z| Some(z.exp()))
    }

    /// Encloses the natural logarithms.
    pub fn ln(self) -> Enclosed {
        if self.real.low < 0.0 {
            return Enclosed::UNKNOWN;
        }
        self.rising(f64::ln, Rectangle::ln)
    }

    /// Encloses the decimal logarithms.
    pub fn log10(self) -> Enclosed {
        self.ln() * Enclosed::point(LOG10_E)
    }

    /// Encloses the square roots.
    pub fn sqrt(self) -> Enclosed {
        if self.real.low < 0.0 {
            return Enclosed::UNKNOWN;
        }
        self.rising(f64::sqrt, Rectangle::sqrt)
    }

    /// Encloses the directions of the points (x, self), rad.
    pub fn atan2(self, x: Enclosed) -> Enclosed {
        let right_angle = Enclosed::point(FRAC_PI_2);
        if x.real.low > 0.0 {
            self.divided_by(x).atan()
        } else if self.real.low > 0.0 {
            right_angle - x.divided_by(self).atan()
        } else if self.real.high < 0.0 {
            -right_angle - x.divided_by(self).atan()
        } else {
            Enclosed::not_analytic(Interval::new(-PI, PI))
        }
    }

    /// Encloses the powers.
    pub fn power(self, exponent: Enclosed) -> Enclosed {
        let Interval { low, high } = exponent.real;
        // Higher powers use the logarithm.
        if low == high && low == low.trunc() && low.abs() <= 64.0 {
            let whole = self.to_the(low.abs() as u32);
            return if low < 0.0 { whole.reciprocal() } else { whole };
        }
        if self.real.low > 0.0 {
            (exponent * self.ln()).exp()
        } else if self.real.low == 0.0 && low == high && low > 0.0 {
            Enclosed::not_analytic(self.real.rising(|base| base.powf(low)))
        } else {
            Enclosed::UNKNOWN
        }
    }

    fn to_the(self, n: u32) -> Enclosed {
        match n {
            0 => Enclosed::point(1.0),
            1 => self,
            _ if n.is_multiple_of(2) => self.to_the(n / 2).square(),
            _ => self.to_the(n - 1) * self,
        }
    }
}
