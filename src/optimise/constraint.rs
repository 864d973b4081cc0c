//! Inequality constraints on key figures, and their parser.

use std::fmt;
use std::str::FromStr;

use crate::scene::unit;
use crate::sweep::Figure;

/// Sense of an inequality constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Figure >= value.
    Least,
    /// Figure <= value.
    Most,
}

impl Limit {
    /// Returns the sign as text, `>=` or `<=`.
    pub fn sign(self) -> &'static str {
        match self {
            Limit::Least => ">=",
            Limit::Most => "<=",
        }
    }
}

/// Inequality constraint on a key figure, parsed from text like `transmission_min >= 40 deg`.
///
/// ```
/// use slider_crank::optimise::{Limit, Subject};
/// let subject: Subject = "stroke <= 90 mm".parse().unwrap();
/// assert_eq!((subject.limit, subject.value), (Limit::Most, 0.09));
/// assert!("stroke <= 90 N".parse::<Subject>().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject {
    /// Constrained figure.
    pub figure: Figure,
    /// Sense of the inequality.
    pub limit: Limit,
    /// Limit, in SI units and radians.
    pub value: f64,
}

impl Subject {
    /// Returns the margin of a figure to the limit, positive if met, in the unit of the figure.
    pub(super) fn margin(&self, value: f64) -> f64 {
        match self.limit {
            Limit::Least => value - self.value,
            Limit::Most => self.value - value,
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.figure, self.limit.sign(), self.value)
    }
}

impl FromStr for Subject {
    type Err = String;

    fn from_str(text: &str) -> Result<Subject, String> {
        let (name, limit, value) = [("≥", Limit::Least), (">=", Limit::Least), ("≤", Limit::Most), ("<=", Limit::Most)]
            .into_iter()
            .find_map(|(sign, limit)| {
                let (name, value) = text.split_once(sign)?;
                Some((name, limit, value))
            })
            .ok_or_else(|| {
                format!(
                    "`{text}` is no limit of a figure; write it like \"transmission_min >= 40 deg\" or \"stroke <= 90 mm\""
                )
            })?;
        let figure: Figure = name.parse()?;
        let value =
            unit::parse(value.trim(), figure.quantity()).map_err(|error| error.to_string())?;
        Ok(Subject {
            figure,
            limit,
            value,
        })
    }
}
