//! Many turns that gain the same energy each: what they take together is a sum over a smooth function.
//!
//! Where the forces depend on the angle alone and are the same in each turn, turn n begins with the kinetic
//! energy K₀ + nW and takes the time T(K₀ + nW). T is expanded in Chebyshev series over cells of the energy;
//! the sum over the turns of a cell is that of Euler and Maclaurin. A million turns are a few dozen cells.

use std::f64::consts::TAU;

use super::leg::{After, Leg};
use super::one_turn::OneTurn;
use super::turns::Mark;
use super::{Profile, Unserved};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{Rule, Series};
use crate::numeric::exact::two_sum;
use crate::numeric::gauss;

/// Degree of the series over the energy.
const DEGREE: usize = 24;
/// How far a cell goes beyond the least energy that occurs in its first turn, in parts of it: the nearest
/// singularity of T is where this energy vanishes.
const WIDEST: f64 = 1.5;
/// Widths below this part of the widest are given up.
const NARROWEST: f64 = 1e-3;
/// Where the series of T have decayed to rounding.
const TAIL: f64 = 1e-14;
/// Steps of x up to which the sum is that of Euler and Maclaurin: the next term is below rounding.
const SMALL_STEP: f64 = 1.0 / 64.0;
/// Most cells.
const MOST_CELLS: usize = 2000;
/// Turns after the last cell that are computed one by one.
const LAST_TURNS: f64 = 256.0;

/// Many turns, each with the same gain.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Gains {
    cells: Vec<Cell>,
    /// What follows after the cells, if they do not reach the end.
    last: Option<(Mark, Leg)>,
    /// How far times may be off, s.
    pub error: f64,
}

/// Where the turns begin, and what each gains.
pub(super) struct Course<'a> {
    pub profile: &'a dyn Profile,
    /// rad
    pub start: f64,
    pub direction: f64,
    /// Kinetic energy before the first turn, J.
    pub kinetic: f64,
    /// J
    pub gain: f64,
    /// How far the gain may be off, J.
    pub gain_error: f64,
    /// Tail at which series end.
    pub tolerance: f64,
}

impl Course<'_> {
    fn kinetic_after(&self, turns: f64) -> f64 {
        turns.mul_add(self.gain, self.kinetic)
    }

    fn mark(&self, turns: f64, t: (f64, f64)) -> Mark {
        Mark {
            turns,
            t,
            kinetic: self.kinetic_after(turns),
            work: 0.0,
        }
    }

    fn one_turn(&self, kinetic: f64) -> Option<OneTurn> {
        let (start, direction) = (self.start, self.direction);
        OneTurn::new(self.profile, start, direction, kinetic, self.tolerance)
    }

    /// The cell that begins with a turn; none if the crank is too near to rest.
    fn cell(&self, first: Mark) -> Option<Cell> {
        let here = self.one_turn(first.kinetic)?;
        let least = here.least(first.kinetic);
        let mut share = 1.0;
        while share > NARROWEST && least > 0.0 {
            let made = if self.gain >= 0.0 {
                let width = share * WIDEST * least;
                self.cell_over(first, first.kinetic, width, here.clone())
            } else {
                // As wide seen from its other end.
                let width = share * least * WIDEST / (1.0 + WIDEST);
                self.one_turn(first.kinetic - width)
                    .and_then(|turn| self.cell_over(first, first.kinetic - width, width, turn))
            };
            if made.is_some() {
                return made;
            }
            share *= 0.5;
        }
        None
    }

    fn cell_over(&self, first: Mark, low: f64, width: f64, turn: OneTurn) -> Option<Cell> {
        let (half, rule) = (0.5 * width, Rule::of(DEGREE));
        let middle = low + half;
        let duration = rule.series(&rule.values(|x| turn.duration(middle + half * x)));
        let step = self.gain / half;
        let count = (2.0 / step.abs()).floor();
        (duration.tail() <= TAIL && count >= 1.0).then(|| Cell {
            first,
            count,
            step,
            half,
            gain: self.gain,
            correction: correction(&duration, step),
            slope: duration.derivative(),
            duration,
            turn,
        })
    }
}

/// Turns over a range of the kinetic energy at their start, x in [−1, 1].
#[derive(Clone, Debug)]
struct Cell {
    first: Mark,
    /// Turns until the next cell.
    count: f64,
    /// Of x from turn to turn.
    step: f64,
    /// J
    half: f64,
    /// J
    gain: f64,
    /// T, s
    duration: Series,
    /// Its derivative.
    slope: Series,
    /// The end terms of the sum.
    correction: Series,
    turn: OneTurn,
}

/// The end terms of the sum of Euler and Maclaurin: −T/2 + h T'/12 − h³ T'''/720 + h⁵ T⁽⁵⁾/30240.
fn correction(duration: &Series, h: f64) -> Series {
    let first = duration.derivative();
    let third = first.derivative().derivative();
    let fifth = third.derivative().derivative();
    let terms = [
        (duration, -0.5),
        (&first, h / 12.0),
        (&third, -h.powi(3) / 720.0),
        (&fifth, h.powi(5) / 30240.0),
    ];
    Series::blend(terms.into_iter())
}

impl Cell {
    fn x(&self, turns: f64) -> f64 {
        let begin = if self.step < 0.0 { 1.0 } else { -1.0 };
        turns.mul_add(self.step, begin)
    }

