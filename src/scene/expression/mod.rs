//! Loads written as expressions of t, theta, omega, x and v, in SI.
//!
//! The usual mathematical reading: `-x^2` is −(x²), `2^3^2` is 2⁹, `1e-3` is a number.

mod enclosure;
mod parser;
mod period;

use std::fmt;

use super::{Instant, Variable, Variables};
use crate::numeric::enclosure::Enclosed;
use parser::Parser;

/// Values on the stack of one evaluation; deeper expressions are refused when they are read.
const STACK: usize = 32;

const TOO_DEEP: &str = "the expression is nested too deeply; simplify it";

#[derive(Clone, Copy, Debug, PartialEq)]
enum Op {
    Number(f64),
    Variable(Variable),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Call1(usize),
    Call2(usize),
}

/// Name, value, and enclosure of the values.
type Function1 = (&'static str, fn(f64) -> f64, fn(Enclosed) -> Enclosed);
type Function2 = (
    &'static str,
    fn(f64, f64) -> f64,
    fn(Enclosed, Enclosed) -> Enclosed,
);

const FUNCTIONS_1: &[Function1] = &[
    ("sin", f64::sin, Enclosed::sin),
    ("cos", f64::cos, Enclosed::cos),
    ("tan", f64::tan, Enclosed::tan),
    ("asin", f64::asin, Enclosed::asin),
    ("acos", f64::acos, Enclosed::acos),
    ("atan", f64::atan, Enclosed::atan),
    ("sinh", f64::sinh, Enclosed::sinh),
    ("cosh", f64::cosh, Enclosed::cosh),
    ("tanh", f64::tanh, Enclosed::tanh),
    ("exp", f64::exp, Enclosed::exp),
    ("ln", f64::ln, Enclosed::ln),
    ("log10", f64::log10, Enclosed::log10),
    ("sqrt", f64::sqrt, Enclosed::sqrt),
    ("abs", f64::abs, Enclosed::abs),
    ("floor", f64::floor, Enclosed::floor),
    ("sign", sign, Enclosed::sign),
    ("step", step, Enclosed::step),
];

const FUNCTIONS_2: &[Function2] = &[
    ("atan2", f64::atan2, Enclosed::atan2),
    ("min", |a, b| both(a, b, f64::min), Enclosed::min),
    ("max", |a, b| both(a, b, f64::max), Enclosed::max),
    ("mod", f64::rem_euclid, Enclosed::modulo),
];

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
}

fn sign(a: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a.signum() }
}

fn step(a: f64) -> f64 {
    match a {
        _ if a.is_nan() => a,
        _ if a < 0.0 => 0.0,
        _ => 1.0,
    }
}

/// A value of two numbers, which is none where one of them is none.
fn both(a: f64, b: f64, of: fn(f64, f64) -> f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        of(a, b)
    }
}

/// An expression, compiled to postfix order; evaluation allocates nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    ops: Vec<Op>,
    reads: Variables,
    jumps: bool,
}

/// Functions whose values jump.
const JUMPING: [&str; 4] = ["floor", "sign", "step", "mod"];

/// What is wrong in an expression, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Byte offset in the text.
    pub at: usize,
    /// What is wrong.
    pub what: String,
    /// What would be right.
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
    /// Reads an expression.
    ///
    /// # Errors
    /// [`ExpressionError`]: the first thing that is wrong, and where.
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

    /// Reads an expression in which names stand for other expressions.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub(crate) fn parse_with(
        text: &str,
        symbols: &dyn Fn(&str) -> Option<Expression>,
    ) -> Result<Expression, ExpressionError> {
        let ops = Parser::parse(text, symbols)?;
        let mut reads = Variables::NONE;
        let (mut depth, mut deepest) = (0usize, 0);
        for op in &ops {
            match op {
                Op::Number(_) => depth += 1,
                Op::Variable(variable) => {
                    reads = reads.with(*variable);
                    depth += 1;
                }
                Op::Negate | Op::Call1(_) => {}
                _ => depth -= 1,
            }
            deepest = deepest.max(depth);
        }
        if deepest > STACK {
            return Err(ExpressionError::new(text.len(), TOO_DEEP));
        }
        Ok(Expression {
            text: text.to_owned(),
            ops,
            reads,
            jumps: words(text).any(|word| JUMPING.contains(&word)),
        })
    }

    /// A number.
    #[cfg(feature = "cli")]
    pub(crate) fn constant(value: f64) -> Expression {
        Expression {
            text: value.to_string(),
            ops: vec![Op::Number(value)],
            reads: Variables::NONE,
            jumps: false,
        }
    }

    /// The variables that occur in it.
    pub fn reads(&self) -> Variables {
        self.reads
    }

    /// Whether a function occurs in it whose values jump.
    pub fn jumps(&self) -> bool {
        self.jumps
    }

    /// Value at an instant, in SI; not finite outside the domain of its functions.
    pub fn value(&self, now: &Instant) -> f64 {
        self.values(&[*now])[0]
    }

    /// Values at some instants, each as by itself, in SI.
    pub fn values<const N: usize>(&self, now: &[Instant; N]) -> [f64; N] {
        self.evaluate(|variable| {
            let mut values = [0.0; N];
            (0..N).for_each(|i| values[i] = now[i].get(variable));
            values
        })
    }

    /// The stack machine, over numbers, enclosures of them, or what is known of a part.
    fn evaluate<N: Operand>(&self, of: impl Fn(Variable) -> N) -> N {
        let mut stack = [N::constant(0.0); STACK];
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

/// What a formula can be evaluated with.
trait Operand: Copy {
    /// A number of the formula.
    fn constant(value: f64) -> Self;
    fn negated(self) -> Self;
    /// Value of a function of one argument, by its place in the list.
    fn called(self, function: usize) -> Self;

    /// Value of an operation with a second operand.
    fn with(self, op: Op, other: Self) -> Self;
}

/// Numbers at some instants.
impl<const N: usize> Operand for [f64; N] {
    fn constant(value: f64) -> [f64; N] {
        [value; N]
    }

    fn negated(self) -> [f64; N] {
        each(self, self, |a, _| -a)
    }

    fn called(self, function: usize) -> [f64; N] {
        let function = FUNCTIONS_1[function].1;
        each(self, self, |a, _| function(a))
    }

    fn with(self, op: Op, other: [f64; N]) -> [f64; N] {
        match op {
            Op::Add => each(self, other, |a, b| a + b),
            Op::Subtract => each(self, other, |a, b| a - b),
            Op::Multiply => each(self, other, |a, b| a * b),
            Op::Divide => each(self, other, |a, b| a / b),
            Op::Power => each(self, other, power),
            Op::Call2(f) => each(self, other, FUNCTIONS_2[f].1),
            _ => [f64::NAN; N],
        }
    }
}

/// An operation on each of some numbers.
#[inline(always)]
fn each<const N: usize>(mut a: [f64; N], b: [f64; N], of: impl Fn(f64, f64) -> f64) -> [f64; N] {
    for i in 0..N {
        a[i] = of(a[i], b[i]);
    }
    a
}

fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 2.0 {
        base * base
    } else {
        both(base, exponent, f64::powf)
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
