//! Many turns in one direction, each determined by the kinetic energy at its start.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

use super::euler_maclaurin;
use super::interpolated_turns::{Cycle, Interpolated, TurnStart};
use super::segment::Segment;
use crate::numeric::angle::Angle;

/// Map from a turn to the next.
#[derive(Clone, Debug)]
pub(in crate::engine) enum Map {
    /// Interpolant of the energy after a cycle over the energy before it.
    Interpolated(Interpolated),
    /// Equal gains of energy; a cell begins at each mark but the last.
    Gaining(Vec<euler_maclaurin::EulerMaclaurinCell>),
}

/// Many turns in one direction.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Turns {
    pub map: Map,
    /// Starts of some of the turns, in order, including the first and the last turn.
    pub marks: Vec<TurnStart>,
    /// Panels of the last turns, up to the end of the run.
    pub last: Segment,
    /// Cache of the latest requested turn.
    pub recent: RecentTurn,
    /// Error bound of times, s, from the panels alone.
    pub error: f64,
}

/// Motion in one turn with the mark of its start, cached because rows and events ask for the same turn repeatedly.
#[derive(Debug, Default)]
pub(in crate::engine) struct RecentTurn(Mutex<Option<(TurnStart, Arc<Segment>)>>);

impl RecentTurn {
    fn or_new(&self, mark: &TurnStart, new: impl FnOnce() -> Segment) -> Arc<Segment> {
        let mut recent = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = recent.take().filter(|(known, _)| {
            known.turns.to_bits() == mark.turns.to_bits()
                && known.kinetic.to_bits() == mark.kinetic.to_bits()
        });
        let (_, segment) = recent.insert(known.unwrap_or_else(|| (*mark, Arc::new(new()))));
        Arc::clone(segment)
    }

    /// Returns the cached turn if a time (s) is inside it, further from its ends than any rounding.
    fn around(&self, t: f64) -> Option<(TurnStart, Arc<Segment>)> {
        let recent = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        recent.clone().filter(|(mark, segment)| {
            let length = segment.duration.0;
            let margin = 1e-6 * length;
            (margin..length - margin).contains(&mark.until(t))
        })
    }
}

impl Clone for RecentTurn {
    fn clone(&self) -> RecentTurn {
        RecentTurn::default()
    }
}

/// Position in many turns.
#[derive(Clone, Copy, Debug)]
enum Goal {
    /// Time, s.
    Time(f64),
    /// Number of whole turns.
    Turns(f64),
}

impl Goal {
    /// Returns the number of equal cycles from a mark to the goal.
    fn left(self, mark: &TurnStart, cycle: &Cycle) -> f64 {
        match self {
            Goal::Time(t) => mark.until(t) / cycle.duration,
            Goal::Turns(turns) => (turns - mark.turns) / cycle.count,
        }
    }

    fn is_after(self, mark: &TurnStart) -> bool {
        match self {
            Goal::Time(t) => mark.until(t) >= 0.0,
            Goal::Turns(turns) => mark.turns <= turns,
        }
    }
}

impl Turns {
    /// Returns the index of the last mark before a goal.
    fn index(&self, goal: Goal) -> usize {
        self.marks
            .partition_point(|mark| goal.is_after(mark))
            .max(1)
            - 1
    }

    /// Returns the start of the last turn before a goal.
    fn find(&self, goal: Goal) -> TurnStart {
        let index = self.index(goal);
        let mut mark = self.marks[index];
        let Some(end) = self.marks.get(index + 1) else {
            return mark;
        };
        match &self.map {
            Map::Gaining(cells) => cells[index].mark(match goal {
                Goal::Time(t) => cells[index].turn_at(mark.until(t)),
                Goal::Turns(turns) => turns - mark.turns,
            }),
            Map::Interpolated(map) if map.steady && index + 2 == self.marks.len() => {
                let Some(cycle) = map.cycle(mark.kinetic) else {
                    return mark;
                };
                let cycle = Cycle { gain: 0.0, ..cycle };
                mark.after(&cycle, goal.left(&mark, &cycle).max(0.0).floor())
            }
            Map::Interpolated(map) => {
                while let Some(cycle) = map.cycle(mark.kinetic) {
                    let next = mark.after(&cycle, 1.0);
                    if !goal.is_after(&next) || next.turns >= end.turns {
                        break;
                    }
                    mark = next;
                }
                mark
            }
        }
    }

