//! Periods of loads over the crank angle, as rational numbers of turns.

use std::f64::consts::TAU;
use std::fmt;

use super::digits::Digits;

/// Longest cycle, turns, because a cycle is tabulated as a whole; a multiple of all numbers up to six.
const LONGEST_CYCLE: u32 = 120;

/// Positive rational number of turns of the crank, in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Period {
    turns: u32,
    parts: u32,
}

impl Period {
    /// Period of one turn.
    pub const TURN: Period = Period { turns: 1, parts: 1 };

    /// Returns a period of whole turns; none for zero, and for more than a cycle may have.
    pub fn turns(turns: u32) -> Option<Period> {
        Period::fraction(turns, 1)
    }

    /// Returns a period of `turns`/`parts` of a turn; none for zero, and for more whole turns than a cycle may have.
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

    /// Returns the least whole number of turns that is a multiple of the period.
    pub fn whole_turns(self) -> u32 {
        self.turns
    }

    /// Returns the length of the period, rad.
    pub fn radians(self) -> f64 {
        f64::from(self.turns) * TAU / f64::from(self.parts)
    }

    /// Returns the fraction that a number of turns stands for, known to the relative error `relative`, and computed from
    /// exact numbers in a few steps.
    pub(super) fn near(turns: f64, relative: f64) -> Result<Period, WhyNot> {
        let is_usable = turns.is_finite() && turns > 0.0;
        let off = relative.max(4.0 * f64::EPSILON) * turns;
        let fraction = is_usable.then(|| simplest(turns - off, turns + off));
        let Some([whole, parts]) = fraction.flatten() else {
            return Err(WhyNot::Incommensurable);
        };
        // Bound of the number of fractions in a turn with at most this denominator; times `2 off`, the share near one.
        let fractions = 0.5 * parts * (parts + 1.0);
        // Largest probability with which a random number of as many digits is as near to one of them.
        let largest_chance = 1e-3;
        if whole < 1.0 || 2.0 * off * fractions > largest_chance {
            return Err(WhyNot::Incommensurable);
        }
        if whole > f64::from(LONGEST_CYCLE) || parts > f64::from(u32::MAX) {
            return Err(WhyNot::TooLong(whole));
        }
        let (turns, parts) = (whole as u32, parts as u32);
        Ok(Period { turns, parts })
    }

    /// Returns the fraction of a turn that equals an angle (rad) up to rounding.
    pub(super) fn of_angle(angle: f64) -> Result<Period, WhyNot> {
        Period::near(angle / TAU, 0.0)
    }

    /// Returns the period of an angle (rad) as written, rounded or cut off at its last digit, like a turn on a
    /// calculator, 6.283185307 rad.
    pub(super) fn as_written(angle: f64) -> Result<Period, WhyNot> {
        let digits = Digits::of(&format!("{angle:e}"));
        Period::near(angle / TAU, digits.last_unit() / angle)
    }

    /// Returns the least common multiple of two periods.
    fn common(self, other: Period) -> Result<Period, WhyNot> {
        let [a, b] = [self.turns, other.turns].map(u64::from);
        let turns = a / gcd(a, b) * b;
        if turns > LONGEST_CYCLE.into() {
            return Err(WhyNot::TooLong(turns as f64));
        }
        let parts = gcd(self.parts.into(), other.parts.into()) as u32;
        let turns = turns as u32;
        Ok(Period { turns, parts })
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

/// Periodicity of a load over the crank angle, all other variables of the load being equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Periodicity {
    /// The load does not depend on the crank angle.
    Always,
    /// The load repeats after this period.
    After(Period),
    /// The load is not known to repeat.
    Never(WhyNot),
}

impl Periodicity {
    /// Returns the periodicity of a load that depends on both.
    pub(crate) fn common(self, other: Periodicity) -> Periodicity {
        match (self, other) {
            (Periodicity::Never(why), _) | (_, Periodicity::Never(why)) => Periodicity::Never(why),
            (Periodicity::Always, other) | (other, Periodicity::Always) => other,
            (Periodicity::After(a), Periodicity::After(b)) => a.common(b).into(),
        }
    }
}

impl From<Result<Period, WhyNot>> for Periodicity {
    fn from(period: Result<Period, WhyNot>) -> Periodicity {
        match period {
            Ok(period) => Periodicity::After(period),
            Err(why) => Periodicity::Never(why),
        }
    }
}

/// Reason why a load over the crank angle does not repeat.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WhyNot {
    /// The table has no period.
    #[error("its table over theta has no period")]
    NoPeriod,
    /// The closure states no period.
    #[error("its code reads theta and states no period")]
    Unstated,
    /// The formula has the angle outside of periodic functions.
    #[error("theta stands outside of sin, cos, tan and mod")]
    Outside,
    /// The period is no fraction of a turn to the precision of its digits.
    #[error("its period is no fraction of a turn that its digits tell")]
    Incommensurable,
    /// The load repeats after this number of turns, more than a cycle may have.
    #[error("it is the same again only after {0} turns")]
    TooLong(f64),
}

/// Returns the fraction of the least denominator between two positive numbers, by their continued fractions; none if
/// its numerator or denominator reaches 2^52.
fn simplest(low: f64, high: f64) -> Option<[f64; 2]> {
    let (mut low, mut high) = (low, high);
    // Last two convergents of the continued fraction.
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

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
