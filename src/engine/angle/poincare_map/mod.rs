//! Long runs by the Poincaré map of the kinetic energy over one cycle, interpolated. A turn is a cycle here.

mod cells;

use std::f64::consts::TAU;

use super::super::energy::interpolated_turns::{Cycle, Interpolated, TurnStart};
use super::super::energy::piece::SAME_ANGLE;
use super::super::energy::segment::Segment;
use super::super::energy::turns::{Map, Recent, Turns};
use super::super::energy::{NotApplicable, Orbit};
use super::driving::{FEW_TURNS, work_until};
use super::progress::Done;
use super::stepper::PanelStepper;
use super::{Driven, Driving, Errors, Goal, Resolution, Short};
use crate::engine::WorkLimit;
use crate::numeric::angle::Angle;

/// Degree of the interpolation over the energy.
const DEGREE: usize = 16;
/// Largest width of a cell, relative to the energy at its start.
const WIDEST: f64 = 0.5;
/// Least width of a cell, relative to the energy at its start.
const NARROWEST: f64 = 1e-7;
/// Fraction of the allowed tail at which the width of the next cell aims.
const SAFETY: f64 = 0.2;
/// Most turns that are iterated; they take some seconds.
const MOST_TURNS: f64 = 1e8;

/// Continues from the start of a turn to the goal, or as far as the angle can be the independent variable.
pub(super) fn run<D: Driven>(
    stepper: PanelStepper<'_, D>,
    segment: Segment,
    start: Angle,
    speed: f64,
    goal: Goal,
    resolution: Resolution<'_>,
) -> Result<Driving, NotApplicable> {
    let mark = TurnStart {
        turns: stepper.progress.turns.abs(),
        t: stepper.progress.t,
        kinetic: stepper.progress.kinetic,
        work: stepper.progress.work,
        low: [0.0; 2],
    };
    let (errors, first) = (stepper.progress.errors, stepper.progress.t.0);
    let mut way = LastTurns {
        tail: resolution.tail,
        width: WIDEST,
        rises: stepper.progress.gain > 0.0,
        lost: (stepper.progress.gain / stepper.progress.turns).abs()
            * f64::from(stepper.driven.cycle()),
        stepper,
        map: Interpolated {
            cells: Vec::new(),
            steady: false,
        },
        marks: vec![mark],
        last: Segment::open(),
    };
    let (last, why) = way.turn_of(goal);
    let ended = way.last_turns(&last, goal, start, why)?;
    let evaluations = way.stepper.evaluations;
    let kinetic = way.stepper.progress.kinetic;
    let before = last.work + way.stepper.progress.work;
    let short = match &ended {
        MapEnd::AtGoal(_) => None,
        MapEnd::Short(why) => {
            let turns = start.turns + speed.signum() * last.turns;
            let angle = way.last.last_angle(turns);
            angle.map(|angle| Short {
                why: *why,
                angle,
                kinetic,
            })
        }
    };
    let turns = Turns {
        map: Map::Interpolated(way.map),
        marks: way.marks,
        last: way.last,
        recent: Recent::default(),
        error: 0.0,
    };
    let orbit = Orbit::of_turns(start, speed, segment, turns);
    let end = match goal {
        _ if short.is_some() => orbit.length(),
        Goal::Time(until) => until,
        Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(last.t.0),
    };
    let work = match ended {
        MapEnd::Short(_) => before,
        MapEnd::AtGoal(done) => {
            let after = end - last.t.0 - last.t.1;
            before - done.work + work_until(orbit.last_segment(), after, &done.spent)
        }
    };
    Ok(Driving {
        orbit,
        end,
        work,
        // Errors grow as in the first turns.
        errors: Errors {
            late: errors.late * end / first,
            early: errors.early * end / first,
            ..errors
        },
        evaluations,
        short,
    })
}

/// End of the last turns.
enum MapEnd {
    AtGoal(Box<Done>),
    Short(NotApplicable),
}

