//! Facts: what there is to say of a result, each with its name.

use std::fmt::{Display, Write};

/// Names and values in order; names that belong to the one before begin with spaces.
pub(super) struct Facts(Vec<(String, String)>);

impl Facts {
    /// The facts of a scene begin with its title, if it has one.
    pub fn of(scene: &str) -> Facts {
        let mut facts = Facts(Vec::new());
        if !scene.is_empty() {
            facts.add("scene", scene);
        }
        facts
    }

    pub fn add(&mut self, name: impl Display, value: impl Display) {
        self.0.push((name.to_string(), value.to_string()));
    }

    pub fn warnings(&mut self, warnings: &[String]) {
        for warning in warnings {
            self.add("warning", warning);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        let facts = self.0.iter();
        facts.map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// A line for each fact, the values below each other after names of so many characters.
    pub fn lines(&self, width: usize) -> String {
        let mut text = String::new();
        for (name, value) in self.iter() {
            let _ = writeln!(text, "{name:<width$} {value}");
        }
        text
    }
}

/// An angle (rad) in degrees with 12 digits, so that one that was given in degrees is shown as it was given.
pub(super) fn degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    format!("{degrees:.11e}").parse().unwrap_or(degrees)
}

/// A value with the digits that its error leaves, and no more.
pub(super) fn digits(value: f64, error: f64) -> String {
    if error == 0.0 {
        return format!("{value}");
    }
    let places = (-error.log10()).ceil().clamp(0.0, 17.0) as usize;
    format!("{value:.places$}")
}

/// A value with its error.
pub(super) fn with_error(value: f64, error: f64, unit: &str) -> String {
    let text = format!("{} +- {error:.1e} {unit}", digits(value, error));
    text.trim_end().to_owned()
}
