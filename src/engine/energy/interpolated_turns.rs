//! Turns that follow from the kinetic energy at their start, by interpolation between turns that were computed.

use super::segment::Segment;
use crate::numeric::chebyshev::{Rule, Series};
use crate::numeric::exact::two_sum;

/// The start of a turn.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Mark {
    /// Turns before it, without sign.
    pub turns: f64,
    /// s, rounded value and rest
    pub t: (f64, f64),
    /// J
    pub kinetic: f64,
    /// Work of the loads without a potential until here, J.
    pub work: f64,
    /// What the rounded energy and work leave out, J: turns that gain the same round in the same direction.
    pub low: [f64; 2],
}

impl Mark {
    /// Seconds from here until a time.
    pub fn until(&self, t: f64) -> f64 {
        (t - self.t.0) - self.t.1
    }

    /// The start of the turn after `count` turns like this one.
    pub fn after(&self, step: &Turn, count: f64) -> Mark {
        let (sum, lost) = two_sum(self.t.0, count * step.duration);
        let (kinetic, kinetic_low) = two_sum(self.kinetic, count * step.gain + self.low[0]);
        let (work, work_low) = two_sum(self.work, count * step.work + self.low[1]);
        Mark {
            turns: self.turns + count * step.count,
            t: two_sum(sum, lost + self.t.1),
            kinetic,
            work,
            low: [kinetic_low, work_low],
        }
    }
}

/// What a turn does, or several that are repeated together.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Turn {
    /// How many turns it is.
    pub count: f64,
    /// s
    pub duration: f64,
    /// Kinetic energy gained, J.
    pub gain: f64,
    /// J
    pub work: f64,
}

/// Turns over a range of the kinetic energy at their start.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Cell {
    /// Turns that are repeated together.
    pub count: f64,
    middle: f64,
    half: f64,
    rule: &'static Rule,
    segments: Vec<Segment>,
    duration: Series,
    gain: Series,
    work: Series,
}

impl Cell {
    /// A cell from turns that begin with the energies `middle + half·x`, J, at the points x of a rule.
    pub fn new(middle: f64, half: f64, rule: &'static Rule, turns: Vec<(Segment, Turn)>) -> Cell {
        let series = |of: fn(&Turn) -> f64| {
            let mut values = [0.0; crate::numeric::chebyshev::MAX_DEGREE + 1];
            for (value, (_, turn)) in values.iter_mut().zip(&turns) {
                *value = of(turn);
            }
            rule.series(&values)
        };
        Cell {
            count: turns.first().map_or(1.0, |(_, turn)| turn.count),
            middle,
            half,
            rule,
            duration: series(|turn| turn.duration),
            gain: series(|turn| turn.gain),
            work: series(|turn| turn.work),
            segments: turns.into_iter().map(|(segment, _)| segment).collect(),
        }
    }

    /// What the interpolation leaves out: relative to the duration, and to the kinetic energy.
    pub fn tail(&self) -> f64 {
        let gain = self.gain.tail() * self.gain.largest() / self.middle;
        self.duration.tail().max(gain)
    }

    pub fn covers(&self, kinetic: f64) -> bool {
        (kinetic - self.middle).abs() <= self.half
    }

    pub fn turn(&self, kinetic: f64) -> Turn {
        let x = (kinetic - self.middle) / self.half;
        Turn {
            count: self.count,
            duration: self.duration.value(x),
            gain: self.gain.value(x),
            work: self.work.value(x),
        }
    }

    fn segment(&self, kinetic: f64) -> Segment {
        let x = (kinetic - self.middle) / self.half;
        Segment::blend(&self.segments, &self.rule.shares(x)[..self.segments.len()])
    }
}

/// A map of the kinetic energy over a turn.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Interpolated {
    pub cells: Vec<Cell>,
    /// Whether the turns from the last mark but one on are all the same.
    pub steady: bool,
}

impl Interpolated {
    fn cell(&self, kinetic: f64) -> Option<&Cell> {
        self.cells.iter().rev().find(|cell| cell.covers(kinetic))
    }

    /// What the turn with this energy (J) at its start does.
    pub fn turn(&self, kinetic: f64) -> Option<Turn> {
        Some(self.cell(kinetic)?.turn(kinetic))
    }

    /// The motion of that turn; no panels where no cell covers the energy.
    pub fn segment(&self, kinetic: f64) -> Segment {
        let cell = self.cell(kinetic);
        cell.map_or_else(Segment::open, |cell| cell.segment(kinetic))
    }
}
