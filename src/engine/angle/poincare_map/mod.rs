//! Long runs by the Poincaré map of the kinetic energy over one cycle, interpolated. A turn is a cycle here.

mod cells;

use std::f64::consts::TAU;

use super::super::energy::NotApplicable;
use super::super::energy::interpolated_turns::{Cycle, Interpolated, TurnStart};
use super::super::energy::segment::Segment;
use super::super::energy::turns::{Map, RecentTurn, Turns};
use super::stepper::PanelStepper;
use super::{AngleRun, Dynamics, Goal};
use crate::engine::WorkLimit;

/// Degree of the interpolation over the energy: a cell costs one turn more than this.
const MAP_DEGREE: usize = 16;
/// Turns computed one by one before the map takes over, and again where it ends: about what its first three cells cost.
pub(super) const SINGLE_TURNS: f64 = 3.0 * MAP_DEGREE as f64;

/// Continues from the start of a turn to the goal, or as far as the angle can be the independent variable.
pub(super) fn run<D: Dynamics>(
    stepper: PanelStepper<'_, D>,
    segment: Segment,
    goal: Goal,
) -> Result<AngleRun, NotApplicable> {
    let mark = TurnStart {
        turns: stepper.progress.turns.abs(),
        t: stepper.progress.t,
        kinetic: stepper.progress.kinetic,
        work: stepper.progress.work,
        low: [0.0; 2],
    };
    let (errors, first) = (stepper.progress.errors, stepper.progress.t.0);
    let mut run = MapRun {
        width: f64::INFINITY,
        gain: stepper.progress.gain / mark.turns * f64::from(stepper.dynamics.cycle()),
        stepper,
        map: Interpolated {
            cells: Vec::new(),
            steady: false,
        },
        marks: vec![mark],
        last: Segment::open(),
    };
    let (last, why) = run.turn_of(goal);
    let why = run.last_turns(&last, goal, why);
    let turns = Turns {
        map: Map::Interpolated(run.map),
        marks: run.marks,
        last: run.last,
        recent: RecentTurn::default(),
        error: 0.0,
    };
    let whole = (segment, Some(turns));
    let run = run.stepper.finished(whole, &last, goal, why)?;
    Ok(AngleRun {
        shapes: Vec::new(),
        // Errors grow as in the first turns.
        errors: errors.over(run.end / first),
        ..run
    })
}

/// Run by the map, from its first turn to the turn with the goal.
struct MapRun<'a, D: Dynamics> {
    stepper: PanelStepper<'a, D>,
    map: Interpolated,
    marks: Vec<TurnStart>,
    /// Panels of the turn with the goal, or of single turns after an early end of the map.
    last: Segment,
    /// Width of the next cell, relative to the energy at its start.
    width: f64,
    /// Kinetic energy gained in the last turn, J.
    gain: f64,
}

impl<D: Dynamics> MapRun<'_, D> {
    /// Returns the start of the turn with the goal, or of a turn before the end of the map with the reason for the end.
    fn turn_of(&mut self, goal: Goal) -> (TurnStart, Option<NotApplicable>) {
        let mut mark = self.marks[0];
        let first = mark.turns;
        let mut known = mark;
        let mut before = mark;
        // A state between two kept marks takes that many evaluations of the map at most.
        let turns_between_marks = 48.0;
        // Iterated in some seconds.
        let most_turns = 1e8;
        loop {
            let turn = match self.map.cycle(mark.kinetic) {
                Some(turn) => turn,
                None => match self.extend(mark.kinetic) {
                    Ok(turn) => turn,
                    Err(why) => {
                        // The turn before is known to be completed.
                        if before.turns > known.turns {
                            self.marks.push(before);
                        }
                        return (before, Some(why));
                    }
                },
            };
            let left = match goal {
                Goal::Time(until) => mark.until(until) / turn.duration,
                Goal::Turned(way) => (way / TAU - mark.turns) / turn.count,
            };
            let is_steady = turn.gain.abs() <= 2.0 * f64::EPSILON * mark.kinetic;
            if left < 1.0 || is_steady {
                if mark.turns > known.turns {
                    self.marks.push(mark);
                }
                if left >= 1.0 {
                    self.map.steady = true;
                    let same = Cycle { gain: 0.0, ..turn };
                    mark = mark.after(&same, left.floor());
                    self.marks.push(mark);
                }
                return (mark, None);
            }
            if mark.turns - known.turns >= turns_between_marks {
                self.marks.push(mark);
                known = mark;
            }
            if mark.turns - first > most_turns {
                return (known, Some(NotApplicable::TooManyTurns));
            }
            if self.stepper.resolution.limit.is_reached(0) {
                return (known, Some(NotApplicable::WorkLimit));
            }
            self.gain = turn.gain;
            before = mark;
            mark = mark.after(&turn, 1.0);
        }
    }

    /// Adds the cell that begins at this energy, J, and returns the turn from there; an error where the cell would
    /// serve fewer turns than it costs.
    fn extend(&mut self, kinetic: f64) -> Result<Cycle, NotApplicable> {
        // Range of the width: the energies stay positive and differ by far more than rounding.
        let (narrowest, widest) = (1e-7, 0.5);
        // Tail at which the width of the next cell aims, as a fraction of the allowed one.
        let aim = 0.2;
        let tail = self.stepper.fine.tail;
        self.width = self.width.min(widest);
        loop {
            let (ahead, behind) = (self.width * kinetic, 0.01 * self.width * kinetic);
            let (low, high) = if self.gain > 0.0 {
                (kinetic - behind, kinetic + ahead)
            } else {
                (kinetic - ahead, kinetic + behind)
            };
            let tried = self.width;
            let why = match self.cell(0.5 * (low + high), 0.5 * (high - low)) {
                Ok(cell) => {
                    let share = aim * tail / cell.tail();
                    let factor = share.powf(1.0 / MAP_DEGREE as f64).clamp(0.5, 2.0);
                    self.width = (factor * tried).min(widest);
                    if cell.tail() <= tail {
                        let turn = cell.cycle(kinetic);
                        self.map.cells.push(cell);
                        return Ok(turn);
                    }
                    NotApplicable::NotSmooth
                }
                Err(why) => {
                    self.width = 0.5 * tried;
                    why
                }
            };
            let narrows = matches!(why, NotApplicable::TooSlow | NotApplicable::NotSmooth);
            let pays = self.width * kinetic > (MAP_DEGREE + 1) as f64 * self.gain.abs();
            if !narrows || !pays || tried <= narrowest {
                return Err(why);
            }
        }
    }

    /// Integrates the turn with the goal up to the goal, or single turns after an early end of the map. Returns the
    /// reason for an end before the goal.
    fn last_turns(
        &mut self,
        mark: &TurnStart,
        goal: Goal,
        map_ended: Option<NotApplicable>,
    ) -> Option<NotApplicable> {
        self.stepper.restart(mark.kinetic, true);
        let limited = map_ended
            .filter(|why| matches!(why, NotApplicable::WorkLimit | NotApplicable::TooManyTurns));
        let most = match limited {
            None if map_ended.is_some() => SINGLE_TURNS,
            _ => 1.0,
        };
        if limited.is_some() {
            self.stepper.resolution.limit = WorkLimit::NONE;
        }
        loop {
            match self.stepper.advance(&mut self.last, mark, goal) {
                Ok(false) => {}
                Ok(true) => return None,
                Err(why) => return Some(why),
            }
            if self.stepper.panels.at_cycle() && self.stepper.progress.turns.abs() >= most {
                return map_ended.map(|_| limited.unwrap_or(NotApplicable::TooLong));
            }
        }
    }
}
