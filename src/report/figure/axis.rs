//! An axis: its label, how values are spread over it, and its range.

use super::{page, scale};

/// How values are spread over an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaleKind {
    /// Evenly.
    Linear,
    /// Evenly, read at parts of a turn.
    Degrees,
    /// By their logarithm; values that are not positive have no place.
    Log,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub(super) label: String,
    /// Where there is no room for the label.
    short: String,
    pub(super) kind: ScaleKind,
    pub(super) range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis; the label names the quantity and its unit.
    pub fn linear(label: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            short: String::new(),
            kind: ScaleKind::Linear,
            range: None,
        }
    }

    /// A linear axis of angles in degrees, with ticks at parts of a turn; the label names the angle and its unit.
    pub fn degrees(label: impl Into<String>) -> Axis {
        Axis {
            kind: ScaleKind::Degrees,
            ..Axis::linear(label)
        }
    }

    /// A logarithmic axis; the label names the quantity and its unit.
    pub fn log(label: impl Into<String>) -> Axis {
        Axis {
            kind: ScaleKind::Log,
            ..Axis::linear(label)
        }
    }

    /// With a shorter label, for where there is no room for the other.
    pub fn or(mut self, short: impl Into<String>) -> Axis {
        self.short = short.into();
        self
    }

    /// The label that has room in a length, pixels.
    pub(super) fn label_within(&self, length: i32) -> String {
        match page::text_width(&self.label, page::TEXT) <= length || self.short.is_empty() {
            true => page::fitted(&self.label, length),
            false => page::fitted(&self.short, length),
        }
    }

    /// Without its label.
    pub(in crate::report) fn unlabelled(&mut self) {
        self.label.clear();
    }

    /// Shows exactly this range; what lies outside is cut off. Without it the axis fits the values.
    pub fn range(mut self, low: f64, high: f64) -> Axis {
        self.range = Some((low, high));
        self
    }

    /// Whether a value has a place on the axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        scale::coordinate(self.kind, value).is_finite()
    }
}
