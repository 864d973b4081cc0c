//! Many turns in one direction, each of which follows from the kinetic energy at its start.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

use super::euler_maclaurin;
use super::interpolated_turns::{Interpolated, Mark, Turn};
use super::segment::Segment;
use crate::numeric::angle::Angle;

/// How turns follow from each other.
#[derive(Clone, Debug)]
pub(in crate::engine) enum Map {
    /// Each follows from the energy of the one before, by interpolation.
    Interpolated(Interpolated),
    /// Each gains the same energy; a cell begins at each mark but the last.
    Gaining(Vec<euler_maclaurin::EulerMaclaurinCell>),
}

/// Many turns in one direction.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Turns {
    pub map: Map,
    /// Starts of some of the turns, in order, the first and the last turn among them.
    pub marks: Vec<Mark>,
    /// The last turns, as far as they were needed.
    pub last: Segment,
    /// The turn that was asked for last.
    pub recent: Recent,
    /// How far times may be off, s, as far as the panels say.
    pub error: f64,
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
        let (_, segment) = recent.insert(known.unwrap_or_else(|| (*mark, Arc::new(new()))));
        Arc::clone(segment)
    }
}

impl Clone for Recent {
    fn clone(&self) -> Recent {
        Recent::default()
    }
}

/// A place in many turns.
#[derive(Clone, Copy, Debug)]
enum Goal {
    /// s
    Time(f64),
    /// Whole turns before it.
    Turns(f64),
}

impl Goal {
    /// Turns like these until it.
    fn left(self, mark: &Mark, turn: &Turn) -> f64 {
        match self {
            Goal::Time(t) => mark.until(t) / turn.duration,
            Goal::Turns(turns) => (turns - mark.turns) / turn.count,
        }
    }

    fn is_after(self, mark: &Mark) -> bool {
        match self {
            Goal::Time(t) => mark.until(t) >= 0.0,
            Goal::Turns(turns) => mark.turns <= turns,
        }
    }
}

impl Turns {
    /// Index of the last mark before a goal.
    fn index(&self, goal: Goal) -> usize {
        self.marks
            .partition_point(|mark| goal.is_after(mark))
            .max(1)
            - 1
    }

    /// The start of the last turn before a goal.
    fn find(&self, goal: Goal) -> Mark {
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
                let Some(turn) = map.turn(mark.kinetic) else {
                    return mark;
                };
                let turn = Turn { gain: 0.0, ..turn };
                mark.after(&turn, goal.left(&mark, &turn).max(0.0).floor())
            }
            Map::Interpolated(map) => {
                while let Some(turn) = map.turn(mark.kinetic) {
                    let next = mark.after(&turn, 1.0);
                    if !goal.is_after(&next) || next.turns >= end.turns {
                        break;
                    }
                    mark = next;
                }
                mark
            }
        }
    }

    /// The last mark.
    pub fn last_mark(&self) -> &Mark {
        &self.marks[self.marks.len() - 1]
    }

    /// What is asked for of the motion in the turn that begins at a mark.
    fn on_leg<T>(&self, mark: &Mark, of: impl FnOnce(&Segment) -> T) -> T {
        if mark.turns >= self.last_mark().turns {
            return of(&self.last);
        }
        let segment = || match &self.map {
            Map::Gaining(cells) => cells[self.index(Goal::Turns(mark.turns))].segment(mark.kinetic),
            Map::Interpolated(map) => map.segment(mark.kinetic),
        };
        of(&self.recent.or_new(mark, segment))
    }

    /// Angle from the start of the run's first turn, and speed.
    pub fn state(&self, t: f64, direction: f64) -> (Angle, f64) {
        let mark = self.find(Goal::Time(t));
        let (angle, speed) = self.on_leg(&mark, |segment| segment.state(mark.until(t)));
        let angle = Angle::new(angle.turns + direction * mark.turns, angle.rest);
        (angle, speed)
    }

    /// When the crank has turned by `radians` from the start angle `rest` (rad), s, and its speed there (rad/s).
    pub fn passage(&self, radians: f64, rest: f64, direction: f64) -> Option<(f64, f64)> {
        let whole = (radians / TAU).floor();
        let mark = self.find(Goal::Turns(whole));
        let ahead = radians - mark.turns * TAU;
        let angle = Angle::from(rest + direction * ahead);
        let (after, speed) = self.on_leg(&mark, |segment| segment.at(angle))?;
        Some((mark.t.0 + (mark.t.1 + after), speed))
    }

    /// Smallest and largest |speed| until a time.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        let last = self.find(Goal::Time(until));
        let by_energy = |a: &&Mark, b: &&Mark| a.kinetic.total_cmp(&b.kinetic);
        let whole = || self.marks.iter().filter(|mark| mark.turns < last.turns);
        let mut range = self.on_leg(&last, |segment| segment.speed_range(0.0, last.until(until)));
        let first = whole().next().copied();
        // The energies of the turns rise or fall, but not all turns have marks.
        let cycle = match &self.map {
            Map::Interpolated(map) => map.cells.first().map_or(1.0, |cell| cell.count),
            Map::Gaining(_) => 1.0,
        };
        let before_last = last.turns - cycle;
        let before_last =
            (before_last >= self.marks[0].turns).then(|| self.find(Goal::Turns(before_last)));
        let marks = [
            whole().min_by(by_energy).copied(),
            whole().max_by(by_energy).copied(),
            first,
            before_last,
        ];
        for mark in marks.into_iter().flatten() {
            let (low, high) = self.on_leg(&mark, |segment| segment.speed_range(0.0, f64::INFINITY));
            range = (range.0.min(low), range.1.max(high));
        }
        range
    }

    /// The time until which it is known, s.
    pub fn end(&self) -> f64 {
        self.last_mark().t.0 + self.last.duration.0
    }

    /// Largest kinetic energy at the starts of turns and in the last ones, as far as they begin before a time (s), J.
    pub fn largest_kinetic(&self, until: f64) -> f64 {
        let reached = self.find(Goal::Time(until));
        let marks = self
            .marks
            .iter()
            .take_while(|mark| mark.until(until) >= 0.0);
        let most = marks.fold(reached.kinetic, |most, mark| most.max(mark.kinetic));
        if reached.turns < self.last_mark().turns {
            most
        } else {
            most.max(self.last.largest_kinetic())
        }
    }
}
