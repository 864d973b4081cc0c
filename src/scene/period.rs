//! After how many turns of the crank a load is the same again.

use std::f64::consts::TAU;
use std::fmt;

/// A cycle is not longer than this, turns: it is tabulated as a whole. It is a multiple of all numbers up to six.
const LONGEST_CYCLE: u32 = 120;

/// A number is taken for a fraction if a chance number of as many digits would be as near to a fraction of so small a
/// denominator less often than this.
const CHANCE: f64 = 1e-3;

/// Relative rounding of a number that was computed from exact ones in a few steps.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// A positive rational number of turns of the crank, in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Period {
    turns: u32,
    parts: u32,
}

impl Period {
    /// One turn.
    pub const TURN: Period = Period { turns: 1, parts: 1 };

    /// Whole turns; none for zero, and for more than a cycle may have.
    pub fn turns(turns: u32) -> Option<Period> {
        Period::fraction(turns, 1)
    }

    /// `turns`/`parts` of a turn; none for zero, and for more whole turns than a cycle may have.
    ///
    /// ```
    /// use slider_crank::scene::Period;
    /// let third = Period::fraction(2, 6).unwrap();
    /// assert_eq!((third.to_string(), third.whole_turns()), ("1/3 turn".to_owned(), 1));
    /// ```
    pub fn fraction(turns: u32, parts: u32) -> Option<Period> {
        if turns == 0 || parts == 0 {
            return None;
        }
        let common = gcd(turns.into(), parts.into()) as u32;
        let period = Period {
            turns: turns / common,
            parts: parts / common,
        };
        (period.turns <= LONGEST_CYCLE).then_some(period)
    }

    /// The least whole number of turns that holds it without a rest.
    pub fn whole_turns(self) -> u32 {
        self.turns
    }

    /// Length of the period, rad.
    pub fn radians(self) -> f64 {
        f64::from(self.turns) * TAU / f64::from(self.parts)
    }

    /// The fraction that a number of turns stands for, which may be off by a part `relative` of it.
    pub(super) fn near(turns: f64, relative: f64) -> Result<Period, WhyNot> {
        if !(turns.is_finite() && turns > 0.0) {
            return Err(WhyNot::Incommensurable);
        }
        let off = relative * turns;
        let Some([whole, parts]) = simplest(turns - off, turns + off) else {
            return Err(WhyNot::Incommensurable);
        };
        // Fractions of no larger denominator in a turn, and the part of it that is as near to one of them.
        let fractions = 0.5 * parts * (parts + 1.0);
        if whole < 1.0 || 2.0 * off * fractions > CHANCE {
            return Err(WhyNot::Incommensurable);
        }
        match whole <= f64::from(LONGEST_CYCLE) && parts <= f64::from(u32::MAX) {
            true => Ok(Period {
                turns: whole as u32,
                parts: parts as u32,
            }),
            false => Err(WhyNot::TooLong(whole)),
        }
    }

    /// The fraction of a turn that an angle (rad) is but for rounding.
    pub(super) fn of_angle(angle: f64) -> Result<Period, WhyNot> {
        Period::near(angle / TAU, ROUNDED)
    }

    /// Period of an angle as it was written, rounded or cut off at its last digit: as calculators show a turn, it is
    /// 6.283185307 rad.
    pub(super) fn as_written(angle: f64) -> Result<Period, WhyNot> {
        Period::near(angle / TAU, (last_unit(angle) / angle).max(ROUNDED))
    }

    /// The shortest time after which both are the same again.
    fn with(self, other: Period) -> Result<Period, WhyNot> {
        let [a, b] = [self.turns, other.turns].map(u64::from);
        let turns = a / gcd(a, b) * b;
        if turns > LONGEST_CYCLE.into() {
            return Err(WhyNot::TooLong(turns as f64));
        }
        Ok(Period {
            turns: turns as u32,
            parts: gcd(self.parts.into(), other.parts.into()) as u32,
        })
    }
}

impl fmt::Display for Period {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Period { turns, parts } = self;
        let noun = if turns > parts { "turns" } else { "turn" };
        match parts {
            1 => write!(f, "{turns} {noun}"),
            _ => write!(f, "{turns}/{parts} {noun}"),
        }
    }
}

/// Whether a load is the same again after some turns of the crank, all else that it depends on being the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Repeats {
    /// The load does not depend on the crank angle.
    Always,
    /// The load repeats after this.
    After(Period),
    /// The load is not known to repeat.
    Never(WhyNot),
}

impl Repeats {
    /// Of what depends on both.
    pub(crate) fn with(self, other: Repeats) -> Repeats {
        match (self, other) {
            (Repeats::Never(why), _) | (_, Repeats::Never(why)) => Repeats::Never(why),
            (Repeats::Always, other) | (other, Repeats::Always) => other,
            (Repeats::After(a), Repeats::After(b)) => a.with(b).into(),
        }
    }
}

impl From<Result<Period, WhyNot>> for Repeats {
    fn from(period: Result<Period, WhyNot>) -> Repeats {
        match period {
            Ok(period) => Repeats::After(period),
            Err(why) => Repeats::Never(why),
        }
    }
}

/// Why a load over the crank angle does not repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WhyNot {
    /// A table without a period.
    NoPeriod,
    /// A function of code that states no period.
    Unstated,
    /// A formula with the angle outside of all that repeats.
    Outside,
    /// The periods and the turn have no common multiple that the digits tell.
    Incommensurable,
    /// The load repeats after so many turns, which are more than a cycle may have.
    TooLong(f64),
}

impl fmt::Display for WhyNot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WhyNot::NoPeriod => f.write_str("its table over theta has no period"),
            WhyNot::Unstated => f.write_str("its code reads theta and states no period"),
            WhyNot::Outside => f.write_str("theta stands outside of sin, cos, tan and mod"),
            WhyNot::Incommensurable => {
                f.write_str("its period is no fraction of a turn that its digits tell")
            }
            WhyNot::TooLong(turns) => {
                write!(f, "it is the same again only after {turns} turns")
            }
        }
    }
}

/// A unit of the last digit with which a number is written at its shortest.
fn last_unit(value: f64) -> f64 {
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let exponent = exponent.parse::<i32>().unwrap_or_default();
    10f64.powi(exponent - decimals as i32)
}

/// The fraction of the least denominator between two positive numbers, by their continued fractions; none if it is
/// beyond whole numbers of floats.
fn simplest(low: f64, high: f64) -> Option<[f64; 2]> {
    let (mut low, mut high) = (low, high);
    // Of a continued fraction: the last two convergents.
    let (mut before, mut last) = ([0.0, 1.0], [1.0, 0.0]);
    loop {
        let whole = low.ceil();
        let is_last = whole <= high;
        let term = if is_last { whole } else { low.floor() };
        let next = [0, 1].map(|i| term * last[i] + before[i]);
        if !next.iter().all(|n: &f64| *n < 1.0 / f64::EPSILON) {
            return None;
        }
        (before, last) = (last, next);
        if is_last {
            return Some(last);
        }
        (low, high) = (1.0 / (high - term), 1.0 / (low - term));
    }
}

/// The greatest common divisor.
fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
