//! Axis of a figure: label, range, mapping of values to positions, and ticks.

use super::clip::{POSITION_ROUNDING, inside};
use super::layout::LAYOUT;
use super::words::{fitted, width};

/// Tick distances of angles: parts and multiples of a turn, degrees.
const PARTS_OF_TURN: [f64; 8] = [10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0];

/// Kind of scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Linear,
    /// Linear, with ticks at parts of a turn.
    Degrees,
    /// Decimal logarithm; values that are not positive are not drawn.
    Log,
}

impl Kind {
    /// Returns the coordinate of a value along the axis; NaN if it cannot be drawn.
    fn coordinate(self, value: f64) -> f64 {
        // Differences of larger values may overflow.
        let largest = 1e300;
        match self {
            _ if value.abs() > largest => f64::NAN,
            Kind::Log if value > 0.0 => value.log10(),
            Kind::Log => f64::NAN,
            Kind::Linear | Kind::Degrees => value,
        }
    }
}

/// Axis of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Label used where the full one does not fit; empty for none.
    short: String,
    kind: Kind,
    /// Exact range; none if the axis fits the values.
    pub(crate) range: Option<(f64, f64)>,
}

impl Axis {
    fn new(label: impl Into<String>, kind: Kind) -> Axis {
        Axis {
            label: label.into(),
            short: String::new(),
            kind,
            range: None,
        }
    }

    /// Returns a linear axis; the label names the quantity and its unit.
    pub fn linear(label: impl Into<String>) -> Axis {
        Axis::new(label, Kind::Linear)
    }

    /// Returns a linear axis of angles in degrees, ticks at parts of a turn; the label names the angle and its unit.
    pub fn degrees(label: impl Into<String>) -> Axis {
        Axis::new(label, Kind::Degrees)
    }

    /// Returns a logarithmic axis; the label names the quantity and its unit.
    pub fn log(label: impl Into<String>) -> Axis {
        Axis::new(label, Kind::Log)
    }

    /// Sets a shorter label, used where the full one does not fit.
    pub fn or(mut self, short: impl Into<String>) -> Axis {
        self.short = short.into();
        self
    }

    /// Sets the exact range, outside which curves are cut off; without it the axis fits the values.
    pub fn range(mut self, low: f64, high: f64) -> Axis {
        self.range = Some((low, high));
        self
    }

    /// Sets the range, widened by the usual free space of an axis.
    pub fn around(self, low: f64, high: f64) -> Axis {
        let free = free_space(low, high);
        self.range(low - free, high + free)
    }

    /// Returns the label that fits into a length, pixels.
    pub(super) fn label_within(&self, length: f64) -> String {
        match width(&self.label, LAYOUT.text) <= length || self.short.is_empty() {
            true => fitted(&self.label, length),
            false => fitted(&self.short, length),
        }
    }

    /// Whether a value can be drawn on the axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        self.kind.coordinate(value).is_finite()
    }
}

/// Tick: position on the axis, 0 to 1, and label.
pub(super) struct Tick {
    pub at: f64,
    pub label: String,
}

/// Scale of an axis: kind and limits of the coordinate.
pub(super) struct Scale {
    kind: Kind,
    low: f64,
    high: f64,
}

