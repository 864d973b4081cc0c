//! Formulas of t, theta, omega, x and v, in SI: compiles a text to postfix order and evaluates it on a stack.
//!
//! Usual mathematical precedence: `-x^2` is −(x²), `2^3^2` is 2⁹; `1e-3` is a number.

mod operand;
mod opposing;
mod parser;
mod period;

use std::fmt;

use super::{Instant, Variable, Variables};
use crate::numeric::enclosure::Enclosed;
use operand::{FUNCTIONS_1, FUNCTIONS_2, JUMPING, Op, Operand};
use parser::Parser;

/// Depth of the evaluation stack, in values; deeper expressions are refused when they are read.
const STACK_DEPTH: usize = 32;

const TOO_DEEP: &str = "the expression is nested too deeply; simplify it";

/// Expression compiled to postfix order; evaluation allocates nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    ops: Vec<Op>,
    /// Largest number of intermediate results.
    depth: usize,
    reads: Variables,
    jumps: bool,
}

/// First fault of an expression, and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Byte offset in the text.
    pub at: usize,
    /// Fault, in words.
    pub what: String,
    /// Remedy, in words.
    pub help: String,
}

impl ExpressionError {
    fn new(at: usize, what: &str) -> ExpressionError {
        ExpressionError {
            at,
            what: what.to_owned(),
            help: "write for example `2 - 0.01*omega + 0.3*sin(2*theta)`, in SI units".to_owned(),
        }
    }
}

impl Expression {
    /// Parses an expression.
    ///
    /// # Errors
    /// [`ExpressionError`] of the first fault.
    ///
    /// ```
    /// use slider_crank::scene::{Expression, Instant};
    /// let torque = Expression::parse("2 - 0.01*omega + 0.3*sin(2*theta)").unwrap();
    /// let now = Instant { omega: 100.0, ..Instant::default() };
    /// assert_eq!(torque.value(&now), 1.0);
    /// ```
    pub fn parse(text: &str) -> Result<Expression, ExpressionError> {
        Expression::parse_with(text, &|_| None)
    }

    /// Parses an expression in which names stand for other expressions, given by `symbols`.
    pub(crate) fn parse_with(
        text: &str,
        symbols: &dyn Fn(&str) -> Option<Expression>,
    ) -> Result<Expression, ExpressionError> {
        Expression::compiled(text, Parser::parse(text, symbols)?)
    }

    /// Makes the expression of operations in postfix order.
    fn compiled(text: &str, ops: Vec<Op>) -> Result<Expression, ExpressionError> {
        let (mut reads, mut jumps) = (Variables::NONE, false);
        let (mut depth, mut deepest) = (0usize, 0);
        for (at, op) in ops.iter().enumerate() {
            match *op {
                Op::Number(_) => depth += 1,
                Op::Variable(variable) => {
                    reads = reads.with(variable);
                    depth += 1;
                }
                Op::Negate => {}
                Op::Call1(f) => {
                    let of_direction =
                        matches!(ops[at - 1], Op::Variable(Variable::Omega | Variable::V));
                    let name = FUNCTIONS_1[f].0;
                    jumps |= JUMPING.contains(&name) && !(of_direction && name != "floor");
                }
                binary => {
                    depth -= 1;
                    jumps |= matches!(binary, Op::Call2(f) if JUMPING.contains(&FUNCTIONS_2[f].0));
                }
            }
            deepest = deepest.max(depth);
        }
        if deepest > STACK_DEPTH {
            return Err(ExpressionError::new(text.len(), TOO_DEEP));
        }
        Ok(Expression {
            text: text.to_owned(),
            ops,
            depth: deepest,
            reads,
            jumps,
        })
    }

    /// Creates the expression of a number.
    #[cfg(feature = "cli")]
    pub(crate) fn constant(value: f64) -> Expression {
        Expression {
            text: value.to_string(),
            ops: vec![Op::Number(value)],
            depth: 1,
            reads: Variables::NONE,
            jumps: false,
        }
    }

    /// Returns the variables that occur in the expression.
    pub fn reads(&self) -> Variables {
        self.reads
    }

    /// Whether the value may jump elsewhere than where crank or slider reverses: floor, sign, step or mod occurs in the
    /// expression, other than the sign or step of omega or v.
    pub fn jumps(&self) -> bool {
        self.jumps
    }

    /// Returns the value at an instant, in SI; not finite outside the domain of its functions.
    pub fn value(&self, now: &Instant) -> f64 {
        self.values(&[*now])[0]
    }

    /// Returns the values at `N` instants, in SI, each equal to [`Self::value`] at its instant.
    pub fn values<const N: usize>(&self, now: &[Instant; N]) -> [f64; N] {
        self.evaluate(|variable| {
            let mut values = [0.0; N];
            (0..N).for_each(|i| values[i] = now[i].get(variable));
            values
        })
    }

    /// Encloses all values of the expression for enclosures `of` the variables.
    pub fn enclose(&self, of: impl Fn(Variable) -> Enclosed) -> Enclosed {
        self.evaluate(of)
    }

    /// Runs the stack machine over numbers, over enclosures, or over periods of subexpressions.
    fn evaluate<N: Operand>(&self, of: impl Fn(Variable) -> N) -> N {
        // Most formulas are shallow: their stack is small, as it is filled anew each time.
        match self.depth {
            ..=4 => self.run::<N, 4>(of),
            _ => self.run::<N, STACK_DEPTH>(of),
        }
    }

    fn run<N: Operand, const DEPTH: usize>(&self, of: impl Fn(Variable) -> N) -> N {
        let mut stack = [N::constant(0.0); DEPTH];
        let mut top = 0;
        for op in &self.ops {
            match *op {
                Op::Number(value) => {
                    stack[top] = N::constant(value);
                    top += 1;
                }
                Op::Variable(variable) => {
                    stack[top] = of(variable);
                    top += 1;
                }
                Op::Negate => stack[top - 1] = stack[top - 1].negated(),
                Op::Call1(f) => stack[top - 1] = stack[top - 1].called(f),
                binary => {
                    top -= 1;
                    stack[top - 1] = stack[top - 1].with(binary, stack[top]);
                }
            }
        }
        stack[0]
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
