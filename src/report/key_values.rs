//! Facts: what there is to say of a result, each with its name.

use std::f64::consts::TAU;
use std::fmt::{Display, Write};

/// Names and values in order; names that belong to the one before begin with spaces.
pub struct Facts(Vec<(String, String)>);

impl Facts {
    /// The facts of a scene begin with its title, if it has one.
    pub(super) fn of(scene: &str) -> Facts {
        let mut facts = Facts(Vec::new());
        if !scene.is_empty() {
            facts.add("scene", scene);
        }
        facts
    }

    pub(super) fn add(&mut self, name: impl Display, value: impl Display) {
        self.0.push((name.to_string(), value.to_string()));
    }

    pub(super) fn warnings(&mut self, warnings: &[impl Display]) {
        for warning in warnings {
            self.add("warning", warning);
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        let facts = self.0.iter();
        facts.map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// A line for each fact, the values below each other after names of so many characters.
    pub(super) fn lines(&self, width: usize) -> String {
        let mut text = String::new();
        for (name, value) in self.iter() {
            let _ = writeln!(text, "{name:<width$} {value}");
        }
        text
    }
}

/// A line of cells below each other: at the right of columns of these widths, at the left where they are negative.
pub(super) fn aligned<C: AsRef<str>>(
    widths: &[isize],
    cells: impl IntoIterator<Item = C>,
) -> String {
    let mut text = String::new();
    for (cell, width) in cells.into_iter().zip(widths) {
        let gap = if text.is_empty() { "" } else { " " };
        let (cell, size) = (cell.as_ref(), width.unsigned_abs());
        let _ = match *width < 0 {
            true => write!(text, "{gap}{cell:<size$}"),
            false => write!(text, "{gap}{cell:>size$}"),
        };
    }
    text + "\n"
}

/// Adds a fact whose value is formatted.
macro_rules! fact {
    ($facts:expr, $name:expr, $($value:tt)+) => {
        $facts.add($name, format_args!($($value)+))
    };
}
pub(super) use fact;

/// A number for people: six digits; JSON and CSV have all.
pub(super) fn six(value: f64) -> String {
    rounded(value, 6)
}

/// A number that was given: as it was typed, without what rounding adds to it.
pub(super) fn given(value: f64) -> String {
    rounded(value, 12)
}

/// A number with so many digits, without zeros at their end.
pub(super) fn rounded(value: f64, digits: usize) -> String {
    let short = format!("{value:.*e}", digits - 1);
    plain(short.parse().unwrap_or(value))
}

fn plain(value: f64) -> String {
    let size = value.abs();
    // Minus zero is zero.
    let value = value + 0.0;
    if size == 0.0 || !size.is_finite() || (1e-4..1e9).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// An angle (rad) in degrees.
pub(super) fn degrees(radians: f64) -> String {
    six(radians.to_degrees())
}

/// The crank angle (rad, unwrapped) in its turn, in degrees.
pub(super) fn in_turn(theta: f64) -> String {
    degrees(theta.rem_euclid(TAU))
}

/// A value with the digits that its error leaves, and no more; six if it is exact.
pub(super) fn digits(value: f64, error: f64) -> String {
    if error == 0.0 {
        return six(value);
    }
    let places = (-error.log10()).ceil().clamp(0.0, 17.0) as usize;
    format!("{:.places$}", value + 0.0)
}

/// A value with its error, unless it is exact.
pub(super) fn with_error(value: f64, error: f64, unit: &str) -> String {
    let shown = digits(value, error);
    let text = match error {
        0.0 => format!("{shown} {unit}"),
        _ => format!("{shown} +- {error:.1e} {unit}"),
    };
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn people_see_six_digits_or_those_that_the_error_leaves() {
        for (value, shown) in [
            (0.099_999_999_999_999_99, "0.1"),
            (-1.130_863_886_742_583_8e-15, "-1.13086e-15"),
            (-0.0, "0"),
            (31.415_926_535, "31.4159"),
            (31_669.463_364_590_403, "31669.5"),
            (2_000_000.0, "2000000"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(six(value), shown);
        }
        assert_eq!(given(0.1 + 0.2), "0.3");
        assert_eq!(given(0.02769881), "0.02769881");
        assert_eq!(with_error(31.416, 0.0, "rad/s"), "31.416 rad/s");
        assert_eq!(
            with_error(1.234_567_891, 2e-8, "s"),
            "1.23456789 +- 2.0e-8 s"
        );
        assert_eq!(in_turn(-0.5 * PI), "270");
    }
}
