//! After how many turns a formula is the same again, as its syntax tree proves it.
//!
//! Each part of a formula is slope·theta plus what repeats. Waves and remainders of such a part repeat if the slope times
//! the period is a multiple of theirs; all else only repeats without a slope.

use std::f64::consts::{PI, TAU};

use super::{Expression, FUNCTIONS_1, FUNCTIONS_2, Op, power};
use crate::scene::Variable;
use crate::scene::period::{Period, Repeats, WhyNot};

/// Relative rounding of the constants of a formula, which may be quotients and products of a few others.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// slope·theta plus what repeats.
#[derive(Clone, Copy, Debug)]
struct Part {
    slope: f64,
    rest: Repeats,
    /// Of what reads no variable.
    value: Option<f64>,
}

impl Expression {
    /// Whether it is the same again after some turns, t and omega being the same.
    pub fn repeats(&self) -> Repeats {
        let mut stack: Vec<Part> = Vec::new();
        for op in &self.ops {
            let part = match *op {
                Op::Number(value) => Part::constant(value),
                Op::Variable(variable) => Part::variable(variable),
                Op::Negate => stack.pop().map(|a| a.times(-1.0)),
                Op::Call1(f) => stack.pop().map(|a| a.called(f)),
                binary => {
                    let b = stack.pop();
                    stack.pop().zip(b).map(|(a, b)| a.and(binary, b))
                }
            };
            stack.extend(part);
        }
        let whole = stack.pop().map(Part::repeating);
        whole.map_or(Repeats::Always, |whole| whole.rest)
    }
}

impl Part {
    fn constant(value: f64) -> Option<Part> {
        Some(Part {
            slope: 0.0,
            rest: Repeats::Always,
            value: Some(value),
        })
    }

    fn variable(variable: Variable) -> Option<Part> {
        let (slope, rest) = match variable {
            Variable::Theta => (1.0, Repeats::Always),
            Variable::X | Variable::V => (0.0, Repeats::After(Period::TURN)),
            Variable::T | Variable::Omega => (0.0, Repeats::Always),
        };
        Some(Part {
            slope,
            rest,
            value: None,
        })
    }

    fn times(self, factor: f64) -> Part {
        Part {
            slope: self.slope * factor,
            value: self.value.map(|value| value * factor),
            ..self
        }
    }

    /// What only repeats if the part does.
    fn repeating(self) -> Part {
        let outside = Repeats::Never(WhyNot::Outside);
        Part {
            slope: 0.0,
            rest: if self.slope == 0.0 {
                self.rest
            } else {
                outside
            },
            value: None,
        }
    }

    /// What is the same whenever the part grows by `length`.
    fn wave(self, length: f64) -> Part {
        let own = if self.slope == 0.0 {
            Repeats::Always
        } else {
            Period::near((length / self.slope).abs() / TAU, ROUNDED).into()
        };
        Part {
            slope: 0.0,
            rest: self.rest.with(own),
            value: None,
        }
    }

    /// A function of it.
    fn called(self, function: usize) -> Part {
        let (name, value, _) = FUNCTIONS_1[function];
        let part = match name {
            "sin" | "cos" => self.wave(TAU),
            "tan" => self.wave(PI),
            // It and the remainder make the part.
            "floor" => Part {
                slope: self.slope,
                ..self.wave(1.0)
            },
            _ => self.repeating(),
        };
        Part {
            value: self.value.map(value),
            ..part
        }
    }

    /// Period of two parts under an operation.
    fn and(self, op: Op, other: Part) -> Part {
        let part = match (op, self.value, other.value) {
            (Op::Add, ..) => self.plus(other),
            (Op::Subtract, ..) => self.plus(other.times(-1.0)),
            (Op::Multiply, Some(factor), _) => other.times(factor),
            (Op::Multiply, _, Some(factor)) => self.times(factor),
            (Op::Divide, _, Some(divisor)) => self.times(1.0 / divisor),
            (Op::Call2(f), _, Some(length)) if FUNCTIONS_2[f].0 == "mod" => self.wave(length),
            _ => self.repeating().plus(other.repeating()),
        };
        let values = self.value.zip(other.value);
        Part {
            value: values.map(|(a, b)| match op {
                Op::Add => a + b,
                Op::Subtract => a - b,
                Op::Multiply => a * b,
                Op::Divide => a / b,
                Op::Call2(f) => FUNCTIONS_2[f].1(a, b),
                _ => power(a, b),
            }),
            ..part
        }
    }

