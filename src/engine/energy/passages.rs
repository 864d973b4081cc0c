//! What a motion passes: marked angles and turning points.

use std::f64::consts::TAU;

use super::Orbit;
use super::panel::Panel;
use super::piece::{Piece, SAME_ANGLE};
use super::segment::{After, Segment};
use crate::numeric::angle::Angle;

/// A state on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// s
    pub t: f64,
    /// Crank angle.
    pub angle: Angle,
    /// rad/s
    pub speed: f64,
    /// Whether the motion turns back here.
    pub turning: bool,
}

/// Rounding of angles far from zero, in parts of themselves.
const ROUNDED: f64 = 8.0 * f64::EPSILON;

impl Piece {
    /// How far (rad) ahead of its start, in its direction, an angle is: in [0, 2π).
    fn ahead(&self, theta: f64) -> f64 {
        (self.span().signum() * (theta - self.from)).rem_euclid(TAU)
    }

    fn near(&self) -> f64 {
        SAME_ANGLE.max(ROUNDED * self.from.abs().max(self.to.abs()))
    }

    /// The next of some marked angles beyond a part of the piece, and how far it is ahead of the start, rad; its start
    /// is not beyond.
    fn next_mark(&self, marks: &[f64], beyond: f64) -> Option<(f64, f64)> {
        let (near, span) = (self.near(), self.span().abs());
        let ahead = marks.iter().map(|mark| (self.ahead(*mark), *mark));
        let inside = ahead.filter(|(ahead, _)| *ahead > beyond.max(near) && *ahead <= span + near);
        inside.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

impl Panel {
    /// Calls for each marked angle that it passes, its start aside, with the time after its start and the speed.
    fn each_mark(&self, marks: &[f64], mut visit: impl FnMut(f64, Angle, f64) -> bool) -> bool {
        let mut beyond = 0.0;
        while let Some((ahead, mark)) = self.piece.next_mark(marks, beyond) {
            beyond = ahead;
            let at = self.piece.from + ahead.copysign(self.piece.span());
            let turns = ((at - mark) / TAU).round();
            let angle = Angle::new(self.turns + turns, mark);
            let at_end = ahead >= self.piece.span().abs() - self.piece.near();
            let (after, speed) = if at_end {
                (self.duration.0, self.speed(1.0))
            } else {
                self.at(at)
            };
            if !visit(after, angle, speed) {
                return false;
            }
        }
        true
    }
}

impl Segment {
    /// Calls for each of some marked angles (rad, in [0, 2π)) that it passes, in order, with the time after its start
    /// and the speed, until it says that it is enough. Neither its start nor a turning point at its end is passed.
    pub fn each_mark(&self, marks: &[f64], mut visit: impl FnMut(f64, Angle, f64) -> bool) -> bool {
        let turning = self.turning_point();
        self.each_panel(|panel, begin| {
            panel.each_mark(marks, |after, angle, speed| {
                let turns_back =
                    turning.is_some_and(|(end, _)| angle.minus(end).abs() <= SAME_ANGLE);
                turns_back || visit(begin + after, angle, speed)
            })
        })
    }
}

impl Orbit {
    /// Calls for the marked angles (rad, in [0, 2π)) that are passed in the turns after the first ones, in order,
    /// until it says that it is enough.
    pub fn later_passages(&self, marks: &[f64], mut visit: impl FnMut(Passage) -> bool) {
        let Some(later) = &self.later else {
            return;
        };
        later.each_turn(|mark, leg| {
            leg.each_mark(marks, |after, angle, speed| {
                let turns = self.direction * mark.turns + angle.turns;
                visit(Passage {
                    t: mark.t.0 + (mark.t.1 + after),
                    angle: Angle::new(self.start.turns + turns, angle.rest),
                    speed,
                    turning: false,
                })
            })
        });
    }

    /// How far (rad) the crank has turned in the first turns, if others follow that are not among
    /// [`Self::passages`].
    pub fn later_from(&self) -> Option<f64> {
        Some(self.later.as_ref()?.first() * TAU)
    }

    /// When it turns back, until a time.
    pub fn turning_times(&self, until: f64) -> Vec<f64> {
        let turnings = self
            .passages(&[])
            .into_iter()
            .filter(|passage| passage.turning);
        let once: Vec<f64> = turnings.map(|passage| passage.t).collect();
        let Some((period, _)) = self.period().filter(|_| !once.is_empty()) else {
            return once.into_iter().filter(|t| *t <= until).collect();
        };
        let rounds = (until / period).ceil() as u64;
        (0..=rounds)
            .flat_map(|round| once.iter().map(move |t| t + round as f64 * period))
            .filter(|t| *t <= until)
            .collect()
    }

    /// Passages of marked angles (rad, in [0, 2π)) and turning points in the first period (or in all, if it does not
    /// repeat), in the order of time.
    pub fn passages(&self, marks: &[f64]) -> Vec<Passage> {
        let mut found = Vec::new();
        self.run_through(&self.forward, 0.0, marks, &mut found);
        if self.forward.after == After::TurnsBack {
            // The start is passed on the way back, and again at the end of the period.
            let start = Angle::from(self.start.rest);
            let apart = |mark: &f64| (start.rest - mark).rem_euclid(TAU);
            let marked = marks
                .iter()
                .map(apart)
                .any(|apart| apart.min(TAU - apart) < SAME_ANGLE);
            let passed = |t: f64, speed: f64| self.passage(t, start, speed, self.from_rest);
            let there = 2.0 * self.forward.duration.0;
            if marked || self.from_rest {
                found.push(passed(there, -self.speed));
            }
            if let Some(back) = &self.backward {
                self.run_through(back, there, marks, &mut found);
                if marked && back.after == After::TurnsBack {
                    found.push(passed(there + 2.0 * back.duration.0, self.speed));
                }
            }
        }
        found
    }

    /// Adds what a leg that begins at a time (s) passes, there and back if it turns back.
    fn run_through(&self, leg: &Segment, since: f64, marks: &[f64], found: &mut Vec<Passage>) {
        let first = found.len();
        leg.each_mark(marks, |after, angle, speed| {
            found.push(self.passage(since + after, angle, speed, false));
            true
        });
        if let Some((end, duration)) = leg.turning_point() {
            let there = first..found.len();
            found.push(self.passage(since + duration, end, 0.0, true));
            for i in there.rev() {
                let Passage { t, speed, .. } = found[i];
                let t = since + 2.0 * duration - (t - since);
                found.push(Passage {
                    t,
                    speed: -speed,
                    ..found[i]
                });
            }
        }
    }

    fn passage(&self, t: f64, angle: Angle, speed: f64, turning: bool) -> Passage {
        Passage {
            t,
            angle: Angle::new(self.start.turns + angle.turns, angle.rest),
            speed: if turning { 0.0 } else { speed },
            turning,
        }
    }
}
