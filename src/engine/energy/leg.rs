//! A leg: panels in one direction, from the start until the motion turns back, repeats or ends.

use std::f64::consts::TAU;

use super::extreme::extreme;
use super::home::Return;
use super::panel::{Panel, Tried};
use super::piece::{LONGEST, Piece, Turning, missing, next_end};
use super::{Profile, Unserved};
use crate::numeric::angle::Angle;
use crate::numeric::exact::two_sum;

/// How a leg goes on after its panels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum After {
    /// The same turn again.
    Repeats,
    /// Another turn, under the same forces.
    GoesOn,
    /// It turns back.
    TurnsBack,
    /// Not needed: the run ends before.
    Ends,
}

/// Where a leg begins.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Begin {
    /// rad
    pub start: f64,
    /// +1 or −1
    pub direction: f64,
    /// J; without it the start is a turning point.
    pub kinetic: f64,
    /// How far it may be off beside its own rounding, J.
    pub off: f64,
}

/// Panels one after the other.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Leg {
    panels: Vec<Panel>,
    /// Time at which each panel begins.
    begins: Vec<f64>,
    /// Its whole duration, rounded value and rest.
    pub duration: (f64, f64),
    pub after: After,
    /// Bound of the error of its duration, s.
    pub error: f64,
    /// What the series of a panel leave out at most of the time inside it, s.
    pub left_out: f64,
    /// What the series of its panels leave out at most, relative to their values.
    pub tail: f64,
}

/// Most panels that are tried for a leg.
const MOST_ATTEMPTS: usize = 200_000;
/// Panels no longer than this are taken as they are, rad: a corner that nobody announced.
const SHORTEST: f64 = 1e-13;
/// Below this part of the largest kinetic energy its sum over the panels has lost digits.
const NEAR_REST: f64 = 1e-3;
impl Leg {
    /// A leg without panels, that ends where the last one will.
    pub fn open() -> Leg {
        Leg {
            panels: Vec::with_capacity(64),
            begins: Vec::with_capacity(64),
            duration: (0.0, 0.0),
            after: After::Ends,
            error: 0.0,
            left_out: 0.0,
            tail: 0.0,
        }
    }

    /// Panels until the time `until` is passed or `most_turns` are complete, if the forces are the same in each;
    /// their series end where they have decayed to `tolerance`.
    pub fn build(
        profile: &dyn Profile,
        begin: Begin,
        until: f64,
        tolerance: f64,
        most_turns: f64,
    ) -> Result<Leg, Unserved> {
        let Begin {
            start,
            direction,
            mut kinetic,
            off,
        } = begin;
        let mut leg = Leg::open();
        let whole_turn = start + direction * TAU;
        let gain = profile.work_of_turn().map(|(work, _)| direction * work);
        let at_first = kinetic;
        let mut turns = 0.0;
        let home = Return::new(profile, whole_turn, kinetic);
        let mut at = start;
        let mut length = LONGEST;
        let mut turns_at: Option<f64> = None;
        let mut attempts = 0;
        let mut largest = kinetic;
        while leg.panels.is_empty() || leg.duration.0 <= until {
            attempts += 1;
            if attempts > MOST_ATTEMPTS {
                return Err(Unserved::TooLong);
            }
            let mut to = next_end(profile.corners(), at, direction, length);
            if gain.is_some() && direction * (to - whole_turn) > -1e-12 {
                to = whole_turn;
            }
            let mut turning = if kinetic == 0.0 {
                Turning::AtStart
            } else {
                Turning::Nowhere
            };
            if let Some(end) = turns_at.filter(|end| direction * (to - end) >= 0.0) {
                // A panel cannot turn at both ends: the first half ends in the middle.
                to = if turning == Turning::AtStart {
                    0.5 * (at + end)
                } else {
                    end
                };
                if turning == Turning::Nowhere {
                    turning = Turning::AtEnd;
                }
            }
            let mut rounding = off + f64::EPSILON * largest;
            if let Some(again) = &home
                && kinetic < NEAR_REST * largest
                && let Some(exact) = again.kinetic(at)
            {
                kinetic = exact;
                rounding = f64::EPSILON * kinetic * (1.0 + at.abs() / (whole_turn - at).abs());
            }
            let short = (to - at).abs() <= SHORTEST * at.abs().max(1.0);
            let accepted = if short { f64::INFINITY } else { tolerance };
            let piece = Piece {
                from: at,
                to,
                turning,
            };
            match Panel::attempt(profile, piece, kinetic, accepted, rounding)? {
                Tried::Done(mut panel) => {
                    at = to;
                    panel.turns = direction * turns;
                    kinetic = panel.kinetic_at_end;
                    largest = largest.max(kinetic);
                    length = 2.0 * piece.span().abs();
                    leg.push(*panel);
                    if turning == Turning::AtEnd {
                        leg.after = After::TurnsBack;
                        return Ok(leg);
                    }
                    if let Some(gain) = gain.filter(|_| at == whole_turn) {
                        leg.complete(missing(start, direction));
                        if profile.repeats() {
                            leg.after = After::Repeats;
                            return Ok(leg);
                        }
                        turns += 1.0;
                        if turns >= most_turns && leg.duration.0 <= until {
                            leg.after = After::GoesOn;
                            return Ok(leg);
                        }
                        at = start;
                        kinetic = gain.mul_add(turns, at_first);
                    }
                }
                Tried::TurnsAt(end) if end != at => {
                    let exact = home.as_ref().and_then(|again| again.turning_point(at, end));
                    turns_at = Some(exact.unwrap_or(end));
                }
                _ if short => return Err(Unserved::NotFinite),
                _ => length = 0.5 * (to - at).abs(),
            }
        }
        Ok(leg)
    }

