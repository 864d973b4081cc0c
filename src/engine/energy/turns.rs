//! Turns that follow from the kinetic energy at their start, by interpolation between turns that were computed.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

use super::segment::Segment;
use crate::numeric::angle::Angle;
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
    count: f64,
    middle: f64,
    half: f64,
    rule: &'static Rule,
    legs: Vec<Segment>,
    duration: Series,
    gain: Series,
    work: Series,
}

impl Cell {
    /// A cell from turns that begin with the energies `middle + half·x`, J, at the points x of a rule.
    pub fn new(middle: f64, half: f64, rule: &'static Rule, turns: Vec<(Segment, Turn)>) -> Cell {
        let series = |of: fn(&Turn) -> f64| {
            let mut values = [0.0; crate::numeric::chebyshev::MOST + 1];
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
            legs: turns.into_iter().map(|(leg, _)| leg).collect(),
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

    fn leg(&self, kinetic: f64) -> Segment {
        let x = (kinetic - self.middle) / self.half;
        Segment::blend(&self.legs, &self.rule.shares(x)[..self.legs.len()])
    }
}

/// Many turns in one direction.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Turns {
    pub cells: Vec<Cell>,
    /// Starts of some of the turns, in order, the first and the last turn among them.
    pub marks: Vec<Mark>,
    /// The last turn, as far as it was needed.
    pub last: Segment,
    /// Whether the turns from the last mark but one on are all the same.
    pub steady: bool,
    /// The turn that was asked for last.
    pub recent: Recent,
}

/// The motion in one turn, with the mark at which it begins: rows and events of a turn follow each other.
#[derive(Debug, Default)]
pub(in crate::engine) struct Recent(Mutex<Option<(Mark, Arc<Segment>)>>);

impl Recent {
    fn or_new(&self, mark: &Mark, new: impl FnOnce() -> Segment) -> Arc<Segment> {
        let mut recent = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = recent.take().filter(|(known, _)| {
            known.turns.to_bits() == mark.turns.to_bits()
                && known.kinetic.to_bits() == mark.kinetic.to_bits()
        });
        let (_, leg) = recent.insert(known.unwrap_or_else(|| (*mark, Arc::new(new()))));
        Arc::clone(leg)
    }
}

impl Clone for Recent {
    fn clone(&self) -> Recent {
        Recent::default()
    }
}

impl Turns {
    /// The turn after a mark.
    pub fn turn(&self, kinetic: f64) -> Option<Turn> {
        Some(self.cell(kinetic)?.turn(kinetic))
    }

    fn cell(&self, kinetic: f64) -> Option<&Cell> {
        self.cells.iter().rev().find(|cell| cell.covers(kinetic))
    }

    /// The start of the turn before which `is_before` does not hold any more, from the marks before it.
    fn find(
        &self,
        is_before: impl Fn(&Mark) -> bool,
        turns_left: impl Fn(&Mark, &Turn) -> f64,
    ) -> Mark {
        let index = self.marks.partition_point(&is_before).max(1) - 1;
        let mut mark = self.marks[index];
        if index + 1 == self.marks.len() {
            return mark;
        }
        if self.steady && index + 2 == self.marks.len() {
            let Some(turn) = self.turn(mark.kinetic) else {
                return mark;
            };
            let turn = Turn { gain: 0.0, ..turn };
            return mark.after(&turn, turns_left(&mark, &turn).max(0.0).floor());
        }
        while let Some(turn) = self.turn(mark.kinetic) {
            let next = mark.after(&turn, 1.0);
            if !is_before(&next) || next.turns >= self.marks[index + 1].turns {
                break;
            }
            mark = next;
        }
        mark
    }

    /// The last mark.
    pub fn last_mark(&self) -> &Mark {
        &self.marks[self.marks.len() - 1]
    }

    /// What is asked for of the motion in the turn that begins at a mark.
    fn on_leg<T>(&self, mark: &Mark, of: impl FnOnce(&Segment) -> T) -> T {
        let whole = mark.turns < self.last_mark().turns;
        let Some(cell) = self.cell(mark.kinetic).filter(|_| whole) else {
            return of(&self.last);
        };
        of(&self.recent.or_new(mark, || cell.leg(mark.kinetic)))
    }

    /// Angle from the start of the run's first turn, and speed.
    pub fn state(&self, t: f64, direction: f64) -> (Angle, f64) {
        let left = |mark: &Mark, turn: &Turn| mark.until(t) / turn.duration;
        let mark = self.find(|mark| mark.until(t) >= 0.0, left);
        let (angle, speed) = self.on_leg(&mark, |leg| leg.state(mark.until(t)));
        let angle = Angle {
            turns: angle.turns + direction * mark.turns,
            rest: angle.rest,
        };
        (angle, speed)
    }

    /// When the crank has turned by `radians`, from the start angle `rest` (rad).
    pub fn time_of_turn(&self, radians: f64, rest: f64, direction: f64) -> Option<f64> {
        let whole = (radians / TAU).floor();
        let left = |mark: &Mark, turn: &Turn| (whole - mark.turns) / turn.count;
        let mark = self.find(|mark| mark.turns <= whole, left);
        let ahead = radians - mark.turns * TAU;
        let angle = Angle::from(rest + direction * ahead);
        let after = self.on_leg(&mark, |leg| leg.time_of(angle))?;
        Some(mark.t.0 + (mark.t.1 + after))
    }

    /// Smallest and largest |speed| until a time.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        let last = self.last_mark();
        let by_energy = |a: &&Mark, b: &&Mark| a.kinetic.total_cmp(&b.kinetic);
        let whole = || self.marks.iter().filter(|mark| mark.turns < last.turns);
        let mut range = self.last.speed_range(0.0, last.until(until));
        let first = whole().next().copied();
        // The energies of the turns rise or fall, but not all turns have marks.
        let before_last = (last.turns >= 1.0).then(|| {
            let turns = last.turns - self.cells.first().map_or(1.0, |cell| cell.count);
            let left = |mark: &Mark, turn: &Turn| (turns - mark.turns) / turn.count;
            self.find(|mark| mark.turns <= turns, left)
        });
        let marks = [
            whole().min_by(by_energy).copied(),
            whole().max_by(by_energy).copied(),
            first,
            before_last,
        ];
        for mark in marks.into_iter().flatten() {
            let (low, high) = self.on_leg(&mark, |leg| leg.speed_range(0.0, f64::INFINITY));
            range = (range.0.min(low), range.1.max(high));
        }
        range
    }

    /// Calls for each turn in order, with its start and its motion, until it says that it is enough.
    pub fn each_turn(&self, mut visit: impl FnMut(&Mark, &Segment) -> bool) {
        let last = *self.last_mark();
        let mut mark = self.marks[0];
        while mark.turns < last.turns {
            if !self.on_leg(&mark, |leg| visit(&mark, leg)) {
                return;
            }
            let Some(turn) = self.turn(mark.kinetic) else {
                return;
            };
            mark = mark.after(&turn, 1.0);
        }
        visit(&last, &self.last);
    }
}
