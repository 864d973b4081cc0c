//! Sums, differences and products of enclosures: deviations from analytic functions add to the error of the result.

use std::ops::{Add, Mul, Neg, Sub};

use super::Enclosed;

macro_rules! with_deviation {
    ($operator:ident, $function:ident, $deviation:expr) => {
        impl $operator for Enclosed {
            type Output = Enclosed;

            fn $function(self, other: Enclosed) -> Enclosed {
                let real = self.real.$function(other.real);
                let deviation: fn(Enclosed, Enclosed) -> f64 = $deviation;
                let deviation = deviation(self, other);
                let plane = self.plane.$function(other.plane);
                if plane.is_finite() && (deviation == 0.0 || deviation < real.half()) {
                    return Enclosed {
                        real,
                        plane,
                        deviation,
                    };
                }
                Enclosed::not_analytic(real)
            }
        }
    };
}

with_deviation!(Add, add, |a, b| a.deviation + b.deviation);
with_deviation!(Sub, sub, |a, b| a.deviation + b.deviation);
with_deviation!(Mul, mul, Enclosed::deviation_of_product);

impl Enclosed {
    fn deviation_of_product(self, other: Enclosed) -> f64 {
        let (a, b) = (self.deviation, other.deviation);
        if a == 0.0 && b == 0.0 {
            return 0.0;
        }
        a * other.real.largest() + b * self.real.largest() + a * b
    }
}

impl Neg for Enclosed {
    type Output = Enclosed;

    fn neg(self) -> Enclosed {
        Enclosed {
            real: -self.real,
            plane: -self.plane,
            ..self
        }
    }
}