    /// Adds the time of the last bit of a turn, rad.
    fn complete(&mut self, missing: f64) {
        let Some(panel) = self.panels.last() else {
            return;
        };
        let late = missing / panel.speed(1.0).abs();
        if late.is_finite() {
            self.duration = two_sum(self.duration.0, self.duration.1 + late);
        }
    }

    /// The pieces of its panels.
    pub fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        self.panels.iter().map(|panel| panel.piece)
    }

    /// Legs with the same panels, blended by shares whose sum is one.
    pub fn blend(legs: &[Leg], shares: &[f64]) -> Leg {
        let mut leg = Leg::open();
        for index in 0..legs.first().map_or(0, Leg::len) {
            let parts = legs.iter().zip(shares);
            let panel = Panel::blend(parts.map(|(leg, share)| (&leg.panels[index], *share)));
            if let Some(panel) = panel {
                leg.push(panel);
            }
        }
        leg
    }

    pub fn push(&mut self, panel: Panel) {
        self.begins.push(self.duration.0);
        let (sum, lost) = two_sum(self.duration.0, panel.duration.0);
        self.duration = two_sum(sum, lost + self.duration.1 + panel.duration.1);
        self.error += panel.error;
        self.left_out = self.left_out.max(panel.left_out());
        self.tail = self.tail.max(panel.tail);
        self.panels.push(panel);
    }

    /// Angle (turns of the panel, rest) and speed a time after the start of the leg.
    pub fn state(&self, after: f64) -> (Angle, f64) {
        let index = self.begins.partition_point(|begin| *begin <= after).max(1) - 1;
        let panel = &self.panels[index];
        let (rest, speed) = panel.state(after - self.begins[index]);
        let turns = panel.turns;
        (Angle { turns, rest }, speed)
    }

    /// Times at which the ends of panels are reached, with their angles and speeds.
    pub fn ends(&self) -> impl DoubleEndedIterator<Item = (f64, Angle, f64)> + '_ {
        let pairs = self.panels.iter().zip(&self.begins);
        pairs.map(|(panel, begin)| {
            let angle = Angle {
                turns: panel.turns,
                rest: panel.piece.to,
            };
            (begin + panel.duration.0, angle, panel.speed(1.0))
        })
    }

    /// The angle at its end, for a start with these whole turns; none without panels.
    pub fn last_angle(&self, turns: f64) -> Option<Angle> {
        let panel = self.panels.last()?;
        Some(Angle {
            turns: turns + panel.turns,
            rest: panel.piece.to,
        })
    }

    /// Time at which an angle is reached; none if it is not on the leg.
    pub fn time_of(&self, angle: Angle) -> Option<f64> {
        let local = |panel: &Panel| Angle {
            turns: angle.turns - panel.turns,
            rest: angle.rest,
        };
        let mut inside = self.panels.iter().zip(&self.begins).filter(|(panel, _)| {
            let piece = &panel.piece;
            let theta = local(panel).radians();
            (piece.from.min(piece.to)..=piece.from.max(piece.to)).contains(&theta)
        });
        let (panel, begin) = inside.next()?;
        Some(begin + panel.time_of(local(panel).radians()))
    }

    /// Smallest and largest |speed| between two times.
    pub fn speed_range(&self, from: f64, until: f64) -> (f64, f64) {
        let mut whole = Vec::with_capacity(self.panels.len());
        let mut parts = Vec::new();
        for (panel, begin) in self.panels.iter().zip(&self.begins) {
            let end = begin + panel.duration.0;
            if from <= *begin && end <= until {
                whole.push(panel);
            } else if from < end && *begin <= until {
                parts.push((panel, (from - begin).max(0.0), until.min(end) - begin));
            }
        }
        let largest = |sign: f64| {
            let of_parts = parts
                .iter()
                .map(|(panel, from, until)| panel.extreme_between(*from, *until, sign));
            of_parts.fold(extreme(&whole, sign), f64::max)
        };
        (-largest(-1.0), largest(1.0))
    }

    /// The panel in which a time lies, and the time since its begin.
    pub fn panel_at(&self, after: f64) -> Option<(&Panel, f64)> {
        let index = self.begins.partition_point(|begin| *begin <= after).max(1) - 1;
        Some((self.panels.get(index)?, after - self.begins[index]))
    }

    /// Largest kinetic energy at the ends of panels, J.
    pub fn largest_kinetic(&self) -> f64 {
        let ends = self.panels.iter().map(|panel| panel.kinetic_at_end);
        ends.fold(0.0, f64::max)
    }

    /// Number of panels.
    pub fn len(&self) -> usize {
        self.panels.len()
    }
}
