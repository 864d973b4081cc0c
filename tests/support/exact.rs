//! Numbers as unevaluated sums of two floats, and Taylor series of them.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// high + low, about 31 digits (Dekker, Numer. Math. 18 (1971) 224).
#[derive(Clone, Copy, Debug, Default)]
pub struct Dd(f64, f64);

impl Dd {
    pub const ZERO: Dd = Dd(0.0, 0.0);

    pub fn value(self) -> f64 {
        self.0
    }

    pub fn abs(self) -> Dd {
        if self.0 < 0.0 { -self } else { self }
    }

    /// Square root, NaN below zero: one Newton step from that of the float.
    pub fn sqrt(self) -> Dd {
        if self.0 == 0.0 {
            return Dd::ZERO;
        }
        let root = self.0.sqrt();
        let rest = self - Dd::product(root, root);
        Dd(root, 0.0) + Dd(rest.0 / (2.0 * root), 0.0)
    }

    /// Sine and cosine of a float, by their series around the nearest quarter turn.
    pub fn sin_cos(angle: f64) -> (Dd, Dd) {
        // π/2 in three parts.
        const QUARTER: [f64; 3] = [
            std::f64::consts::FRAC_PI_2,
            6.123233995736766e-17,
            -1.4973849048591698e-33,
        ];
        let quarters = (angle / QUARTER[0]).round();
        let x = QUARTER
            .iter()
            .fold(Dd(angle, 0.0), |x, part| x - Dd::product(quarters, *part));
        let (mut sin, mut cos) = (Dd::ZERO, Dd::ZERO);
        let mut term = Dd(1.0, 0.0);
        for n in 0..32 {
            let signed = if n & 2 == 0 { term } else { -term };
            if n & 1 == 0 {
                cos = cos + signed;
            } else {
                sin = sin + signed;
            }
            term = term * x / Dd(f64::from(n + 1), 0.0);
        }
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    fn sum(a: f64, b: f64) -> Dd {
        let s = a + b;
        let part = s - a;
        Dd(s, (a - (s - part)) + (b - part))
    }

    fn product(a: f64, b: f64) -> Dd {
        let p = a * b;
        Dd(p, a.mul_add(b, -p))
    }
}

impl From<f64> for Dd {
    fn from(value: f64) -> Dd {
        Dd(value, 0.0)
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd(-self.0, -self.1)
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, other: Dd) -> Dd {
        let (high, low) = (Dd::sum(self.0, other.0), Dd::sum(self.1, other.1));
        let carried = Dd::sum(high.0, high.1 + low.0);
        Dd::sum(carried.0, carried.1 + low.1)
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, other: Dd) -> Dd {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, other: Dd) -> Dd {
        let p = Dd::product(self.0, other.0);
        Dd::sum(p.0, p.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div for Dd {
    type Output = Dd;
    fn div(self, other: Dd) -> Dd {
        let first = self.0 / other.0;
        let rest = self - other * Dd(first, 0.0);
        let second = rest.0 / other.0;
        let rest = rest - other * Dd(second, 0.0);
        Dd::sum(first, second) + Dd(rest.0 / other.0, 0.0)
    }
}

/// Value and the first three derivatives with respect to the crank angle.
#[derive(Clone, Copy, Debug)]
pub struct Jet([Dd; 4]);

impl Jet {
    /// Sine and cosine of the crank angle itself.
    pub fn sin_cos(angle: f64) -> (Jet, Jet) {
        let (sin, cos) = Dd::sin_cos(angle);
        (Jet([sin, cos, -sin, -cos]), Jet([cos, -sin, -cos, sin]))
    }

    /// The derivative of this order, rounded.
    pub fn d(&self, order: usize) -> f64 {
        self.0[order].value()
    }

    /// The derivative of this order.
    pub fn exactly(&self, order: usize) -> Dd {
        self.0[order]
    }

    pub fn value(&self) -> f64 {
        self.d(0)
    }

    /// The series of the derivative; its own third derivative is not known and set to NaN.
    pub fn derivative(self) -> Jet {
        let [_, d1, d2, d3] = self.0;
        Jet([d1, d2, d3, Dd::from(f64::NAN)])
    }

    /// From y y = a: 2 y y' = a', 2 (y y'' + y'²) = a'', 2 (y y''' + 3 y' y'') = a'''.
    pub fn sqrt(self) -> Jet {
        let [a0, a1, a2, a3] = self.0;
        let (half, three) = (Dd::from(0.5), Dd::from(3.0));
        let y0 = a0.sqrt();
        let y1 = half * a1 / y0;
        let y2 = (half * a2 - y1 * y1) / y0;
        let y3 = (half * a3 - three * y1 * y2) / y0;
        Jet([y0, y1, y2, y3])
    }
}

impl From<f64> for Jet {
    fn from(value: f64) -> Jet {
        Jet([Dd::from(value), Dd::ZERO, Dd::ZERO, Dd::ZERO])
    }
}

impl From<Dd> for Jet {
    fn from(value: Dd) -> Jet {
        Jet([value, Dd::ZERO, Dd::ZERO, Dd::ZERO])
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet(self.0.map(Neg::neg))
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        Jet(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;
    /// Leibniz's rule.
    fn mul(self, other: Jet) -> Jet {
        const BINOMIAL: [[f64; 4]; 4] = [
            [1.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0, 0.0],
            [1.0, 2.0, 1.0, 0.0],
            [1.0, 3.0, 3.0, 1.0],
        ];
        Jet(std::array::from_fn(|n| {
            (0..=n).fold(Dd::ZERO, |sum, k| {
                sum + Dd::from(BINOMIAL[n][k]) * self.0[k] * other.0[n - k]
            })
        }))
    }
}

impl Div for Jet {
    type Output = Jet;
    /// From q b = a by Leibniz's rule, one order after the other.
    fn div(self, other: Jet) -> Jet {
        let mut quotient = Jet([Dd::ZERO; 4]);
        for n in 0..4 {
            let known = (quotient * other).0[n];
            quotient.0[n] = (self.0[n] - known) / other.0[0];
        }
        quotient
    }
}
