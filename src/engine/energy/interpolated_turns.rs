//! Cycles of turns as functions of the kinetic energy at their start, by Chebyshev interpolation of computed cycles.

use super::segment::Segment;
use crate::numeric::chebyshev::{Rule, Series};
use crate::numeric::exact::two_sum;

/// Start of a turn.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::engine) struct TurnStart {
    /// Number of turns before it, without sign.
    pub turns: f64,
    /// Time, s: rounded value and remainder.
    pub t: (f64, f64),
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Work of the non-conservative loads from the start of the run, J.
    pub work: f64,
    /// Remainders of rounded energy and work, J: for equal gains the rounding errors have one sign and add up.
    pub low: [f64; 2],
}

impl TurnStart {
    /// Returns the time from this start to a time, s.
    pub fn until(&self, t: f64) -> f64 {
        (t - self.t.0) - self.t.1
    }

    /// Returns the start of the turn after `count` equal cycles.
    pub fn after(&self, cycle: &Cycle, count: f64) -> TurnStart {
        let (sum, lost) = two_sum(self.t.0, count * cycle.duration);
        let (kinetic, kinetic_low) = two_sum(self.kinetic, count * cycle.gain + self.low[0]);
        let (work, work_low) = two_sum(self.work, count * cycle.work + self.low[1]);
        TurnStart {
            turns: self.turns + count * cycle.count,
            t: two_sum(sum, lost + self.t.1),
            kinetic,
            work,
            low: [kinetic_low, work_low],
        }
    }
}

/// Changes over one cycle.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Cycle {
    /// Number of turns in the cycle.
    pub count: f64,
    /// Duration, s.
    pub duration: f64,
    /// Kinetic energy gained, J.
    pub gain: f64,
    /// Work of the non-conservative loads, J.
    pub work: f64,
}

/// Interpolant of cycles over a range of the kinetic energy at their start.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Cell {
    /// Number of turns in a cycle.
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
    /// Makes a cell from cycles that begin with the energies `middle + half·x`, J, at the points x of a rule.
    pub fn new(middle: f64, half: f64, rule: &'static Rule, cycles: Vec<(Segment, Cycle)>) -> Cell {
        let series = |of: fn(&Cycle) -> f64| {
            let mut values = [0.0; crate::numeric::chebyshev::MAX_DEGREE + 1];
            for (value, (_, cycle)) in values.iter_mut().zip(&cycles) {
                *value = of(cycle);
            }
            rule.series(&values)
        };
        Cell {
            count: cycles.first().map_or(1.0, |(_, cycle)| cycle.count),
            middle,
            half,
            rule,
            duration: series(|cycle| cycle.duration),
            gain: series(|cycle| cycle.gain),
            work: series(|cycle| cycle.work),
            segments: cycles.into_iter().map(|(segment, _)| segment).collect(),
        }
    }

    /// Returns the truncation error, relative to the duration and to the kinetic energy, whichever is larger.
    pub fn tail(&self) -> f64 {
        let gain = self.gain.tail() * self.gain.largest() / self.middle;
        self.duration.tail().max(gain)
    }

    pub fn covers(&self, kinetic: f64) -> bool {
        (kinetic - self.middle).abs() <= self.half
    }

    /// Returns the changes over the cycle that starts with this energy, J.
    pub fn cycle(&self, kinetic: f64) -> Cycle {
        let x = (kinetic - self.middle) / self.half;
        Cycle {
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

/// Map of the kinetic energy over a cycle, piecewise by cells.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Interpolated {
    pub cells: Vec<Cell>,
    /// True if all cycles from the last mark but one on are equal.
    pub steady: bool,
}

impl Interpolated {
    fn cell(&self, kinetic: f64) -> Option<&Cell> {
        self.cells.iter().rev().find(|cell| cell.covers(kinetic))
    }

    /// Returns the changes over the cycle that starts with this energy (J); none where no cell covers it.
    pub fn cycle(&self, kinetic: f64) -> Option<Cycle> {
        Some(self.cell(kinetic)?.cycle(kinetic))
    }

    /// Computes the motion in that cycle; no panels where no cell covers the energy.
    pub fn segment(&self, kinetic: f64) -> Segment {
        let cell = self.cell(kinetic);
        cell.map_or_else(Segment::open, |cell| cell.segment(kinetic))
    }
}
