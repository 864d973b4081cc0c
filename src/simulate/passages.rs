//! Events and rows of a motion that is known as a whole.

use std::f64::consts::TAU;

use super::result::Event;
use super::row::Row;
use super::row_writer::Part;
use super::run_setup::RunSetup;
use crate::engine::energy::Orbit;
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// A motion over the crank angle, or a piece of one, in the time of the whole run.
pub(super) struct Stretch<'a> {
    /// Motion over the angle, whose own time begins at 0.
    pub orbit: &'a Orbit,
    /// When it begins, s.
    pub begin: f64,
    /// Last time of its own, s.
    pub end: f64,
    pub task: &'a RunSetup<'a>,
}

/// What is as near to a dead centre as this is at it, rad; far from zero angles are rounded more than that.
const NEAR: f64 = 1e-12;

impl Stretch<'_> {
    /// What of a way (rad) is rounding.
    fn near(way: f64) -> f64 {
        NEAR.max(8.0 * f64::EPSILON * way)
    }

    /// How far (rad) each dead centre is ahead of an angle in a direction: in (0, 2π], for the angle itself is not passed.
    fn ahead(&self, of: Angle, direction: f64) -> Vec<(f64, f64)> {
        let dead_centres = self.task.limits.dead_centres.iter();
        let mut all: Vec<(f64, f64)> = dead_centres
            .map(|dead_centre| {
                let ahead = (direction * (dead_centre.theta - of.rest)).rem_euclid(TAU);
                let here = ahead <= Stretch::near(of.rest.abs());
                (if here { TAU } else { ahead }, dead_centre.theta)
            })
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// The passage of a dead centre (rad) at a time of the motion (s), so far (rad) from an angle.
    fn passage(&self, t: f64, from: Angle, way: f64, dead_centre: f64) -> Event {
        let turns = ((from.rest + way - dead_centre) / TAU).round();
        let at = Angle::new(from.turns + turns, dead_centre);
        Event {
            kind: "dead-centre",
            t_s: t,
            theta_rad: at.radians(),
            omega_rad_per_s: self.orbit.state(t).1,
        }
    }

    /// Dead centres of a motion that does not turn back, in its own time: each is passed once in a turn.
    fn one_way(&self, kept: usize) -> (Vec<Event>, u64) {
        let (orbit, start) = (self.orbit, self.orbit.start());
        let direction = orbit.direction();
        let all = orbit.state(self.end).0.minus(start).abs() + Stretch::near(start.rest.abs());
        let way = all * (1.0 + 4.0 * f64::EPSILON);
        let first = self.ahead(start, direction);
        let count = |(ahead, _): &(f64, f64)| ((way - ahead) / TAU + 1.0).floor().max(0.0) as u64;
        let total = first.iter().map(count).sum();
        let turns = (0u32..).flat_map(|turn| {
            let before = f64::from(turn) * TAU;
            first.iter().map(move |(ahead, dc)| (before + ahead, *dc))
        });
        let events =
            turns
                .take_while(|(ahead, _)| *ahead <= way)
                .take(kept)
                .map(|(ahead, dead_centre)| {
                    let t = orbit.time_of_turn(ahead).unwrap_or(self.end);
                    self.passage(t.min(self.end), start, direction * ahead, dead_centre)
                });
        (events.collect(), total)
    }

    /// Dead centres and turning points of a motion to and fro until a time (s), in its own time.
    fn to_and_fro(&self, until: f64) -> Vec<Event> {
        let orbit = self.orbit;
        let turnings = orbit.turning_times(until);
        let mut cuts = turnings.clone();
        cuts.push(until);
        let (mut events, mut from) = (Vec::new(), 0.0);
        for (i, to) in cuts.into_iter().enumerate() {
            let turns_back = i < turnings.len();
            let [begin, end] = [from, to].map(|t| orbit.state(t).0);
            let (direction, span) = (end.minus(begin).signum(), end.minus(begin).abs());
            let near = Stretch::near(span);
            let last = if turns_back { span - near } else { span + near };
            for (ahead, dead_centre) in self.ahead(begin, direction) {
                let mut ahead = ahead;
                while ahead <= last {
                    let beyond = |t: f64| orbit.state(t).0.minus(begin).abs() - ahead;
                    let t = root::bracketed(beyond, from, to).unwrap_or(to);
                    events.push(self.passage(t, begin, direction * ahead, dead_centre));
                    ahead += TAU;
                }
            }
            if turns_back {
                events.push(Event {
                    kind: "turning-point",
                    t_s: to,
                    theta_rad: end.radians(),
                    omega_rad_per_s: 0.0,
                });
            }
            from = to;
        }
        events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        events
    }

    /// Dead centres and turning points in the order of time: the first ones, at most `kept`, and how many there are.
    pub fn events(&self, kept: usize) -> (Vec<Event>, u64) {
        let (mut events, total) = match (self.orbit.turns_back(), self.orbit.period()) {
            (false, _) => self.one_way(kept),
            (true, Some((period, _))) if period < self.end => {
                let once = self.to_and_fro(period);
                let again = |event: &Event| ((self.end - event.t_s) / period + 1.0 + 1e-9).floor();
                let total = once.iter().map(again).sum::<f64>();
                let rounds = (0u32..).flat_map(|round| {
                    let before = f64::from(round) * period;
                    once.iter().map(move |event| Event {
                        t_s: before + event.t_s,
                        ..*event
                    })
                });
                let kept = if once.is_empty() { 0 } else { kept };
                let over = self.end * (1.0 + 1e-14);
                let first = rounds.take_while(|event| event.t_s <= over).take(kept);
                (first.collect(), total as u64)
            }
            (true, _) => {
                let mut events = self.to_and_fro(self.end);
                let total = events.len() as u64;
                events.truncate(kept);
                (events, total)
            }
        };
        for event in &mut events {
            event.t_s += self.begin;
        }
        (events, total)
    }
}

impl Part for Stretch<'_> {
    fn times(&self) -> [f64; 2] {
        [self.begin, self.begin + self.end]
    }

    fn turned(&mut self, t: f64) -> f64 {
        let own = (t - self.begin).min(self.end);
        self.orbit.state(own).0.minus(self.task.start())
    }

    fn time_of(&mut self, turned: f64, [from, to]: [f64; 2]) -> Option<f64> {
        if !self.orbit.rotates() {
            return root::bracketed(|t| self.turned(t) - turned, from, to);
        }
        let before = self.orbit.start().minus(self.task.start());
        let own = self.orbit.time_of_turn((turned - before).abs())?;
        Some(self.begin + own)
    }

    fn turning_times(&mut self) -> Vec<f64> {
        let times = self.orbit.turning_times(self.end);
        times.into_iter().map(|own| self.begin + own).collect()
    }

    fn row(&mut self, t: f64) -> Row {
        let (angle, omega) = self.orbit.state((t - self.begin).min(self.end));
        self.task.maker.row(t, angle, omega, None)
    }
}

/// Whether a crank angle, rad, is that of a dead centre.
pub(super) fn is_dead_centre(task: &RunSetup<'_>, theta: f64) -> bool {
    task.limits.dead_centres.iter().any(|dead_centre| {
        let apart = (theta - dead_centre.theta).rem_euclid(TAU);
        apart.min(TAU - apart) < 1e-12
    })
}
