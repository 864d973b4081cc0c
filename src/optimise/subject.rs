//! Limits of key figures.

use std::fmt;
use std::str::FromStr;

use crate::scene::unit;
use crate::sweep::Figure;

/// On which side of its limit a figure has to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// At least.
    Least,
    /// At most.
    Most,
}

impl Limit {
    /// As it is written.
    pub fn sign(self) -> &'static str {
        match self {
            Limit::Least => ">=",
            Limit::Most => "<=",
        }
    }
}

/// A limit of a key figure, read from texts like `transmission_min >= 40 deg`.
///
/// ```
/// use slider_crank::optimise::{Limit, Subject};
/// let subject: Subject = "stroke <= 90 mm".parse().unwrap();
/// assert_eq!((subject.limit, subject.value), (Limit::Most, 0.09));
/// assert!("stroke <= 90 N".parse::<Subject>().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject {
    /// The figure.
    pub figure: Figure,
    /// Which side of the value it has to be on.
    pub limit: Limit,
    /// In SI units and radians.
    pub value: f64,
}

impl Subject {
    /// How far a figure is on the right side, in its unit.
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
