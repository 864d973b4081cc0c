//! Where a value lies on an axis, and the ticks.

use super::{Axis, ScaleKind};

/// Part of the length of an axis that is left free beyond the values, at each end.
const MARGIN: f64 = 0.04;

/// Values beyond this are no quantities, and their differences may overflow.
const LARGEST: f64 = 1e300;

/// Values closer together than this part of their size are one value.
const CONSTANT: f64 = 1e-13;

/// A tick: where on the axis (0 to 1), and what is written there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: String,
}

/// An axis with its limits; of a logarithmic one these are those of the decimal logarithm.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    kind: ScaleKind,
    low: f64,
    high: f64,
}

impl Scale {
    /// The scale of an axis that has to show these values, if it has no range of its own.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Scale {
        let coordinate = |value| coordinate(axis.kind, value);
        if let Some((low, high)) = axis.range {
            let (low, high) = (coordinate(low), coordinate(high));
            if low.is_finite() && high.is_finite() && low < high {
                return Scale {
                    kind: axis.kind,
                    low,
                    high,
                };
            }
        }
        let (low, high) = values
            .map(coordinate)
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        let (low, high) = match axis.kind {
            _ if low > high => (0.0, 1.0),
            ScaleKind::Log if high - low < 0.1 => (low - 0.5, high + 0.5),
            ScaleKind::Linear if high - low <= CONSTANT * low.abs().max(high.abs()) => {
                let around = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
                (low - around, high + around)
            }
            _ => (low - MARGIN * (high - low), high + MARGIN * (high - low)),
        };
        Scale {
            kind: axis.kind,
            low,
            high,
        }
    }

    /// Length of the axis in its coordinate.
    pub(super) fn length(&self) -> f64 {
        self.high - self.low
    }

    /// Makes the axis so long, with the middle where it is.
    pub(super) fn lengthen(&mut self, length: f64) {
        let more = 0.5 * (length - self.length());
        self.low -= more;
        self.high += more;
    }

    /// Where a value lies: 0 to 1 inside the limits; not a number if it has no place on this axis.
    pub(super) fn position(&self, value: f64) -> f64 {
        (coordinate(self.kind, value) - self.low) / (self.high - self.low)
    }

    /// Where a value lies, brought inside the limits; what a logarithmic axis cannot reach is at its start.
    pub(super) fn clamped(&self, value: f64) -> f64 {
        if self.kind == ScaleKind::Log && value <= 0.0 {
            return 0.0;
        }
        self.position(value).clamp(0.0, 1.0)
    }

    /// At most `most` ticks.
    pub(super) fn ticks(&self, most: usize) -> Vec<Tick> {
        match self.kind {
            ScaleKind::Linear | ScaleKind::Degrees => self.even_ticks(self.low, self.high, most),
            ScaleKind::Log => {
                let parts = self.parts_of_decades();
                match self.high - self.low {
                    _ if (2..=most).contains(&parts.len()) => parts,
                    decades if decades >= 1.5 => self.decades(most),
                    _ => self.even_ticks(10f64.powf(self.low), 10f64.powf(self.high), most),
                }
            }
        }
    }

    /// Round numbers at even distances.
    fn even_ticks(&self, low: f64, high: f64, most: usize) -> Vec<Tick> {
        let least = (high - low) / most.max(1) as f64;
        let of_turn = match self.kind {
            ScaleKind::Degrees => PARTS_OF_TURN.into_iter().find(|part| *part >= least),
            _ => None,
        };
        let step = of_turn
            .filter(|_| least > 5.0)
            .unwrap_or_else(|| round_step(least));
        let digits = |value: f64| value.abs().max(f64::MIN_POSITIVE).log10().floor() as i32;
        let size = digits(low.abs().max(high.abs()));
        let last = digits(step * (1.0 + 1e-9));
        let first = (low / step).ceil();
        let count = ((high / step).floor() - first).max(0.0) as usize + 1;
        (0..count.min(most + 1))
            .map(|i| {
                let multiple = first + i as f64;
                let value = multiple * step;
                let label = if multiple == 0.0 {
                    "0".to_owned()
                } else if size > 6 || last < -6 {
                    let decimals = (digits(value * (1.0 + 1e-9)) - last).max(0) as usize;
                    format!("{value:.decimals$e}")
                } else {
                    format!("{value:.*}", (-last).max(0) as usize)
                };
                Tick {
                    at: self.position(value),
                    label,
                }
            })
            .filter(|tick| (-1e-9..=1.0 + 1e-9).contains(&tick.at))
            .collect()
    }

    /// Powers of ten, so many decades apart that there are not too many.
    fn decades(&self, most: usize) -> Vec<Tick> {
        let (first, last) = (self.low.ceil() as i32, self.high.floor() as i32);
        let step = [1, 2, 3, 5, 10, 20, 50, 100]
            .into_iter()
            .find(|step| (last - first) / step < most as i32)
            .unwrap_or(200);
        (first..=last)
            .filter(|exponent| exponent.rem_euclid(step) == 0)
            .map(|exponent| Tick {
                at: (f64::from(exponent) - self.low) / (self.high - self.low),
                label: power_of_ten(exponent),
            })
            .collect()
    }

    /// 1, 2 and 5 of each decade.
    fn parts_of_decades(&self) -> Vec<Tick> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        (first..=last)
            .flat_map(|exponent| [1, 2, 5].map(|part| (part, exponent)))
            .map(|(part, exponent)| Tick {
                at: self.position(f64::from(part) * 10f64.powi(exponent)),
                label: match exponent {
                    _ if part == 1 => power_of_ten(exponent),
                    0..=3 => format!("{}", part * 10_i32.pow(exponent as u32)),
                    _ => format!("{part}e{exponent}"),
                },
            })
            .filter(|tick| (-1e-9..=1.0 + 1e-9).contains(&tick.at))
            .collect()
    }
}

/// The value that is spread evenly over an axis; not a number if there is none.
pub(super) fn coordinate(kind: ScaleKind, value: f64) -> f64 {
    match kind {
        _ if value.abs() > LARGEST => f64::NAN,
        ScaleKind::Linear | ScaleKind::Degrees => value,
        ScaleKind::Log if value > 0.0 => value.log10(),
        ScaleKind::Log => f64::NAN,
    }
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0..=3 => 10_i32.pow(exponent as u32).to_string(),
        _ => format!("1e{exponent}"),
    }
}

/// Parts and multiples of a turn at which angles are read, degrees.
const PARTS_OF_TURN: [f64; 8] = [10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0];

/// The next step of 1, 2 or 5 times a power of ten.
fn round_step(at_least: f64) -> f64 {
    let decade = 10f64.powf(at_least.max(f64::MIN_POSITIVE).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|part| part * decade)
        .find(|step| *step >= at_least * (1.0 - 1e-9))
        .unwrap_or(10.0 * decade)
}
