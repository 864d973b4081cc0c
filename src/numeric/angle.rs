//! Angles as whole turns and a remainder: a million turns cost no digits of the position.

use std::f64::consts::{PI, TAU};

/// 2 pi − TAU: rounding error of the double nearest to 2 pi, rad.
pub const TAU_REST: f64 = 2.4492935982947064e-16;

/// Angle turns·2π + rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Angle {
    /// Whole turns.
    pub turns: f64,
    /// Remainder, rad; of any size, most exact when small.
    pub rest: f64,
}

impl From<f64> for Angle {
    fn from(rest: f64) -> Angle {
        Angle::new(0.0, rest)
    }
}

impl Angle {
    /// Returns the angle of whole turns and a remainder, rad.
    pub fn new(turns: f64, rest: f64) -> Angle {
        Angle { turns, rest }
    }

    /// Returns the whole angle, rad, rounded once.
    pub fn radians(self) -> f64 {
        self.turns * TAU + (self.turns * TAU_REST + self.rest)
    }

    /// Returns the angle with its remainder in [−π, 2π): one in that range, also if negative, keeps its digits.
    pub fn reduced(self) -> Angle {
        if (-PI..TAU).contains(&self.rest) {
            return self;
        }
        let turns = (self.rest / TAU).floor();
        Angle::new(
            self.turns + turns,
            (self.rest - turns * TAU) - turns * TAU_REST,
        )
    }

    /// Returns this angle minus another, rad.
    pub fn minus(self, other: Angle) -> f64 {
        Angle::new(self.turns - other.turns, self.rest - other.rest).radians()
    }

    /// Returns this angle plus `more` radians.
    pub fn plus(self, more: f64) -> Angle {
        Angle::new(self.turns, self.rest + more)
    }
}

/// Reduces an angle, rad, to [0, 2π): the remainder of a small negative angle is rounded to 2π, which is 0.
pub fn in_turn(theta: f64) -> f64 {
    theta.rem_euclid(TAU) % TAU
}

/// Returns the distance of two angles on the circle, rad.
pub fn circular_distance(theta: f64, other: f64) -> f64 {
    let ahead = (theta - other).rem_euclid(TAU);
    ahead.min(TAU - ahead)
}

/// Iterates over angles of a turn, rad, repeated in each of several turns.
pub fn in_turns(angles: &[f64], turns: impl Iterator<Item = i64>) -> impl Iterator<Item = f64> {
    turns.flat_map(move |turn| {
        let before = turn as f64 * TAU;
        angles.iter().map(move |theta| theta + before)
    })
}

/// Sorts numbers and leaves out those that only rounding tells from the one before, as the ends of a turn.
pub fn distinct(mut numbers: Vec<f64>) -> Vec<f64> {
    numbers.sort_by(f64::total_cmp);
    let largest = numbers.iter().fold(0.0f64, |most, at| most.max(at.abs()));
    let rounding = 16.0 * f64::EPSILON * largest;
    numbers.dedup_by(|after, before| *after - *before <= rounding);
    numbers
}

/// Iterates over the angles of one turn, rad: from 0 to 2π inclusive, every `step`. A step that is a decimal number of
/// degrees is converted as degrees: 90 degrees give the double nearest to a right angle.
pub fn turn(step: f64) -> impl Iterator<Item = f64> {
    turns(1, step)
}

/// Iterates over the angles of several turns, rad: from 0 to the end inclusive, every `step`, as [`turn`].
pub fn turns(count: u32, step: f64) -> impl Iterator<Item = f64> {
    let end = f64::from(count) * TAU;
    let whole = (end / step * (1.0 - 1e-12)).floor() as u64;
    let degrees = (step * 180.0 / PI * 1e9).round() / 1e9;
    let exact = (degrees * PI / 180.0 - step).abs() <= f64::EPSILON * step;
    (0..=whole)
        .map(move |i| {
            if exact {
                i as f64 * degrees / 180.0 * PI
            } else {
                i as f64 * step
            }
        })
        .chain([end])
}
