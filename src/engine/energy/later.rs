//! What follows after the first turns of a long motion.

use super::euler_maclaurin::Gains;
use super::segment::Segment;
use super::turns::{Mark, Turns};
use crate::numeric::angle::Angle;

/// Many turns in one direction.
#[derive(Clone, Debug)]
pub(super) enum Later {
    /// Each follows from the energy of the one before.
    Mapped(Turns),
    /// Each gains the same energy.
    Gaining(Gains),
}

impl Later {
    /// Angle from the start of the run's first turn, and speed.
    pub fn state(&self, t: f64, direction: f64) -> (Angle, f64) {
        match self {
            Later::Mapped(turns) => turns.state(t, direction),
            Later::Gaining(gains) => gains.state(t, direction),
        }
    }

    /// When the crank has turned by `radians`, from the start angle `rest` (rad).
    pub fn time_of_turn(&self, radians: f64, rest: f64, direction: f64) -> Option<f64> {
        match self {
            Later::Mapped(turns) => turns.time_of_turn(radians, rest, direction),
            Later::Gaining(gains) => gains.time_of_turn(radians, rest, direction),
        }
    }

    /// Smallest and largest |speed| until a time.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        match self {
            Later::Mapped(turns) => turns.speed_range(until),
            Later::Gaining(gains) => gains.speed_range(until),
        }
    }

    /// Calls for each turn in order, with its start and its motion, until it says that it is enough.
    pub fn each_turn(&self, visit: impl FnMut(&Mark, &Segment) -> bool) {
        match self {
            Later::Mapped(turns) => turns.each_turn(visit),
            Later::Gaining(gains) => gains.each_turn(visit),
        }
    }

    /// Turns before the first of these.
    pub fn first(&self) -> f64 {
        match self {
            Later::Mapped(turns) => turns.marks[0].turns,
            Later::Gaining(gains) => gains.first(),
        }
    }

    /// The time until which it is known, s.
    pub fn end(&self) -> f64 {
        match self {
            Later::Mapped(turns) => turns.last_mark().t.0 + turns.last.duration.0,
            Later::Gaining(gains) => gains.end(),
        }
    }

    /// How far times may be off, s, as far as the panels say.
    pub fn error(&self) -> f64 {
        match self {
            Later::Mapped(_) => 0.0,
            Later::Gaining(gains) => gains.error,
        }
    }

    /// Largest kinetic energy until a time (s), J.
    pub fn largest_kinetic(&self, until: f64) -> f64 {
        match self {
            Later::Mapped(turns) => {
                let marks = turns.marks.iter().map(|mark| mark.kinetic);
                marks.fold(turns.last.largest_kinetic(), f64::max)
            }
            Later::Gaining(gains) => gains.largest_kinetic(until),
        }
    }
}