    /// Returns the last mark.
    pub fn last_mark(&self) -> &TurnStart {
        &self.marks[self.marks.len() - 1]
    }

    /// Applies a function to the motion in the turn that begins at a mark.
    fn on_turn<T>(&self, mark: &TurnStart, of: impl FnOnce(&Segment) -> T) -> T {
        if mark.turns >= self.last_mark().turns {
            return of(&self.last);
        }
        let segment = || match &self.map {
            Map::Gaining(cells) => {
                let cell = &cells[self.index(Goal::Turns(mark.turns))];
                cell.turn.segment(mark.kinetic)
            }
            Map::Interpolated(map) => map.segment(mark.kinetic),
        };
        of(&self.recent.or_new(mark, segment))
    }

    /// Returns the angle counted from the first turn of the run, and the speed (rad/s) at a time, s.
    pub fn state(&self, t: f64, direction: f64) -> (Angle, f64) {
        let in_turn = |mark: &TurnStart, segment: &Segment| {
            let (angle, speed) = segment.state(mark.until(t));
            let turns = angle.turns + direction * mark.turns;
            (Angle::new(turns, angle.rest), speed)
        };
        if let Some((mark, segment)) = self.recent.around(t) {
            return in_turn(&mark, &segment);
        }
        let mark = self.find(Goal::Time(t));
        self.on_turn(&mark, |segment| in_turn(&mark, segment))
    }

    /// Returns the time (s) at which the crank has turned by `radians` from the angle `rest` (rad), and its speed.
    pub fn passage(&self, radians: f64, rest: f64, direction: f64) -> Option<(f64, f64)> {
        let whole = (radians / TAU).floor();
        let mark = self.find(Goal::Turns(whole));
        let ahead = radians - mark.turns * TAU;
        let angle = Angle::from(rest + direction * ahead);
        let (after, speed) = self.on_turn(&mark, |segment| segment.at(angle))?;
        Some((mark.t.0 + (mark.t.1 + after), speed))
    }

    /// Returns the smallest and largest |speed| up to a time (s), rad/s.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        let last = self.find(Goal::Time(until));
        let mut range = self.on_turn(&last, |segment| segment.speed_range(0.0, last.until(until)));
        let first = self.marks[0];
        // The energies of the turns are monotone.
        let cycle = match &self.map {
            Map::Interpolated(map) => map.cells.first().map_or(1.0, |cell| cell.count),
            Map::Gaining(_) => 1.0,
        };
        let whole = (last.turns - cycle >= first.turns).then_some(last.turns - cycle);
        let ends = whole.map(|before_last| [first, self.find(Goal::Turns(before_last))]);
        for mark in ends.into_iter().flatten() {
            let (low, high) =
                self.on_turn(&mark, |segment| segment.speed_range(0.0, f64::INFINITY));
            range = (range.0.min(low), range.1.max(high));
        }
        range
    }

    /// Returns the time up to which the motion is known, s.
    pub fn end(&self) -> f64 {
        self.last_mark().t.0 + self.last.duration.0
    }

    /// Returns the largest kinetic energy at the starts of turns, whose energies are monotone, and in the last turns,
    /// up to a time (s), J.
    pub fn largest_kinetic(&self, until: f64) -> f64 {
        let reached = self.find(Goal::Time(until));
        let most = reached.kinetic.max(self.marks[0].kinetic);
        if reached.turns < self.last_mark().turns {
            most
        } else {
            most.max(self.last.largest_kinetic())
        }
    }
}
