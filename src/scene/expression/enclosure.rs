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