struct LastTurns<'a, D: Driven> {
    stepper: PanelStepper<'a, D>,
    map: Interpolated,
    marks: Vec<TurnStart>,
    /// Panels of the turn with the goal, or of single turns after an early end of the map.
    last: Segment,
    tail: f64,
    width: f64,
    /// True if the energy rises from turn to turn.
    rises: bool,
    /// Magnitude of the energy change in the last turn, J.
    lost: f64,
}

impl<D: Driven> LastTurns<'_, D> {
    /// Returns the start of the turn with the goal, or of a turn before the end of the map with the reason for the end.
    fn turn_of(&mut self, goal: Goal) -> (TurnStart, Option<NotApplicable>) {
        let mut mark = self.marks[0];
        let first = mark.turns;
        let mut known = mark;
        let mut before = mark;
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
                Goal::Time(until) => ((until - mark.t.0) - mark.t.1) / turn.duration,
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
            if mark.turns - known.turns >= FEW_TURNS {
                self.marks.push(mark);
                known = mark;
            }
            if mark.turns - first > MOST_TURNS {
                return (known, Some(NotApplicable::TooManyTurns));
            }
            if self.stepper.limit.is_reached(0) {
                return (known, Some(NotApplicable::WorkLimit));
            }
            self.rises = turn.gain > 0.0;
            self.lost = turn.gain.abs();
            before = mark;
            mark = mark.after(&turn, 1.0);
        }
    }

    /// Adds the cell that begins at this energy, J, and returns the turn from there; an error where the cell would
    /// serve fewer turns than it costs.
    fn extend(&mut self, kinetic: f64) -> Result<Cycle, NotApplicable> {
        loop {
            let (ahead, behind) = (self.width * kinetic, 0.01 * self.width * kinetic);
            let (low, high) = if self.rises {
                (kinetic - behind, kinetic + ahead)
            } else {
                (kinetic - ahead, kinetic + behind)
            };
            let tried = self.width;
            let why = match self.cell(0.5 * (low + high), 0.5 * (high - low)) {
                Ok(cell) => {
                    let share = SAFETY * self.tail / cell.tail();
                    let factor = share.powf(1.0 / DEGREE as f64).clamp(0.5, 2.0);
                    self.width = (factor * tried).min(WIDEST);
                    if cell.tail() <= self.tail {
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
            let pays = self.width * kinetic > (DEGREE + 1) as f64 * self.lost;
            if !narrows || !pays || tried <= NARROWEST {
                return Err(why);
            }
        }
    }

    /// Integrates the turn with the goal up to the goal, or single turns after an early end of the map.
    fn last_turns(
        &mut self,
        mark: &TurnStart,
        goal: Goal,
        start: Angle,
        map_ended: Option<NotApplicable>,
    ) -> Result<MapEnd, NotApplicable> {
        self.stepper.restart(mark.kinetic);
        self.stepper.gives_up = true;
        let most = match map_ended {
            None | Some(NotApplicable::WorkLimit | NotApplicable::TooManyTurns) => 1.0,
            Some(_) => FEW_TURNS,
        };
        let limited = map_ended
            .filter(|why| matches!(why, NotApplicable::WorkLimit | NotApplicable::TooManyTurns));
        if limited.is_some() {
            self.stepper.limit = WorkLimit::NONE;
        }
        loop {
            let done = match self.stepper.panel() {
                Ok(done) => done,
                Err(why) if self.last.len() == 0 => return Err(why),
                Err(why) => return Ok(MapEnd::Short(why)),
            };
            let piece = &done.panel.piece;
            let turned = (piece.to - start.rest).abs() + done.panel.turns.abs() * TAU;
            self.last.push(done.panel.clone());
            let passed = match goal {
                Goal::Time(until) => self.stepper.progress.t.0 > (until - mark.t.0) - mark.t.1,
                Goal::Turned(way) => turned + mark.turns * TAU >= way - SAME_ANGLE,
            };
            let all = self.stepper.at_cycle() && self.stepper.progress.turns.abs() >= most;
            match map_ended {
                _ if passed => return Ok(MapEnd::AtGoal(done.into())),
                None if all => return Ok(MapEnd::AtGoal(done.into())),
                Some(_) if all => {
                    return Ok(MapEnd::Short(limited.unwrap_or(NotApplicable::TooLong)));
                }
                _ => {}
            }
        }
    }
}
