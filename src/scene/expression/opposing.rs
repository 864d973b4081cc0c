//! Loads that oppose motion: dry loads, and formulas of which a part does, proved on the syntax tree: f = a − m sgn(w),
//! with the speed w of the body.

use super::operand::{FUNCTIONS_1, Op};
use super::{Expression, Variable};
use crate::numeric::enclosure::{Enclosed, Interval};
use crate::scene::Load;

/// Formula as the sum of a dry load, which opposes motion and holds at rest, and the rest.
struct OpposingPart {
    /// a; none if it is zero.
    rest: Option<Expression>,
    /// m, not negative at rest.
    magnitude: Expression,
}

impl Load {
    /// Returns the loads that the load is the sum of: a formula with the sign of the speed of its body is a dry load,
    /// which holds at rest as well, beside the rest of the formula.
    pub(crate) fn parts(&self, on_slider: bool) -> Vec<Load> {
        let speed = match on_slider {
            true => Variable::V,
            false => Variable::Omega,
        };
        let opposing = match self {
            Load::Expression(expression) => expression.opposing(speed),
            _ => None,
        };
        let Some(OpposingPart { rest, magnitude }) = opposing else {
            return vec![self.clone()];
        };
        let magnitude = Load::Expression(magnitude);
        let dry = match magnitude.fixed() {
            Some(value) => Load::dry(value),
            None => Load::Dry(Box::new(magnitude)),
        };
        let rest = rest.map(Load::Expression);
        rest.into_iter().chain([dry]).collect()
    }
}

/// Operations in postfix order; none: zero.
type Operand = Option<Vec<Op>>;

/// Subexpression a + b sgn(w), as a and b.
type LinearInSign = [Operand; 2];

impl Expression {
    /// Splits the expression by the sign or step of a speed, omega or v; none if it is not linear in that sign, or if
    /// the magnitude may be negative at rest or is zero there.
    fn opposing(&self, speed: Variable) -> Option<OpposingPart> {
        if !self.reads.has(speed) {
            return None;
        }
        let [plain, of_sign] = self.linear_in_sign(speed)?;
        let magnitude = self.of(negated(of_sign)?)?;
        let at_rest = magnitude.enclose(|variable| match variable {
            Variable::Omega | Variable::V => Enclosed::point(0.0),
            _ => Enclosed::not_analytic(Interval::WHOLE),
        });
        let Interval { low, high } = at_rest.real;
        (low >= 0.0 && high > 0.0).then_some(OpposingPart {
            rest: match plain {
                Some(ops) => Some(self.of(ops)?),
                None => None,
            },
            magnitude,
        })
    }

    /// Makes an expression of a part of this one, which keeps the text.
    fn of(&self, ops: Vec<Op>) -> Option<Expression> {
        Expression::compiled(&self.text, ops).ok()
    }

    fn linear_in_sign(&self, speed: Variable) -> Option<LinearInSign> {
        let mut stack: Vec<LinearInSign> = Vec::new();
        let mut ops = self.ops.iter().peekable();
        while let Some(op) = ops.next() {
            let plain = [Some(vec![*op]), None];
            let part = match *op {
                Op::Variable(variable) if variable == speed => {
                    let sign = ops.next_if(|next| sign_of(next).is_some());
                    sign.and_then(sign_of).unwrap_or(plain)
                }
                Op::Number(_) | Op::Variable(_) => plain,
                Op::Negate => stack.pop()?.map(negated),
                Op::Call1(_) => {
                    let mut argument = without_sign(stack.pop()?)?;
                    argument.push(*op);
                    [Some(argument), None]
                }
                binary => {
                    let (right, left) = (stack.pop()?, stack.pop()?);
                    combined(left, binary, right)?
                }
            };
            stack.push(part);
        }
        stack.pop()
    }
}

/// Returns the sign of a speed, or its step, (1 + sgn w)/2; none for another operation.
fn sign_of(op: &Op) -> Option<LinearInSign> {
    let Op::Call1(function) = op else { return None };
    let number = |value| Some(vec![Op::Number(value)]);
    match FUNCTIONS_1[*function].0 {
        "sign" => Some([None, number(1.0)]),
        "step" => Some([number(0.5), number(0.5)]),
        _ => None,
    }
}

/// Returns a subexpression without the sign; none for others, and for zero.
fn without_sign([plain, of_sign]: LinearInSign) -> Operand {
    of_sign.is_none().then_some(plain)?
}

/// Returns the value of a binary operation; none if it is not linear in the sign.
fn combined([a, b]: LinearInSign, op: Op, [c, d]: LinearInSign) -> Option<LinearInSign> {
    Some(match op {
        Op::Add | Op::Subtract => [sum(a, op, c), sum(b, op, d)],
        // The square of a sign is one.
        Op::Multiply => [
            sum(product(&a, &c), Op::Add, product(&b, &d)),
            sum(product(&a, &d), Op::Add, product(&b, &c)),
        ],
        Op::Divide => {
            let divisor = Some(without_sign([c, d])?);
            [a, b].map(|part| joined(&part, &divisor, op))
        }
        _ => {
            let value = joined(&without_sign([a, b]), &without_sign([c, d]), op)?;
            [Some(value), None]
        }
    })
}

fn joined(left: &Operand, right: &Operand, op: Op) -> Operand {
    let (left, right) = (left.as_ref()?, right.as_ref()?);
    Some([left.as_slice(), right, &[op]].concat())
}

fn product(left: &Operand, right: &Operand) -> Operand {
    joined(left, right, Op::Multiply)
}

fn sum(left: Operand, op: Op, right: Operand) -> Operand {
    match (&left, &right) {
        (Some(_), Some(_)) => joined(&left, &right, op),
        (None, _) if op == Op::Subtract => negated(right),
        (None, _) => right,
        (_, None) => left,
    }
}

fn negated(operand: Operand) -> Operand {
    let mut ops = operand?;
    ops.push(Op::Negate);
    Some(ops)
}
