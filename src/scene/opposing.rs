//! Loads that oppose motion: dry loads, and formulas with the sign of the speed of their body.

use super::expression::OpposingPart;
use super::{Load, Variable};

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
