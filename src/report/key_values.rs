//! Facts of a result: named values as text, and the formatting of numbers.

use std::f64::consts::TAU;
use std::fmt::{Display, Write};

use crate::scene;

/// Ordered list of names and values; names that belong to the preceding one begin with spaces.
pub struct Facts(pub(super) Vec<(String, String)>);

impl Facts {
    /// Starts the facts of a scene with its title, if not empty.
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

    /// Returns one line per fact, values aligned after names padded to `width` characters.
    pub(super) fn lines(&self, width: usize) -> String {
        let lines = self.0.iter();
        let lines = lines.map(|(name, value)| format!("{name:<width$} {value}\n"));
        lines.collect()
    }
}

/// Returns a line of cells in columns of these widths: right-aligned, left-aligned if the width is negative.
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

/// Returns a table of a header, its cells separated by commas, and rows, in columns as of [`aligned`].
pub(super) fn text_table<R: IntoIterator<Item = String>>(
    widths: &[isize],
    header: &str,
    rows: impl IntoIterator<Item = R>,
) -> String {
    let lines = rows.into_iter().map(|row| aligned(widths, row));
    aligned(widths, header.split(',')) + &lines.collect::<String>()
}

/// Adds a fact: its name, and its value as a format string with arguments.
macro_rules! fact {
    ($facts:expr, $name:expr => $($value:tt)+) => {
        $facts.add($name, format_args!($($value)+))
    };
}
pub(super) use fact;

/// Formats a computed number with six significant digits; JSON and CSV have all digits.
pub(super) fn six(value: f64) -> String {
    rounded(value, 6)
}

/// Formats an input number with twelve significant digits, which hides the rounding of unit conversion.
pub(super) fn given(value: f64) -> String {
    rounded(value, 12)
}

/// Formats a number with at most `digits` significant digits, without trailing zeros.
pub(super) fn rounded(value: f64, digits: usize) -> String {
    scene::rounded(value, digits, 1e-4..1e9)
}

/// Formats an angle (rad) in degrees.
pub(super) fn degrees(radians: f64) -> String {
    six(radians.to_degrees())
}

/// Formats an unwrapped crank angle (rad) modulo one turn, in degrees.
pub(super) fn in_turn(theta: f64) -> String {
    degrees(theta.rem_euclid(TAU))
}

/// Formats a value to the digits that its error leaves significant; six if exact.
pub(super) fn digits(value: f64, error: f64) -> String {
    if error == 0.0 {
        return six(value);
    }
    let places = (-error.log10()).ceil().clamp(0.0, 17.0) as usize;
    format!("{:.places$}", value + 0.0)
}

/// Formats a value with its error and unit; an exact value (zero error) without error.
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
