//! Many turns that gain the same energy each: what they take together is a sum over a smooth function.
//!
//! Where the forces depend on the angle alone and are the same in each turn, turn n begins with the kinetic
//! energy K₀ + nW and takes the time T(K₀ + nW). T is expanded in Chebyshev series over cells of the energy;
//! the sum over the turns of a cell is that of Euler and Maclaurin. A million turns are a few dozen cells.

mod cell;

use std::f64::consts::TAU;

use super::NotApplicable;
use super::build::Begin;
use super::segment::{After, Segment};
use super::turns::Mark;
use crate::numeric::angle::Angle;
use crate::numeric::exact::two_sum;
use cell::Cell;
pub(super) use cell::Course;

/// Most cells.
const MOST_CELLS: usize = 2000;
/// Turns after the last cell that are computed one by one.
const LAST_TURNS: f64 = 256.0;

/// Many turns, each with the same gain.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Gains {
    cells: Vec<Cell>,
    /// What follows after the cells, if they do not reach the end.
    last: Option<(Mark, Segment)>,
    /// How far times may be off, s.
    pub error: f64,
}

impl Gains {
    /// The turns after the first `done` ones, which end at the time `t` (s, rounded value and rest), until a time;
    /// none if the crank comes to rest or turns back before.
    pub(super) fn new(
        course: &Course<'_>,
        done: f64,
        t: (f64, f64),
        until: f64,
    ) -> Result<Option<Gains>, NotApplicable> {
        let mut gains = Gains {
            cells: Vec::new(),
            last: None,
            error: 0.0,
        };
        let mut mark = course.mark(done, t);
        while gains.cells.len() < MOST_CELLS && !course.profile.is_spent() {
            let Some(cell) = course.cell(mark) else {
                break;
            };
            let after = mark.until(until);
            let passed = cell.count.is_infinite() || cell.time(cell.count) > after;
            let count = if passed {
                cell.turn_at(after).0 + 1.0
            } else {
                cell.count
            };
            gains.error += cell.error(count, course);
            let end = cell.mark(count);
            gains.cells.push(cell.shortened(count));
            if passed {
                return Ok(Some(gains));
            }
            mark = course.mark(end.turns, end.t);
        }
        let begin = Begin {
            start: course.start,
            direction: course.direction,
            kinetic: mark.kinetic,
            off: course.off_after(mark.turns),
        };
        let left = mark.until(until);
        let leg = Segment::build(course.profile, begin, left, course.tolerance, LAST_TURNS)?;
        if leg.after != After::Ends || gains.cells.is_empty() {
            return Ok(None);
        }
        gains.error += leg.error;
        gains.last = Some((mark, leg));
        Ok(Some(gains))
    }

    /// The cell before whose first turn `is_before` does not hold any more.
    fn cell(&self, is_before: impl Fn(&Mark) -> bool) -> &Cell {
        let after = self.cells.partition_point(|cell| is_before(&cell.first));
        &self.cells[after.max(1) - 1]
    }

    /// Angle from the start of the run's first turn, and speed.
    pub fn state(&self, t: f64, direction: f64) -> (Angle, f64) {
        let (turns, (rest, speed)) = match &self.last {
            Some((mark, leg)) if mark.until(t) >= 0.0 => {
                let (angle, speed) = leg.state(mark.until(t));
                let turns = mark.turns + direction * angle.turns;
                (turns, (angle.rest, speed))
            }
            _ => {
                let cell = self.cell(|mark| mark.until(t) >= 0.0);
                let (turns, left) = cell.turn_at(cell.first.until(t));
                let state = cell.turn.state(cell.kinetic(turns), left);
                (cell.first.turns + turns, state)
            }
        };
        let turns = direction * turns;
        (Angle { turns, rest }, speed)
    }

    /// When the crank has turned by `radians`, from the start angle `rest` (rad).
    pub fn time_of_turn(&self, radians: f64, rest: f64, direction: f64) -> Option<f64> {
        let whole = (radians / TAU).floor();
        let ahead = rest + direction * (radians - whole * TAU);
        if let Some((mark, leg)) = self.last.as_ref().filter(|last| whole >= last.0.turns) {
            let angle = Angle {
                turns: direction * (whole - mark.turns),
                rest: ahead,
            };
            return Some(mark.t.0 + (mark.t.1 + leg.time_of(angle)?));
        }
        let cell = self.cell(|mark| mark.turns <= whole);
        let turns = whole - cell.first.turns;
        if turns >= cell.count {
            return None;
        }
        let after = cell.turn.leg(cell.kinetic(turns)).time_of(ahead.into())?;
        let (sum, lost) = two_sum(cell.first.t.0, cell.time(turns));
        Some(sum + (lost + cell.first.t.1 + after))
    }

    /// The motion of a whole turn in the cells, by the turns before it.
    fn turn(&self, before: f64) -> Segment {
        let cell = self.cell(|mark| mark.turns <= before);
        cell.turn.leg(cell.kinetic(before - cell.first.turns))
    }

    /// Smallest and largest |speed| until a time: in the turn in which it lies, or in the first or the last one before.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        let last = self.last.as_ref();
        let (before, (low, high)) = match last.filter(|last| last.0.until(until) >= 0.0) {
            Some((mark, leg)) => (mark.turns, leg.speed_range(0.0, mark.until(until))),
            None => {
                let cell = self.cell(|mark| mark.until(until) >= 0.0);
                let (turns, left) = cell.turn_at(cell.first.until(until));
                let turns = cell.first.turns + turns;
                (turns, self.turn(turns).speed_range(0.0, left))
            }
        };
        let whole = [self.first(), before - 1.0].into_iter();
        let whole = whole.filter(|turn| (self.first()..before).contains(turn));
        whole.fold((low, high), |(low, high), turn| {
            let range = self.turn(turn).speed_range(0.0, f64::INFINITY);
            (low.min(range.0), high.max(range.1))
        })
    }

    /// Calls for each turn in order, with its start and its motion, until it says that it is enough.
    pub fn each_turn(&self, mut visit: impl FnMut(&Mark, &Segment) -> bool) {
        for cell in &self.cells {
            let mut mark = cell.first;
            let mut turns = 0.0;
            while turns < cell.count {
                let leg = cell.turn.leg(mark.kinetic);
                if !visit(&mark, &leg) {
                    return;
                }
                turns += 1.0;
                mark = cell.mark(turns);
            }
        }
        if let Some((mark, leg)) = &self.last {
            visit(mark, leg);
        }
    }

    /// Turns before the first of these.
    pub fn first(&self) -> f64 {
        self.cells[0].first.turns
    }

    /// The time until which it is known, s.
    pub fn end(&self) -> f64 {
        match &self.last {
            Some((mark, leg)) => mark.t.0 + leg.duration.0,
            None => self
                .cells
                .last()
                .map_or(0.0, |cell| cell.mark(cell.count).t.0),
        }
    }

    /// Largest kinetic energy at the starts of turns until a time (s), J: it rises or falls from turn to turn.
    pub fn largest_kinetic(&self, until: f64) -> f64 {
        let last = self.cell(|mark| mark.until(until) >= 0.0);
        let (turns, _) = last.turn_at(last.first.until(until));
        self.cells[0].kinetic(0.0).max(last.kinetic(turns))
    }
}
