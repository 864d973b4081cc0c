//! Collects the problems that reading and checking a scene find.

use std::fmt::Display;

use super::number::with_unit;
use super::{Places, Problem};

/// Largest magnitude of a value, SI; the reciprocal is the least positive one. The product of five such values, an
/// energy, neither overflows nor vanishes in double precision.
pub(crate) const LARGEST_VALUE: f64 = 1e50;

/// Problems found, and the places of the scene's keys.
pub(super) struct Check<'a> {
    pub problems: Vec<Problem>,
    pub places: &'a Places,
}

impl Check<'_> {
    pub fn add(&mut self, field: impl Display, what: impl Into<String>, help: impl Into<String>) {
        let problem = Problem::new(&field.to_string(), what, help);
        self.problems.push(problem);
    }

    /// Whether none of these fields has a problem.
    pub fn has_no_problem(&self, fields: &[impl AsRef<str>]) -> bool {
        let is_one = |problem: &Problem| fields.iter().any(|field| field.as_ref() == problem.field);
        !self.problems.iter().any(is_one)
    }

    /// Whether neither a table nor any of its keys has a problem.
    pub fn has_no_problem_in(&self, table: &str) -> bool {
        let is_of_table = |problem: &Problem| problem.field.split('.').next() == Some(table);
        !self.problems.iter().any(is_of_table)
    }

    pub fn finite(&mut self, field: impl Display, value: f64) -> bool {
        if !value.is_finite() {
            let what = format!("{value} is not a finite number");
            self.add(field, what, "give a finite value");
        } else if value.abs() > LARGEST_VALUE {
            let what = format!("{value:e} is too large to be computed with");
            let help = format!("give a value below {LARGEST_VALUE:e} in SI units");
            self.add(field, what, help);
        }
        value.abs() <= LARGEST_VALUE
    }

    pub fn positive(&mut self, field: impl Display, value: f64, unit: &str) {
        if !self.finite(&field, value) {
            return;
        }
        if value <= 0.0 {
            let what = format!("{} is not positive", with_unit(value, unit));
            self.add(field, what, "give a value above zero");
        } else if value < 1.0 / LARGEST_VALUE {
            let what = format!("{value:e} is too small to be computed with");
            self.add(field, what, "give a value above 1e-50 in SI units");
        }
    }

    pub fn not_negative(&mut self, field: impl Display, value: f64, unit: &str) {
        if self.finite(&field, value) && value < 0.0 {
            let what = format!("{} is negative", with_unit(value, unit));
            self.add(field, what, "give zero or a positive value");
        }
    }
}
