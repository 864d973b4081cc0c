//! Enclosures of the values of an expression.

use super::{Expression, FUNCTIONS_1, FUNCTIONS_2, Op, Operand};
use crate::numeric::enclosure::Enclosed;
use crate::scene::Variable;

impl Expression {
    /// All its values where the variables have these.
    pub fn enclose(&self, of: impl Fn(Variable) -> Enclosed) -> Enclosed {
        self.evaluate(of)
    }
}

impl Operand for Enclosed {
    fn constant(value: f64) -> Enclosed {
        Enclosed::point(value)
    }

    fn negated(self) -> Enclosed {
        -self
    }

    fn called(self, function: usize) -> Enclosed {
        FUNCTIONS_1[function].2(self)
    }

    fn with(self, op: Op, other: Enclosed) -> Enclosed {
        match op {
            Op::Add => self + other,
            Op::Subtract => self - other,
            Op::Multiply => self * other,
            Op::Divide => self.divided_by(other),
            Op::Power => self.power(other),
            Op::Call2(f) => FUNCTIONS_2[f].2(self, other),
            _ => Enclosed::UNKNOWN,
        }
    }
}
