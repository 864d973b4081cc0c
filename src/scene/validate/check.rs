//! The list that the checks of single values write to.

use std::fmt::Display;

use crate::scene::Problem;
use crate::scene::number::{apart, with_unit};

/// All that mass and moment of inertia of a body depend on.
const MASS_KEYS: [&str; 8] = [
    "mass",
    "cg",
    "cg_lateral",
    "inertia",
    "density",
    "length",
    "width",
    "depth",
];

/// Largest value, SI: an energy, the product of five values, has one in double precision, too.
const LARGEST: f64 = 1e50;
/// Least value that has to be positive, SI: such a product does not vanish.
const LEAST_POSITIVE: f64 = 1.0 / LARGEST;

/// The problems found so far.
pub(super) struct Check<'a>(pub &'a mut Vec<Problem>);

impl Check<'_> {
    pub fn add(&mut self, field: impl Display, what: String, help: &str) {
        self.0.push(Problem::new(&field.to_string(), what, help));
    }

    /// Whether none of these fields has a problem yet.
    pub fn sound<const N: usize>(&self, fields: [&str; N]) -> bool {
        let mut named = self.0.iter().map(|problem| problem.field.as_str());
        !named.any(|field| fields.contains(&field))
    }

    pub fn finite(&mut self, field: impl Display, value: f64) -> bool {
        if !value.is_finite() {
            let what = format!("{value} is not a finite number");
            self.add(field, what, "give a finite value");
        } else if value.abs() > LARGEST {
            let what = format!("{value:e} is too large to be computed with");
            self.add(field, what, "give a value below 1e50 in SI units");
        }
        value.abs() <= LARGEST
    }

    pub fn positive(&mut self, field: impl Display, value: f64, unit: &str) {
        if !self.finite(&field, value) {
            return;
        }
        if value <= 0.0 {
            self.0
                .push(Problem::not_positive(&field.to_string(), value, unit));
        } else if value < LEAST_POSITIVE {
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

    /// The moment of inertia of a body about a point, against the `least` that its centre of gravity allows.
    pub fn inertia(&mut self, body: &str, about: &str, inertia: f64, least: f64) {
        if inertia >= least * (1.0 - 1e-9) {
            return;
        }
        let fields = MASS_KEYS.map(|key| format!("{body}.{key}"));
        if self.sound(fields.each_ref().map(String::as_str)) {
            let (inertia, least) = apart(inertia, least);
            self.add(
                format_args!("{body}.inertia"),
                format!(
                    "{inertia} kg m2 about {about} is less than mass times distance of the centre of gravity squared, {least} kg m2"
                ),
                "no body has that: check inertia, mass and cg, and the point the inertia is about",
            );
        }
    }
}
