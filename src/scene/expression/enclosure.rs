//! Enclosures of the values of an expression.

use super::{Expression, FUNCTIONS_1, FUNCTIONS_2, Op, STACK};
use crate::numeric::enclosure::Enclosed;
use crate::scene::Variable;

impl Expression {
    /// All its values where the variables have these.
    pub fn enclose(&self, of: impl Fn(Variable) -> Enclosed) -> Enclosed {
        let mut stack = [Enclosed::default(); STACK];
        let mut top = 0;
        for op in &self.ops {
            match *op {
                Op::Number(value) => {
                    stack[top] = Enclosed::point(value);
                    top += 1;
                }
                Op::Variable(variable) => {
                    stack[top] = of(variable);
                    top += 1;
                }
                Op::Negate => stack[top - 1] = -stack[top - 1],
                Op::Call1(f) => stack[top - 1] = FUNCTIONS_1[f].2(stack[top - 1]),
                binary => {
                    top -= 1;
                    let (a, b) = (stack[top - 1], stack[top]);
                    stack[top - 1] = match binary {
                        Op::Add => a + b,
                        Op::Subtract => a - b,
                        Op::Multiply => a * b,
                        Op::Divide => a.divided_by(b),
                        Op::Power => a.power(b),
                        Op::Call2(f) => FUNCTIONS_2[f].2(a, b),
                        _ => Enclosed::UNKNOWN,
                    };
                }
            }
        }
        stack[0]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::numeric::enclosure::{Interval, Rectangle};
    use crate::scene::Instant;

    const FORMULAS: [&str; 27] = [
        "2 - 0.01*t + 0.3*sin(2*t)*cos(t)",
        "tan(t/3)",
        "asin(t/10) - acos(t/12) + atan(t) + atan2(t, 2) + atan2(3, t)",
        "atan2(-4, t) + atan2(t - 9, t)",
        "sinh(t/2)*cosh(t/3) - tanh(t)",
        "exp(-((t - 1)/0.4)^2)",
        "ln(t + 5)/log10(t + 6)",
        "sqrt(t + 4.5) - 1/(t + 7)",
        "abs(t)*t + abs(t - 9) - abs(t + 9)",
        "floor(t)",
        "sign(t - 1)*step(t + 1)",
        "step(t) - 2*step(-t)",
        "min(t, 2 - t) + max(0, 1 - t^2)",
        "mod(t, 1.5)",
        "mod(t, -2)",
        "mod(t - 4, 30)",
        "(t - 1)^3 - (t + 1)^-2",
        "t^2 - t^7 + 3*t^0",
        "2^t - (t + 8)^1.5",
        "(t + 5)^t",
        "(t*t)^0.5",
        "1/t",
        "max(0, sqrt(t - 1))",
        "exp(t)/(1 + exp(t))",
        "-t^2 + 0.5*sin(3*t)^2",
        "1/(1 + (t/0.3)^2)",
        "t/(t + 0.1)",
    ];

    fn now(t: f64) -> Instant {
        Instant {
            t,
            ..Instant::default()
        }
    }

    /// A sequence without pattern in [0, 1): fractional parts of multiples of the golden ratio.
    fn spread(i: u32) -> f64 {
        (f64::from(i) * 0.618_033_988_749_894_9).fract()
    }

    #[test]
    fn values_lie_in_their_enclosure() {
        for text in FORMULAS {
            let expression = Expression::parse(text).unwrap();
            for i in 0..400 {
                let from = 8.0 * spread(i) - 4.0;
                let width = 10f64.powf(-3.0 * spread(7 * i + 3));
                let over = Interval::new(from, from + width);
                let enclosed = expression.enclose(|_| Enclosed::variable(over, 3.0));
                for k in 0..40 {
                    let value = expression.value(&now(from + width * spread(k)));
                    if value.is_finite() {
                        let room = 1e-12 * (1.0 + value.abs());
                        let real = enclosed.real.widened(room);
                        assert!(real.contains(value), "{text} over {over:?}: {value}");
                    } else {
                        assert!(enclosed.real.half().is_infinite(), "{text} over {over:?}");
                    }
                }
            }
        }
    }

    /// Points of the ellipse, each as a rectangle of no size, lie in the rectangle of the whole.
    #[test]
    fn values_in_the_plane_lie_in_their_enclosure() {
        let mut seen = 0;
        for text in FORMULAS {
            let expression = Expression::parse(text).unwrap();
            for i in 0..200 {
                let from = 8.0 * spread(i) - 4.0;
                let width = 10f64.powf(-3.0 * spread(5 * i + 1));
                let over = Interval::new(from, from + width);
                let whole = Enclosed::variable(over, 3.0);
                let Some(plane) = expression.enclose(|_| whole).plane else {
                    continue;
                };
                let (half, middle) = (over.half(), over.middle());
                for k in 0..20 {
                    let (sin, cos) = (TAU * spread(k)).sin_cos();
                    let point = Rectangle {
                        re: Interval::point(middle + 0.5 * half * (3.0 + 1.0 / 3.0) * cos),
                        im: Interval::point(0.5 * half * (3.0 - 1.0 / 3.0) * sin),
                    };
                    let at = Enclosed {
                        real: over,
                        plane: Some(point),
                    };
                    let value = expression.enclose(|_| at).plane.unwrap();
                    let room = 1e-9 * (1.0 + value.re.largest() + value.im.largest());
                    let inside = plane.re.widened(room).contains(value.re.middle())
                        && plane.im.widened(room).contains(value.im.middle());
                    assert!(inside, "{text} over {over:?}: {value:?} not in {plane:?}");
                    seen += 1;
                }
            }
        }
        assert!(seen > 20_000, "{seen}");
    }

    /// Against mpmath at 1/2 + i/4.
    #[test]
    fn values_in_the_plane_are_those_of_another_program() {
        let point = Rectangle {
            re: Interval::point(0.5),
            im: Interval::point(0.25),
        };
        let at = Enclosed {
            real: Interval::point(0.5),
            plane: Some(point),
        };
        for (text, re, im) in PLANE {
            let value = Expression::parse(text).unwrap().enclose(|_| at).plane;
            let value = value.unwrap();
            let off = (value.re.middle() - re).hypot(value.im.middle() - im);
            assert!(off < 1e-13, "{text}: {value:?}");
        }
    }

    const PLANE: [(&str, f64, f64); 11] = [
        ("sin(t)", 0.494485780933195, 0.22168816414957482),
        ("cos(t)", 0.9051501505596067, -0.12110879604381165),
        ("tan(t)", 0.504500702698564, 0.3124206925025888),
        ("sinh(t)", 0.504895714387995, 0.2789791283502615),
        ("cosh(t)", 1.0925708047319176, 0.12892104172809826),
        ("tanh(t)", 0.48548728102413535, 0.19805544995134952),
        ("exp(t)", 1.5974665191199127, 0.40790017007835977),
        ("ln(t)", -0.5815754049028404, 0.4636476090008061),
        ("sqrt(t)", 0.7276733451126774, 0.17178037486125622),
        ("1/t^3", 1.024, -5.632),
        ("(t + 2)^t", 1.4857938764326848, 0.4274890522557546),
    ];
}
