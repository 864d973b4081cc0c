//! Whole motion: one or two segments, traversed once, repeatedly, or to and fro.

use std::f64::consts::TAU;

use super::equal_gains::EqualGains;
use super::kinetic::at_start;
use super::piece::KineticState;
use super::profile::{NotApplicable, Profile};
use super::segment::{After, Segment};
use super::turns::Turns;
use crate::numeric::angle::Angle;
use crate::numeric::exact::two_sum;

/// Motion known from its energy: angle and speed as functions of time.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// Initial angle.
    pub start: Angle,
    /// Sign of the initial speed: +1 or −1.
    pub direction: f64,
    /// Speed at the start, rad/s.
    pub(super) speed: f64,
    /// True if the start is a turning point.
    pub(super) from_rest: bool,
    /// Error bound of the kinetic energy at the start, J.
    pub(super) energy_error: f64,
    pub(super) forward: Segment,
    /// Segment from the start in the other direction, for motions that turn back.
    pub(super) backward: Option<Segment>,
    /// Turns after the first ones, for long motions with unequal turns.
    pub(super) later: Option<Box<Turns>>,
}

impl Orbit {
    /// Computes the motion from `angle` with `speed` (rad/s) to the time `until` (s); the tails of its series are below
    /// `tolerance`.
    ///
    /// # Errors
    /// [`NotApplicable`] where the motion cannot be computed from its energy.
    pub fn new(
        profile: &dyn Profile,
        angle: Angle,
        speed: f64,
        until: f64,
        tolerance: f64,
    ) -> Result<Orbit, NotApplicable> {
        let start = angle.reduced();
        let theta = start.rest;
        let (inertia, force) = profile.inertia_and_force(theta);
        let kinetic = at_start(theta, 0.5 * inertia * speed * speed, force)?;
        let direction = if kinetic == 0.0 {
            force.signum()
        } else {
            speed.signum()
        };
        // The kinetic energy is a product of rounded factors; an angle in the first turn is exact.
        let of_inertia = profile.inertia_rounding(theta, start.turns != 0.0);
        let energy_error = f64::EPSILON.hypot(of_inertia) * kinetic;
        let begin = KineticState {
            angle: theta,
            direction,
            kinetic,
            energy_error,
        };
        let segment = |direction: f64, until: f64, most_turns: f64| {
            let begin = KineticState { direction, ..begin };
            Segment::build(profile, begin, until, tolerance, most_turns)
        };
        let gains = profile.work_of_turn().map(|(work, gain_error)| EqualGains {
            profile,
            begin,
            gain: direction * work,
            gain_error,
            tolerance,
        });
        // The sum over turns takes the time of about four turns, and does not go on to rest. The choice changes the cost,
        // not the result beyond its stated error.
        let rests = |gains: &EqualGains| gains.time_to_rest(kinetic, TAU / speed.abs()) < until;
        let most_turns = match gains.as_ref().is_some_and(rests) {
            true => f64::INFINITY,
            false => 4.0,
        };
        let mut forward = segment(direction, until, most_turns)?;
        let mut later = None;
        if let (After::GoesOn, Some(gains)) = (forward.after, gains) {
            later = gains.turns(forward.turns(), forward.duration, until)?;
            if later.is_none() && !profile.is_spent() {
                forward = segment(direction, until, f64::INFINITY)?;
            }
        }
        let there = forward.duration.0;
        let turns_back = forward.after == After::TurnsBack;
        let backward = if turns_back && kinetic != 0.0 && 2.0 * there < until {
            let left = until - 2.0 * there;
            Some(segment(-direction, left, f64::INFINITY)?)
        } else {
            None
        };
        Ok(Orbit {
            start,
            direction,
            speed,
            from_rest: kinetic == 0.0,
            energy_error,
            forward,
            backward,
            later: later.map(Box::new),
        })
    }

    /// Makes a motion in one direction that does not repeat, of many turns if there are later ones.
    pub(in crate::engine) fn one_way(
        start: Angle,
        speed: f64,
        segment: Segment,
        later: Option<Turns>,
    ) -> Orbit {
        Orbit {
            start,
            direction: speed.signum(),
            speed,
            from_rest: false,
            energy_error: 0.0,
            forward: segment,
            backward: None,
            later: later.map(Box::new),
        }
    }

    /// Returns the period of the motion (a turn, or to and fro), s: rounded value and remainder.
    pub fn period(&self) -> Option<(f64, f64)> {
        let there = self.forward.duration;
        match (self.forward.after, &self.backward) {
            (After::Repeats, _) => Some(there),
            (After::TurnsBack, None) if self.from_rest => Some(twice(there)),
            (After::TurnsBack, Some(back)) if back.after == After::TurnsBack => {
                let (a, b) = (twice(there), twice(back.duration));
                let (sum, lost) = two_sum(a.0, b.0);
                Some((sum, lost + a.1 + b.1))
            }
            _ => None,
        }
    }

