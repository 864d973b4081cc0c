//! Long runs: the map of the kinetic energy over one turn, interpolated.

use std::f64::consts::TAU;

use super::march::March;
use super::{Done, Driven, Driving, Goal, Resolution, work_until};
use crate::engine::energy::leg::Leg;
use crate::engine::energy::turns::{Cell, Mark, Turn, Turns};
use crate::engine::energy::{Orbit, Unserved};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Rule;

/// Degree of the interpolation over the energy.
const DEGREE: usize = 16;
/// The widest cell, relative to the energy at its start.
const WIDEST: f64 = 0.5;
/// The narrowest.
const NARROWEST: f64 = 1e-7;
/// Turns between the marks that are kept.
const BETWEEN_MARKS: f64 = 64.0;
/// Most turns that are iterated.
const MOST_TURNS: f64 = 2e9;

/// Goes on from the start of a turn until the goal.
pub(super) fn run<D: Driven>(
    march: March<'_, D>,
    leg: Leg,
    start: Angle,
    speed: f64,
    goal: Goal,
    resolution: Resolution,
) -> Result<Driving, Unserved> {
    let mark = Mark {
        turns: march.turns.abs(),
        t: march.t,
        kinetic: march.kinetic,
        work: march.work,
    };
    let mut way = Way {
        tail: resolution.tail,
        width: WIDEST,
        rises: march.rises(),
        march,
        turns: Turns {
            cells: Vec::new(),
            marks: vec![mark],
            last: Leg::open(),
            steady: false,
        },
    };
    let last = way.turn_of(goal)?;
    let done = way.last_turn(&last, goal, start)?;
    let before = last.work + way.march.work - done.work;
    let evaluations = way.march.evaluations;
    let turns = way.turns;
    let orbit = Orbit::of_turns(start, speed, leg, turns);
    let end = match goal {
        Goal::Time(until) => until,
        Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(last.t.0),
    };
    let work = before + work_until(orbit.last_leg(), end - last.t.0 - last.t.1, &done);
    Ok(Driving {
        orbit,
        end,
        work,
        evaluations,
    })
}

struct Way<'a, D: Driven> {
    march: March<'a, D>,
    turns: Turns,
    tail: f64,
    width: f64,
    /// Whether the energy rises from turn to turn.
    rises: bool,
}

impl<D: Driven> Way<'_, D> {
    /// The start of the turn in which the goal lies.
    fn turn_of(&mut self, goal: Goal) -> Result<Mark, Unserved> {
        let mut mark = self.turns.marks[0];
        let first = mark.turns;
        let mut known = mark.turns;
        loop {
            let turn = match self.turns.turn(mark.kinetic) {
                Some(turn) => turn,
                None => self.extend(mark.kinetic)?,
            };
            let left = match goal {
                Goal::Time(until) => ((until - mark.t.0) - mark.t.1) / turn.duration,
                Goal::Turned(way) => way / TAU - mark.turns,
            };
            let is_steady = turn.gain.abs() <= 2.0 * f64::EPSILON * mark.kinetic;
            if left < 1.0 || is_steady {
                if mark.turns > known {
                    self.turns.marks.push(mark);
                }
                if left >= 1.0 {
                    self.turns.steady = true;
                    let same = Turn { gain: 0.0, ..turn };
                    mark = mark.after(&same, left.floor());
                    self.turns.marks.push(mark);
                }
                return Ok(mark);
            }
            if mark.turns - known >= BETWEEN_MARKS {
                self.turns.marks.push(mark);
                known = mark.turns;
            }
            if mark.turns - first > MOST_TURNS {
                return Err(Unserved::TooLong);
            }
            self.rises = turn.gain > 0.0;
            mark = mark.after(&turn, 1.0);
        }
    }

    /// A cell that begins at this energy, J, and what its turn does.
    fn extend(&mut self, kinetic: f64) -> Result<Turn, Unserved> {
        loop {
            let (ahead, behind) = (self.width * kinetic, 0.01 * self.width * kinetic);
            let (low, high) = if self.rises {
                (kinetic - behind, kinetic + ahead)
            } else {
                (kinetic - ahead, kinetic + behind)
            };
            match self.cell(0.5 * (low + high), 0.5 * (high - low)) {
                Ok(Some(cell)) => {
                    let turn = cell.turn(kinetic);
                    self.turns.cells.push(cell);
                    self.width = (2.0 * self.width).min(WIDEST);
                    return Ok(turn);
                }
                Ok(None) | Err(Unserved::TooSlow | Unserved::NotSmooth)
                    if self.width > NARROWEST =>
                {
                    self.width *= 0.5;
                }
                Ok(None) => return Err(Unserved::NotSmooth),
                Err(unserved) => return Err(unserved),
            }
        }
    }

    /// A cell over a range of energies; none if it is too wide.
    fn cell(&mut self, middle: f64, half: f64) -> Result<Option<Cell>, Unserved> {
        let rule = Rule::of(DEGREE);
        let mut turns = Vec::with_capacity(DEGREE + 1);
        while turns.len() <= DEGREE {
            let kinetic = middle + half * rule.points()[turns.len()];
            let turn = self.whole_turn(kinetic)?;
            // All turns of a cell are cut in the same way.
            if self.march.refined {
                self.march.settle()?;
                turns.clear();
            } else {
                turns.push(turn);
            }
        }
        let cell = Cell::new(middle, half, rule, turns);
        Ok((cell.tail() <= self.tail).then_some(cell))
    }

    fn whole_turn(&mut self, kinetic: f64) -> Result<(Leg, Turn), Unserved> {
        self.march.restart(kinetic);
        let mut leg = Leg::open();
        loop {
            leg.push(self.march.panel()?.panel);
            if self.march.at_turn() {
                let turn = Turn {
                    duration: self.march.t.0,
                    gain: self.march.gain,
                    work: self.march.work,
                };
                return Ok((leg, turn));
            }
        }
    }

    /// The turn in which the goal lies, as far as the goal, and its last panel.
    fn last_turn(&mut self, mark: &Mark, goal: Goal, start: Angle) -> Result<Done, Unserved> {
        self.march.restart(mark.kinetic);
        loop {
            let done = self.march.panel()?;
            self.turns.last.push(done.panel.clone());
            let passed = match goal {
                Goal::Time(until) => self.march.t.0 > (until - mark.t.0) - mark.t.1,
                Goal::Turned(way) => {
                    let turned = (done.panel.piece.to - start.rest).abs() + mark.turns * TAU;
                    turned >= way - 1e-12
                }
            };
            if passed || self.march.at_turn() {
                return Ok(done);
            }
        }
    }
}
