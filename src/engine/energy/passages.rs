//! What a motion passes: ends of panels, among them the corners, and turning points.

use std::f64::consts::TAU;

use super::Orbit;
use super::leg::{After, Leg};
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

impl Orbit {
    /// Calls for the ends of panels in the turns after the first ones, in order, until it says that it is
    /// enough.
    pub fn later_passages(&self, mut visit: impl FnMut(Passage) -> bool) {
        let Some(later) = &self.later else {
            return;
        };
        later.each_turn(|mark, leg| {
            leg.ends().all(|(after, angle, speed)| {
                let turns = self.direction * mark.turns + angle.turns;
                visit(Passage {
                    t: mark.t.0 + (mark.t.1 + after),
                    angle: Angle {
                        turns: self.start.turns + turns,
                        rest: angle.rest,
                    },
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
            .passages()
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

    /// Passages of the ends of panels and turning points in the first period (or in all, if it does not
    /// repeat), in the order of time.
    pub fn passages(&self) -> Vec<Passage> {
        let mut found = Vec::new();
        let mut pass = |t: f64, angle: Angle, speed: f64, turning: bool| {
            let speed = if turning { 0.0 } else { speed };
            found.push(Passage {
                t,
                angle: Angle {
                    turns: self.start.turns + angle.turns,
                    rest: angle.rest,
                },
                speed,
                turning,
            });
        };
        let there = self.forward.duration.0;
        let run = |leg: &Leg, since: f64, pass: &mut dyn FnMut(f64, Angle, f64, bool)| {
            let turns_back = leg.after == After::TurnsBack;
            let last = leg.len().saturating_sub(1);
            for (i, (t, angle, speed)) in leg.ends().enumerate() {
                pass(since + t, angle, speed, turns_back && i == last);
            }
            if turns_back {
                for (t, angle, speed) in leg.ends().rev().skip(1) {
                    pass(since + 2.0 * leg.duration.0 - t, angle, -speed, false);
                }
            }
        };
        run(&self.forward, 0.0, &mut pass);
        if self.forward.after == After::TurnsBack {
            // The start is passed on the way back, and again at the end of the period.
            let start = Angle::from(self.start.rest);
            pass(2.0 * there, start, -self.speed, self.from_rest);
            if let Some(back) = &self.backward {
                run(back, 2.0 * there, &mut pass);
                if back.after == After::TurnsBack {
                    pass(2.0 * (there + back.duration.0), start, self.speed, false);
                }
            }
        }
        found
    }
}
