//! Inequality constraints on key figures, and their parser.

use std::str::FromStr;

use crate::scene::unit;
use crate::sweep::Figure;

named! {
    /// Sense of an inequality constraint, named by its sign.
    pub enum Sense {
        /// Figure >= limit.
        AtLeast = ">=",
        /// Figure <= limit.
        AtMost = "<=",
    }
}

/// Inequality constraint on a key figure, parsed from text like `transmission_min >= 40 deg`.
///
/// ```
/// use slider_crank::optimise::{Constraint, Sense};
/// let constraint: Constraint = "stroke <= 90 mm".parse().unwrap();
/// assert_eq!((constraint.sense, constraint.limit), (Sense::AtMost, 0.09));
/// assert!("stroke <= 90 N".parse::<Constraint>().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// Constrained figure.
    pub figure: Figure,
    /// Sense of the inequality.
    pub sense: Sense,
    /// Limit, in SI units and radians.
    pub limit: f64,
}

impl Constraint {
    /// Returns the margin of a figure to the limit, positive if met, in the unit of the figure.
    pub(super) fn margin(&self, value: f64) -> f64 {
        match self.sense {
            Sense::AtLeast => value - self.limit,
            Sense::AtMost => self.limit - value,
        }
    }
}

impl FromStr for Constraint {
    type Err = String;

    fn from_str(text: &str) -> Result<Constraint, String> {
        let plain = text.replace('≥', ">=").replace('≤', "<=");
        let parts = Sense::ALL.into_iter().find_map(|sense| {
            let (name, limit) = plain.split_once(sense.name())?;
            Some((name, sense, limit))
        });
        let (name, sense, limit) = parts.ok_or_else(|| {
            format!(
                "`{text}` is no limit of a figure; write it like \"transmission_min >= 40 deg\" or \"stroke <= 90 mm\""
            )
        })?;
        let figure = Figure::of_number(name)?;
        let limit = unit::parse(limit.trim(), figure.quantity);
        Ok(Constraint {
            figure,
            sense,
            limit: limit.map_err(|error| error.to_string())?,
        })
    }
}
