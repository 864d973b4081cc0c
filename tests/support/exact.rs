//! Numbers of about 31 digits with sine and cosine, and their Taylor series.

use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

pub use slider_crank::numeric::double_double::DoubleDouble as Dd;

/// Quarter turn, π/2, as a sum of three floats.
const QUARTER: [f64; 3] = [
    std::f64::consts::FRAC_PI_2,
    6.123233995736766e-17,
    -1.4973849048591698e-33,
];

/// Returns a full turn, 2 π.
pub fn turn() -> Dd {
    (Dd::from(QUARTER[0]) + QUARTER[1]) * 4.0
}

/// Sine and cosine for references.
pub trait SinCos {
    fn abs(self) -> Dd;

    /// Returns sine and cosine by the series around the nearest quarter turn.
    fn sin_cos(self) -> (Dd, Dd);
}

impl SinCos for Dd {
    fn abs(self) -> Dd {
        if self.value() < 0.0 { -self } else { self }
    }

    fn sin_cos(self) -> (Dd, Dd) {
        let quarters = (self.value() / QUARTER[0]).round();
        let parts = QUARTER.iter();
        let x = parts.fold(self, |x, part| x - Dd::from(quarters) * *part);
        let square = x * x;
        let [odd, even] = inverse_factorials();
        let sum = |factors: &[Dd; TERMS]| {
            let terms = factors.iter().rev();
            terms.fold(Dd::ZERO, |sum, factor| sum * square + *factor)
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

/// Number of series terms up to an eighth of a turn: (π/4)²⁸/28! is 4e-33.
const TERMS: usize = 14;

/// Returns ±1/n! for odd and for even n.
fn inverse_factorials() -> &'static [[Dd; TERMS]; 2] {
    static FACTORS: OnceLock<[[Dd; TERMS]; 2]> = OnceLock::new();
    FACTORS.get_or_init(|| {
        let mut factors = [[Dd::ZERO; TERMS]; 2];
        let mut inverse = Dd::ONE;
        for n in 0..2 * TERMS {
            if n > 0 {
                inverse = inverse / n as f64;
            }
            factors[1 - n % 2][n / 2] = if n & 2 == 0 { inverse } else { -inverse };
        }
        factors
    })
}

/// Value and first three derivatives with respect to the crank angle.
#[derive(Clone, Copy, Debug)]
pub struct Jet([Dd; 4]);

impl Jet {
    /// Returns sine and cosine of the crank angle itself.
    pub fn sin_cos(angle: f64) -> (Jet, Jet) {
        let (sin, cos) = Dd::from(angle).sin_cos();
        (Jet([sin, cos, -sin, -cos]), Jet([cos, -sin, -cos, sin]))
    }

    /// Returns the derivative of this order, rounded.
    pub fn d(&self, order: usize) -> f64 {
        self.0[order].value()
    }

    /// Returns the derivative of this order.
    pub fn exactly(&self, order: usize) -> Dd {
        self.0[order]
    }

    pub fn value(&self) -> f64 {
        self.d(0)
    }

    /// Returns the series of the derivative, whose own third derivative is unknown and set to NaN.
    pub fn derivative(self) -> Jet {
        let [_, d1, d2, d3] = self.0;
        Jet([d1, d2, d3, Dd::from(f64::NAN)])
    }

    /// Square root by y y = a: 2 y y' = a', 2 (y y'' + y'²) = a'', 2 (y y''' + 3 y' y'') = a'''.
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
    /// Product by Leibniz's rule.
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
    /// Quotient by q b = a and Leibniz's rule, one order after the other.
    fn div(self, other: Jet) -> Jet {
        let mut quotient = Jet([Dd::ZERO; 4]);
        for n in 0..4 {
            let known = (quotient * other).0[n];
            quotient.0[n] = (self.0[n] - known) / other.0[0];
        }
        quotient
    }
}
