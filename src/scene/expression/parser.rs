//! Recursive-descent parser: takes the text of an expression, returns its operations in postfix order.

use super::operand::{FUNCTIONS_1, FUNCTIONS_2, Op};
use super::{Expression, ExpressionError, STACK_DEPTH, TOO_DEEP};
use crate::scene::Variable;
use crate::scene::number;

/// Parser of a text from left to right; `at` is a byte offset.
pub(super) struct Parser<'a> {
    text: &'a str,
    at: usize,
    ops: Vec<Op>,
    nesting: usize,
    symbols: &'a Symbols<'a>,
}

/// Lookup of the expression that a name stands for.
pub(super) type Symbols<'a> = dyn Fn(&str) -> Option<Expression> + 'a;

impl<'a> Parser<'a> {
    pub(super) fn parse(
        text: &'a str,
        symbols: &'a Symbols<'a>,
    ) -> Result<Vec<Op>, ExpressionError> {
        let mut parser = Parser {
            text,
            at: 0,
            ops: Vec::new(),
            nesting: 0,
            symbols,
        };
        parser.sum()?;
        parser.skip_space();
        match parser.next() {
            None => Ok(parser.ops),
            Some(found) => Err(parser.after_value(found)),
        }
    }

    fn error(&self, what: &str) -> ExpressionError {
        ExpressionError::new(self.at, what)
    }

    /// Creates the error of a character that cannot follow a value.
    fn after_value(&self, found: char) -> ExpressionError {
        if is_in_name(found) || matches!(found, '(' | '.') {
            self.error("an operator such as + - * / ^ is missing here")
        } else {
            self.unexpected(found)
        }
    }

    fn unexpected(&self, found: char) -> ExpressionError {
        let mut error = self.error(&format!("`{found}` is not expected here"));
        let hint = match found {
            ',' => {
                "decimals have a point, a comma separates the two values of atan2, min, max, mod"
            }
            '×' | '·' | '⋅' => "products are written with *",
            '²' | '³' => "powers are written with ^",
            _ => return error,
        };
        error.help = format!("{hint}: {}", error.help);
        error
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn next(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn skip_space(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    fn take(&mut self, symbol: char) -> bool {
        self.skip_space();
        let found = self.rest().starts_with(symbol);
        if found {
            self.at += symbol.len_utf8();
        }
        found
    }

    fn sum(&mut self) -> Result<(), ExpressionError> {
        let signs = [
            ('+', Op::Add),
            ('-', Op::Subtract),
            (number::MINUS, Op::Subtract),
        ];
        self.chain(&signs, Parser::product)
    }

    fn product(&mut self) -> Result<(), ExpressionError> {
        self.chain(&[('*', Op::Multiply), ('/', Op::Divide)], Parser::signed)
    }

    /// Parses operands with operators of one precedence between them, from left to right.
    fn chain(
        &mut self,
        operators: &[(char, Op)],
        operand: fn(&mut Self) -> Result<(), ExpressionError>,
    ) -> Result<(), ExpressionError> {
        operand(self)?;
        loop {
            self.skip_space();
            if self.rest().starts_with("**") {
                return Err(self.error("powers are written with ^"));
            }
            let Some((_, op)) = operators.iter().find(|(sign, _)| self.take(*sign)) else {
                return Ok(());
            };
            operand(self)?;
            self.ops.push(*op);
        }
    }

    fn signed(&mut self) -> Result<(), ExpressionError> {
        if self.nesting > STACK_DEPTH {
            return Err(self.error(TOO_DEEP));
        }
        self.nesting += 1;
        if self.take('-') || self.take(number::MINUS) {
            self.signed()?;
            self.ops.push(Op::Negate);
        } else if self.take('+') {
            self.signed()?;
        } else {
            self.atom()?;
            if self.take('^') {
                self.signed()?;
                self.ops.push(Op::Power);
            }
        }
        self.nesting -= 1;
        Ok(())
    }

    fn atom(&mut self) -> Result<(), ExpressionError> {
        self.skip_space();
        match self.next() {
            None => Err(self.error("the expression ends where a value is expected")),
            Some('(') => {
                self.at += 1;
                self.sum()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            Some(c) => Err(self.unexpected(c)),
        }
    }

    fn close(&mut self) -> Result<(), ExpressionError> {
        if self.take(')') {
            return Ok(());
        }
        Err(match self.next() {
            None => self.error("a closing bracket `)` is missing"),
            Some(found) => self.after_value(found),
        })
    }

    fn number(&mut self) -> Result<(), ExpressionError> {
        let digits = &self.rest()[..number::length(self.rest())];
        let value = number::plain(digits)
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite())
            .ok_or_else(|| self.error(&format!("`{digits}` is not a number")))?;
        self.at += digits.len();
        self.ops.push(Op::Number(value));
        Ok(())
    }

    fn name(&mut self) -> Result<(), ExpressionError> {
        let (rest, start) = (self.rest(), self.at);
        let name = &rest[..rest.find(|c| !is_in_name(c)).unwrap_or(rest.len())];
        self.at += name.len();
        if name == "pi" {
            self.ops.push(Op::Number(std::f64::consts::PI));
            return Ok(());
        }
        if let Some(variable) = Variable::named(name) {
            self.ops.push(Op::Variable(variable));
            return Ok(());
        }
        let one = FUNCTIONS_1.iter().position(|f| f.0 == name);
        let two = FUNCTIONS_2.iter().position(|f| f.0 == name);
        if let Some(call) = one.map(Op::Call1).or(two.map(Op::Call2)) {
            if !self.take('(') {
                return Err(self.error(&format!("`{name}` needs its argument in brackets")));
            }
            self.sum()?;
            if two.is_some() {
                if !self.take(',') {
                    let what = format!("`{name}` takes two values, with a comma between");
                    return Err(self.error(&what));
                }
                self.sum()?;
            }
            self.ops.push(call);
            return self.close();
        }
        if let Some(symbol) = (self.symbols)(name) {
            self.ops.extend(symbol.ops);
            return Ok(());
        }
        self.at = start;
        let mut error = self.error(&format!("`{name}` is not known"));
        let known = FUNCTIONS_1.iter().map(|f| f.0);
        let known = known.chain(FUNCTIONS_2.iter().map(|f| f.0));
        let known = known.collect::<Vec<_>>().join(", ");
        error.help = format!("use t, theta, omega, x, v, pi and the functions {known}");
        Err(error)
    }
}

fn is_in_name(c: char) -> bool {
    c.is_alphabetic() || c.is_ascii_digit() || c == '_'
}