impl Scale {
    /// Returns the scale of an axis: its own range, else the range of the values with free space.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Scale {
        let kind = axis.kind;
        let asked = axis
            .range
            .map(|(low, high)| (kind.coordinate(low), kind.coordinate(high)))
            .filter(|(low, high)| low.is_finite() && high.is_finite() && low < high);
        let (low, high) = asked.unwrap_or_else(|| {
            let values = values.map(|value| kind.coordinate(value));
            let (low, high) = values
                .filter(|value| value.is_finite())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                });
            // Equal values differ by rounding.
            let is_constant = high - low <= 1e-13 * low.abs().max(high.abs());
            let margin = match kind {
                _ if low > high => return (0.0, 1.0),
                Kind::Log if high - low < 0.1 => 0.5,
                Kind::Linear if is_constant && low == 0.0 => 1.0,
                Kind::Linear if is_constant => 0.1 * low.abs(),
                _ => free_space(low, high),
            };
            (low - margin, high + margin)
        });
        Scale { kind, low, high }
    }

    /// Returns the length of the axis, in units of its coordinate.
    pub fn length(&self) -> f64 {
        self.high - self.low
    }

    /// Sets the length of the axis about its middle.
    pub fn lengthen(&mut self, length: f64) {
        let more = 0.5 * (length - self.length());
        self.low -= more;
        self.high += more;
    }

    /// Returns the position of a value: 0 to 1 inside the limits; NaN if it cannot be drawn.
    pub fn position(&self, value: f64) -> f64 {
        (self.kind.coordinate(value) - self.low) / self.length()
    }

    /// Returns the position of a value, clamped to 0 to 1; 0 for a value that is not positive on a logarithmic axis.
    pub fn clamped(&self, value: f64) -> f64 {
        if self.kind == Kind::Log && value <= 0.0 {
            return 0.0;
        }
        self.position(value).clamp(0.0, 1.0)
    }

    /// Returns at most `most` ticks.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        if self.kind != Kind::Log {
            return self.even(self.low, self.high, most);
        }
        let parts = self.decades(1, &[1, 2, 5]);
        if (2..=most).contains(&parts.len()) {
            return parts;
        }
        if self.length() < 1.5 {
            return self.even(10f64.powf(self.low), 10f64.powf(self.high), most);
        }
        let span = (self.high.floor() - self.low.ceil()) as i32;
        let mut steps = [1, 2, 3, 5, 10, 20, 50, 100].into_iter();
        let step = steps.find(|step| span / step < most as i32);
        self.decades(step.unwrap_or(200), &[1])
    }

    /// Returns ticks at multiples `parts` of every `step`-th decade.
    fn decades(&self, step: i32, parts: &[i32]) -> Vec<Tick> {
        let exponents = self.low.floor() as i32..=self.high.ceil() as i32;
        let ticks = exponents.flat_map(|exponent| parts.iter().map(move |part| (*part, exponent)));
        let ticks = ticks.filter(|(_, exponent)| exponent.rem_euclid(step) == 0);
        self.shown(ticks.map(|(part, exponent)| {
            let value = f64::from(part) * 10f64.powi(exponent);
            let label = match exponent {
                0..=3 => format!("{value}"),
                _ => format!("{part}e{exponent}"),
            };
            (value, label)
        }))
    }

    /// Returns ticks at equidistant round numbers.
    fn even(&self, low: f64, high: f64, most: usize) -> Vec<Tick> {
        let least = (high - low) / most.max(1) as f64;
        let of_turn = PARTS_OF_TURN.into_iter().find(|part| *part >= least);
        let step = of_turn
            .filter(|_| self.kind == Kind::Degrees && least > 5.0)
            .unwrap_or_else(|| round_step(least));
        let digits = |value: f64| value.abs().max(f64::MIN_POSITIVE).log10().floor() as i32;
        let size = digits(low.abs().max(high.abs()));
        let last = digits(step * (1.0 + POSITION_ROUNDING));
        let first = (low / step).ceil();
        let count = ((high / step).floor() - first).max(0.0) as usize + 1;
        self.shown((0..count.min(most + 1)).map(|i| {
            let value = (first + i as f64) * step;
            let label = if value == 0.0 {
                "0".to_owned()
            } else if size > 6 || last < -6 {
                let decimals = (digits(value * (1.0 + POSITION_ROUNDING)) - last).max(0) as usize;
                format!("{value:.decimals$e}")
            } else {
                format!("{value:.*}", (-last).max(0) as usize)
            };
            (value, label)
        }))
    }

    /// Returns those ticks that lie inside the limits.
    fn shown(&self, ticks: impl Iterator<Item = (f64, String)>) -> Vec<Tick> {
        let tick = |(value, label)| Tick {
            at: self.position(value),
            label,
        };
        let is_inside = |tick: &Tick| inside((tick.at, 0.0));
        ticks.map(tick).filter(is_inside).collect()
    }
}

/// Returns the free space at each end of an axis: a part of the range of the values.
fn free_space(low: f64, high: f64) -> f64 {
    0.04 * (high - low)
}

/// Rounds up to 1, 2 or 5 times a power of ten.
fn round_step(at_least: f64) -> f64 {
    let decade = 10f64.powf(at_least.max(f64::MIN_POSITIVE).log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|part| part * decade).into_iter();
    let mut large = steps.filter(|step| *step >= at_least * (1.0 - POSITION_ROUNDING));
    large.next().unwrap_or(10.0 * decade)
}
