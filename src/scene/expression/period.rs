//! Period of a formula over the crank angle, proved by its syntax tree.
//!
//! Each subexpression is slope·theta plus a periodic rest. A sine, cosine, tangent or remainder of it has the least
//! common multiple of the rest's period and (its own)/slope; all else is periodic only without a slope.

use std::f64::consts::{PI, TAU};

use super::Expression;
use super::operand::{FUNCTIONS_1, FUNCTIONS_2, Op, Operand};
use crate::scene::Variable;
use crate::scene::period::{Period, Periodicity, WhyNot};

/// Relative rounding error of the constants of a formula, which may be quotients and products of a few others.
const CONSTANT_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Subexpression as slope·theta plus a periodic rest.
#[derive(Clone, Copy, Debug)]
struct Subexpression {
    slope: f64,
    rest: Periodicity,
    /// Value of a subexpression that reads no variable.
    value: Option<f64>,
}

impl Expression {
    /// Returns the period of the expression over the crank angle, at equal t and omega.
    pub fn repeats(&self) -> Periodicity {
        let part = self.evaluate(|variable| match variable {
            Variable::Theta => Subexpression::new(1.0, Periodicity::Always),
            Variable::X | Variable::V => Subexpression::new(0.0, Periodicity::After(Period::TURN)),
            Variable::T | Variable::Omega => Subexpression::new(0.0, Periodicity::Always),
        });
        part.repeating().rest
    }
}

impl Subexpression {
    fn new(slope: f64, rest: Periodicity) -> Subexpression {
        Subexpression {
            slope,
            rest,
            value: None,
        }
    }

    fn times(self, factor: f64) -> Subexpression {
        Subexpression::new(self.slope * factor, self.rest)
    }

    fn plus(self, other: Subexpression) -> Subexpression {
        let sum = self.slope + other.slope;
        let rounding = CONSTANT_ROUNDING * self.slope.abs().max(other.slope.abs());
        let slope = if sum.abs() <= rounding { 0.0 } else { sum };
        Subexpression::new(slope, self.rest.common(other.rest))
    }

    /// Returns the period of a function that repeats only if the subexpression has no slope.
    fn repeating(self) -> Subexpression {
        let moves = self.slope != 0.0;
        let outside = Periodicity::Never(WhyNot::Outside);
        Subexpression::new(0.0, if moves { outside } else { self.rest })
    }

    /// Returns the period of a function with the period `length` in the value of the subexpression.
    fn wave(self, length: f64) -> Subexpression {
        if self.slope == 0.0 {
            return self;
        }
        let own = Period::near((length / self.slope).abs() / TAU, CONSTANT_ROUNDING);
        Subexpression::new(0.0, self.rest.common(own.into()))
    }
}

impl Operand for Subexpression {
    fn constant(value: f64) -> Subexpression {
        Subexpression {
            value: Some(value),
            ..Subexpression::new(0.0, Periodicity::Always)
        }
    }

    fn negated(self) -> Subexpression {
        Subexpression {
            value: self.value.map(|value| -value),
            ..self.times(-1.0)
        }
    }

    fn called(self, function: usize) -> Subexpression {
        let (name, value, _) = FUNCTIONS_1[function];
        let part = match name {
            "sin" | "cos" => self.wave(TAU),
            "tan" => self.wave(PI),
            // floor(p) = p − mod(p, 1) keeps the slope of p.
            "floor" => Subexpression::new(self.slope, self.wave(1.0).rest),
            _ => self.repeating(),
        };
        Subexpression {
            value: self.value.map(value),
            ..part
        }
    }

    fn with(self, op: Op, other: Subexpression) -> Subexpression {
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
        Subexpression {
            value: values.map(|(a, b)| [a].with(op, [b])[0]),
            ..part
        }
    }
}