    fn plus(self, other: Part) -> Part {
        let sum = self.slope + other.slope;
        let rounding = ROUNDED * self.slope.abs().max(other.slope.abs());
        Part {
            slope: if sum.abs() <= rounding { 0.0 } else { sum },
            rest: self.rest.with(other.rest),
            value: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeats(text: &str) -> Repeats {
        Expression::parse(text).unwrap().repeats()
    }

    #[test]
    fn periods_follow_from_the_tree() {
        for (text, turns, parts) in [
            ("sin(theta/2)", 2, 1),
            ("sin(2*theta + 1)", 1, 2),
            ("sin(theta)^2", 1, 1),
            ("tan(theta)", 1, 2),
            ("mod(theta, 4*pi)", 2, 1),
            ("mod(theta, 12.566370614359172)", 2, 1),
            ("mod(theta - 0.3, 2*pi/3)", 1, 3),
            ("2 + 3*x - v*abs(v)", 1, 1),
            ("cos(3*theta) + sin(2*theta)*t", 1, 1),
            ("cos(4*theta) + sin(6*theta)*omega", 1, 2),
            ("sin(theta/3) + cos(theta/4)", 12, 1),
            ("sin(2*pi*theta/(4*pi) + 0.1*sin(theta))", 2, 1),
            ("exp(-((mod(theta, 4*pi) - 1)/0.1)^2)", 2, 1),
            ("step(sin(0.5*theta) - 0.2)", 2, 1),
            ("sin(theta - 2*pi*floor(theta/(2*pi)))", 1, 1),
            ("cos(1.5*theta)", 2, 3),
            ("sin(2/3*theta)", 3, 2),
            ("max(0, cos(theta - 1))/(2 + sin(theta))", 1, 1),
            ("atan2(sin(theta), cos(theta))", 1, 1),
            ("(theta + sin(theta/2)) - theta", 2, 1),
        ] {
            let expected = Repeats::After(Period::fraction(turns, parts).unwrap());
            assert_eq!(repeats(text), expected, "{text}");
        }
        for text in ["3", "omega*2 - t", "sin(omega)", "0*theta", "theta - theta"] {
            assert_eq!(repeats(text), Repeats::Always, "{text}");
        }
    }

    #[test]
    fn what_the_tree_does_not_prove_does_not_repeat() {
        for text in [
            "theta",
            "exp(-((theta-20.4)/0.035)^2)",
            "max(0, 1-((theta-27)/0.07)^2)",
            "sin(theta)*theta",
            "sin(theta*omega)",
            "sin(theta*theta)",
            "sin(theta)^theta",
            "mod(theta, x)",
            "atan2(theta, 1)",
            "floor(theta/3)",
        ] {
            assert_eq!(repeats(text), Repeats::Never(WhyNot::Outside), "{text}");
        }
        for text in [
            "sin(1.4142135623730951*theta)",
            "mod(theta, 1)",
            "mod(theta, 6.283185307)",
            "mod(theta, 0)",
            "sin(theta/0)",
        ] {
            let never = Repeats::Never(WhyNot::Incommensurable);
            assert_eq!(repeats(text), never, "{text}");
        }
        for (text, turns) in [
            ("sin(0.3333*theta)", 10000.0),
            ("sin(theta/11) + cos(theta/13)", 143.0),
        ] {
            let never = Repeats::Never(WhyNot::TooLong(turns));
            assert_eq!(repeats(text), never, "{text}");
        }
    }
}