    /// True if the crank rotates fully and the motion repeats.
    pub fn rotates(&self) -> bool {
        self.forward.after == After::Repeats
    }

    /// True if the motion has a turning point ahead of the start.
    pub fn turns_back(&self) -> bool {
        self.forward.after == After::TurnsBack
    }

    /// Returns angle and speed (rad/s) at a time (s) of the run.
    pub fn state(&self, t: f64) -> (Angle, f64) {
        if t == 0.0 {
            return (self.start, self.speed);
        }
        if let Some(later) = self.later.as_ref().filter(|_| t > self.forward.duration.0) {
            let (angle, speed) = later.state(t, self.direction);
            let turns = self.start.turns + angle.turns;
            return (Angle { turns, ..angle }, speed);
        }
        let (turns, after) = self.split(t);
        let (segment, at, sense) = self.located(after);
        let (angle, speed) = segment.state(at);
        let turns = if self.rotates() {
            self.direction * turns
        } else {
            0.0
        };
        let angle = Angle::new(self.start.turns + turns + angle.turns, angle.rest);
        (angle, sense * speed)
    }

    /// Returns the number of whole periods before t, and the remaining time, s.
    pub(super) fn split(&self, t: f64) -> (f64, f64) {
        match self.period() {
            Some((period, rest)) if t > period => {
                let count = (t / period).floor();
                let left = (-count).mul_add(period, t) - count * rest;
                // Rounding may make the floor a period too large or too small.
                if left < 0.0 {
                    (count - 1.0, left + period)
                } else if left > period {
                    (count + 1.0, left - period)
                } else {
                    (count, left)
                }
            }
            _ => (0.0, t),
        }
    }

    /// Returns the segment on which the motion is at a time (s) of the first period, the time since its start (s), and
    /// the sense in which it is traversed, +1 or −1.
    pub(super) fn located(&self, t: f64) -> (&Segment, f64, f64) {
        let there_and_back = 2.0 * self.forward.duration.0;
        if !self.turns_back() {
            return (&self.forward, t, 1.0);
        }
        let (segment, since) = if t <= there_and_back {
            (&self.forward, t)
        } else {
            let back = self.backward.as_ref().unwrap_or(&self.forward);
            (back, t - there_and_back)
        };
        let end = segment.duration.0;
        if since <= end {
            (segment, since, 1.0)
        } else {
            (segment, 2.0 * end - since, -1.0)
        }
    }

    /// Returns the time at which the crank has turned by `radians` from the start, s.
    pub fn time_of_turn(&self, radians: f64) -> Option<f64> {
        self.passage(radians).map(|(t, _)| t)
    }

    /// Returns the time (s) at which the crank has turned by `radians` from the start, and its speed there (rad/s).
    pub fn passage(&self, radians: f64) -> Option<(f64, f64)> {
        let whole = (radians / TAU).floor();
        let angle = |turns: f64| {
            Angle::new(
                self.direction * turns,
                self.start.rest + self.direction * (radians - whole * TAU),
            )
        };
        if self.rotates() {
            let (after, speed) = self.forward.at(angle(0.0))?;
            let (period, low) = self.forward.duration;
            let t = whole.mul_add(period, after) + whole * low;
            return Some((t.max(0.0), speed));
        }
        let first = self.forward.at(angle(whole));
        let first = first.map(|(t, speed)| (t.max(0.0), speed));
        first.or_else(|| {
            let later = self.later.as_ref()?;
            later.passage(radians, self.start.rest, self.direction)
        })
    }

    /// Returns the last segment.
    pub(in crate::engine) fn last_segment(&self) -> &Segment {
        self.later
            .as_ref()
            .map_or(&self.forward, |later| &later.last)
    }

    /// Returns the time up to which the motion is known, s; infinite if it repeats.
    pub fn length(&self) -> f64 {
        let there = self.forward.duration.0;
        match (self.period(), &self.backward, &self.later) {
            (Some(_), _, _) => f64::INFINITY,
            (None, _, Some(later)) => later.end(),
            (None, Some(back), None) => 2.0 * there + back.duration.0,
            (None, None, None) if self.turns_back() => 2.0 * there,
            (None, None, None) => there,
        }
    }

    /// Returns the largest kinetic energy at the ends of panels up to a time (s), J.
    pub fn largest_kinetic(&self, until: f64) -> f64 {
        let back = self.backward.as_ref().map_or(0.0, Segment::largest_kinetic);
        let later = self.later.as_ref();
        let later = later.map_or(0.0, |later| later.largest_kinetic(until));
        self.forward.largest_kinetic().max(back).max(later)
    }

    /// Returns the number of panels.
    pub fn panels(&self) -> usize {
        let back = self.backward.as_ref();
        self.forward.panels.len() + back.map_or(0, |back| back.panels.len())
    }
}

fn twice((value, rest): (f64, f64)) -> (f64, f64) {
    (2.0 * value, 2.0 * rest)
}