    fn kinetic(&self, turns: f64) -> f64 {
        turns.mul_add(self.gain, self.first.kinetic)
    }

    /// The time that the first so many turns take, s.
    fn time(&self, turns: f64) -> f64 {
        if self.step.abs() > SMALL_STEP {
            let each = (0..turns as u32).map(|i| self.duration.value(self.x(f64::from(i))));
            return each.sum();
        }
        let (from, to) = (self.x(0.0), self.x(turns));
        let mean: f64 = gauss::rule_14()
            .iter()
            .map(|(u, weight)| weight * self.duration.value(from + u * (to - from)))
            .sum();
        turns.mul_add(
            mean,
            self.correction.value(to) - self.correction.value(from),
        )
    }

    /// The turn in which a time after the first one's start lies, and the time that is left.
    fn turn_at(&self, after: f64) -> (f64, f64) {
        let last = self.count - 1.0;
        let mut turns = 0.0;
        if self.step.abs() > SMALL_STEP {
            let mut left = after;
            while turns < last {
                let duration = self.duration.value(self.x(turns));
                if left < duration {
                    break;
                }
                left -= duration;
                turns += 1.0;
            }
            return (turns, left);
        }
        // Newton on the sum, which is smooth in the number of turns.
        turns = (after / self.duration.value(self.x(0.0))).clamp(0.0, last);
        for _ in 0..60 {
            let late = after - self.time(turns);
            let next = (turns + late / self.duration.value(self.x(turns))).clamp(0.0, last);
            let change = (next - turns).abs();
            turns = next;
            if change <= 0.01 {
                break;
            }
        }
        turns = turns.floor();
        let left = after - self.time(turns);
        if left < 0.0 && turns > 0.0 {
            turns -= 1.0;
        } else if turns < last && left >= self.duration.value(self.x(turns)) {
            turns += 1.0;
        }
        (turns, after - self.time(turns))
    }

    fn mark(&self, turns: f64) -> Mark {
        let (sum, lost) = two_sum(self.first.t.0, self.time(turns));
        Mark {
            turns: self.first.turns + turns,
            t: two_sum(sum, lost + self.first.t.1),
            kinetic: self.kinetic(turns),
            work: 0.0,
        }
    }

    /// How far the time of so many turns may be off because energies are, s.
    fn error(&self, turns: f64, course: &Course<'_>) -> f64 {
        let rounding = f64::EPSILON * (course.kinetic + self.turn.largest_work());
        let off = rounding + (self.first.turns + turns) * course.gain_error;
        let steepest = [0.0, turns].map(|turns| self.slope.value(self.x(turns)).abs() / self.half);
        let steepest = steepest[0].max(steepest[1]);
        turns * steepest * off + self.duration.tail() / DEGREE as f64 * self.time(turns)
    }
}

impl Gains {
    /// The turns after the first `done` ones, which end at the time `t` (s, rounded value and rest), until a time;
    /// none if the crank comes to rest or turns back before.
    pub(super) fn new(
        course: &Course<'_>,
        done: f64,
        t: (f64, f64),
        until: f64,
    ) -> Result<Option<Gains>, Unserved> {
        let mut gains = Gains {
            cells: Vec::new(),
            last: None,
            error: 0.0,
        };
        let mut mark = course.mark(done, t);
        while gains.cells.len() < MOST_CELLS {
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
            gains.cells.push(Cell { count, ..cell });
            if passed {
                return Ok(Some(gains));
            }
            mark = course.mark(end.turns, end.t);
        }
        let (from, left) = (course.start, mark.until(until));
        let leg = Leg::build(
            course.profile,
            from,
            course.direction,
            mark.kinetic,
            left,
            course.tolerance,
            LAST_TURNS,
        )?;
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

    /// Smallest and largest |speed| until a time: in the first turn or the last ones.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        let first = &self.cells[0];
        let mut range = first
            .turn
            .leg(first.first.kinetic)
            .speed_range(f64::INFINITY);
        let mut add = |leg: Leg, until: f64| {
            let (low, high) = leg.speed_range(until);
            range = (range.0.min(low), range.1.max(high));
        };
        let cell = self.cell(|mark| mark.until(until) >= 0.0);
        let (turns, left) = cell.turn_at(cell.first.until(until));
        if turns > 0.0 {
            add(cell.turn.leg(cell.kinetic(turns - 1.0)), f64::INFINITY);
        }
        match self.last.as_ref().filter(|last| last.0.until(until) >= 0.0) {
            Some((mark, leg)) => {
                add(cell.turn.leg(cell.kinetic(turns)), f64::INFINITY);
                add(leg.clone(), mark.until(until));
            }
            None => add(cell.turn.leg(cell.kinetic(turns)), left),
        }
        range
    }

    /// Calls for each turn in order, with its start and its motion, until it says that it is enough.
    pub fn each_turn(&self, mut visit: impl FnMut(&Mark, &Leg) -> bool) {
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

    /// Largest kinetic energy at the starts of turns, J.
    pub fn largest_kinetic(&self) -> f64 {
        let ends = self
            .cells
            .iter()
            .flat_map(|cell| [0.0, cell.count].map(|turns| cell.kinetic(turns)));
        ends.fold(0.0, f64::max)
    }
}
