//! Operations of formulas, on numbers and on enclosures.

use multiversion::multiversion;

use crate::numeric::enclosure::Enclosed;
use crate::numeric::trigonometry::sin_cos;
use crate::scene::Variable;

/// Operation of an evaluation in postfix order; `Call1` and `Call2` hold indices of `FUNCTIONS_1` and `FUNCTIONS_2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
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

/// Name of a function, its value, and the enclosure of its values.
type Function1 = (&'static str, fn(f64) -> f64, fn(Enclosed) -> Enclosed);
type Function2 = (
    &'static str,
    fn(f64, f64) -> f64,
    fn(Enclosed, Enclosed) -> Enclosed,
);

pub(super) const FUNCTIONS_1: &[Function1] = &[
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

pub(super) const FUNCTIONS_2: &[Function2] = &[
    ("atan2", f64::atan2, Enclosed::atan2),
    ("min", |a, b| both(a, b, f64::min), Enclosed::min),
    ("max", |a, b| both(a, b, f64::max), Enclosed::max),
    ("mod", f64::rem_euclid, Enclosed::modulo),
];

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

/// Returns the value of a function of two numbers; NaN if one of them is NaN.
fn both(a: f64, b: f64, of: fn(f64, f64) -> f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        of(a, b)
    }
}

/// Names of the functions with jumps.
pub(super) const JUMPING: [&str; 4] = ["floor", "sign", "step", "mod"];

/// Number type in which a formula can be evaluated.
pub(super) trait Operand: Copy {
    /// Returns the value of a number in the formula.
    fn constant(value: f64) -> Self;
    fn negated(self) -> Self;
    /// Returns the value of a function of one argument, by its index in `FUNCTIONS_1`.
    fn called(self, function: usize) -> Self;

    /// Returns the value of an operation with a second operand.
    fn with(self, op: Op, other: Self) -> Self;
}

/// Numbers at `N` instants.
impl<const N: usize> Operand for [f64; N] {
    fn constant(value: f64) -> [f64; N] {
        [value; N]
    }

    fn negated(self) -> [f64; N] {
        each(self, self, |a, _| -a)
    }

    fn called(self, function: usize) -> [f64; N] {
        match FUNCTIONS_1[function] {
            ("sin", ..) => sines_and_cosines(&self).0,
            ("cos", ..) => sines_and_cosines(&self).1,
            (_, function, _) => each(self, self, |a, _| function(a)),
        }
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

#[multiversion(targets("x86_64+avx2"))]
fn sines_and_cosines<const N: usize>(angles: &[f64; N]) -> ([f64; N], [f64; N]) {
    sin_cos(angles)
}

/// Applies an operation to each pair of numbers.
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
