//! Events and rows of a motion that is known as a whole, over the crank angle or at constant speed.

use std::f64::consts::TAU;

use super::guide_friction::DEAD_CENTRE_WIDTH;
use super::result::Event;
use super::row::Row;
use super::row_writer::RowSource;
use super::run_setup::RunSetup;
use crate::engine::energy::Orbit;
use crate::engine::time::MotionState;
use crate::numeric::angle::{Angle, circular_distance};
use crate::numeric::root;

/// Motion over the crank angle, or a piece of one, placed in the time of the run.
pub(super) struct OrbitPiece<'a> {
    /// Motion over the angle; the time of the orbit begins at 0.
    pub orbit: &'a Orbit,
    /// Time of the run at which the orbit begins, s.
    pub begin: f64,
    /// Last time of the orbit, s.
    pub end: f64,
    pub task: &'a RunSetup<'a>,
}

/// Returns the angle within which a dead centre counts as reached, rad: far from zero angles are rounded more.
fn dead_centre_tolerance(way: f64) -> f64 {
    (8.0 * f64::EPSILON * way).max(DEAD_CENTRE_WIDTH)
}

/// Lists distance, rad in (0, 2π], and angle of each dead centre ahead in a direction: the start is not passed.
fn dead_centres_ahead(task: &RunSetup<'_>, of: Angle, direction: f64) -> Vec<(f64, f64)> {
    let dead_centres = task.limits.dead_centres.iter();
    let mut all: Vec<(f64, f64)> = dead_centres
        .map(|dead_centre| {
            let ahead = (direction * (dead_centre.theta - of.rest)).rem_euclid(TAU);
            let here = ahead <= dead_centre_tolerance(of.rest.abs());
            (if here { TAU } else { ahead }, dead_centre.theta)
        })
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// Lists the dead centres that a crank passes on a way (rad) from an angle without turning back, at most `kept`, and
/// counts all of them; `at` returns time (s) and speed (rad/s) at a distance, rad.
fn dead_centres_on_way(
    task: &RunSetup<'_>,
    (from, direction): (Angle, f64),
    way: f64,
    kept: usize,
    at: impl Fn(f64) -> (f64, f64),
) -> (Vec<MotionState>, u64) {
    let way = (way + dead_centre_tolerance(from.rest.abs())) * (1.0 + 4.0 * f64::EPSILON);
    let first = dead_centres_ahead(task, from, direction);
    let count = |(ahead, _): &(f64, f64)| ((way - ahead) / TAU + 1.0).floor().max(0.0) as u64;
    let turns = (0u32..).map(|turn| f64::from(turn) * TAU);
    let marks = turns.flat_map(|before| first.iter().map(move |(ahead, dc)| (before + ahead, *dc)));
    let marks = marks.take_while(|(ahead, _)| *ahead <= way).take(kept);
    let passed = marks.map(|(ahead, dead_centre)| {
        let (t, speed) = at(ahead);
        passage(t, from, direction * ahead, dead_centre, speed)
    });
    (passed.collect(), first.iter().map(count).sum())
}

/// Lists the passages of dead centres at constant speed until a time (s): the first in order, and the number of all.
pub(super) fn at_constant_speed(task: &RunSetup<'_>, end: f64) -> (Vec<Event>, u64) {
    let (from, speed) = ((task.start(), task.speed.signum()), task.speed);
    if speed == 0.0 {
        return (Vec::new(), 0);
    }
    let (way, kept) = (speed.abs() * end, task.options.events_kept);
    let at = |ahead: f64| ((ahead / speed.abs()).min(end), speed);
    let (passed, total) = dead_centres_on_way(task, from, way, kept, at);
    let event = |at| Event::new(DEAD_CENTRE, at);
    (passed.into_iter().map(event).collect(), total)
}

impl OrbitPiece<'_> {
    /// Lists the dead centres of a motion that does not turn back until an orbit time (s), at most `kept`; counts all.
    fn one_way(&self, until: f64, kept: usize) -> (Vec<MotionState>, u64) {
        let orbit = self.orbit;
        let from = (orbit.start, orbit.direction);
        let way = orbit.state(until).0.minus(orbit.start).abs();
        dead_centres_on_way(self.task, from, way, kept, |ahead| {
            let known = orbit.passage(ahead).filter(|(t, _)| *t <= until);
            known.unwrap_or_else(|| (until, orbit.state(until).1))
        })
    }

    /// Lists dead centres and turning points of a motion to and fro until a time (s), in the time of the orbit.
    fn to_and_fro(&self, until: f64) -> Vec<(&'static str, MotionState)> {
        let orbit = self.orbit;
        let turnings = orbit.turning_times(until).into_iter();
        let cuts = turnings.map(|t| (t, true)).chain([(until, false)]);
        let (mut found, mut from) = (Vec::new(), 0.0);
        for (to, turns_back) in cuts {
            let [begin, end] = [from, to].map(|t| orbit.state(t).0);
            let (direction, span) = (end.minus(begin).signum(), end.minus(begin).abs());
            let last = match turns_back {
                true => span - dead_centre_tolerance(span),
                false => span + dead_centre_tolerance(span),
            };
            for (ahead, dead_centre) in dead_centres_ahead(self.task, begin, direction) {
                let mut ahead = ahead;
                while ahead <= last {
                    let beyond = |t: f64| orbit.state(t).0.minus(begin).abs() - ahead;
                    let t = root::bracketed(beyond, from, to).unwrap_or(to);
                    let (speed, way) = (orbit.state(t).1, direction * ahead);
                    found.push((DEAD_CENTRE, passage(t, begin, way, dead_centre, speed)));
                    ahead += TAU;
                }
            }
            let turning_point = MotionState {
                t: to,
                angle: end,
                speed: 0.0,
            };
            found.extend(turns_back.then_some(("turning-point", turning_point)));
            from = to;
        }
        found.sort_by(|(_, a), (_, b)| a.t.total_cmp(&b.t));
        found
    }

    /// Lists dead centres and turning points in order of time: the first, at most `kept`, and the number of all.
    pub fn events(&self, kept: usize) -> (Vec<Event>, u64) {
        let (orbit, turns_back) = (self.orbit, self.orbit.turns_back());
        let repeats = orbit.period().filter(|(period, _)| *period < self.end);
        let (period, low) = repeats.unwrap_or((self.end, 0.0));
        let once = match turns_back {
            true => self.to_and_fro(period),
            false => {
                let passed = self.one_way(period, kept).0.into_iter();
                passed.map(|at| (DEAD_CENTRE, at)).collect()
            }
        };
        let over = self.end * (1.0 + 1e-14);
        let rounds = |(_, at): &(&str, MotionState)| match repeats {
            Some(_) => ((over - at.t) / period + 1.0).floor() as u64,
            None => 1,
        };
        let total = match turns_back {
            true => once.iter().map(rounds).sum(),
            false => self.one_way(self.end, 0).1,
        };
        let turns = if turns_back { 0.0 } else { orbit.direction };
        let most = total.min(kept as u64) * u64::from(!once.is_empty());
        let again = (0u64..).map(|round| round as f64).flat_map(|round| {
            once.iter().map(move |(kind, at)| {
                let t = round.mul_add(period, at.t) + round * low;
                let again = MotionState {
                    t: self.begin + t.min(self.end),
                    angle: Angle::new(at.angle.turns + round * turns, at.angle.rest),
                    speed: at.speed,
                };
                Event::new(kind, again)
            })
        });
        (again.take(most as usize).collect(), total)
    }
}

const DEAD_CENTRE: &str = "dead-centre";

/// Returns the state at a dead centre (rad) at a signed distance (rad) from an angle.
fn passage(t: f64, from: Angle, way: f64, dead_centre: f64, speed: f64) -> MotionState {
    let turns = ((from.rest + way - dead_centre) / TAU).round();
    let angle = Angle::new(from.turns + turns, dead_centre);
    MotionState { t, angle, speed }
}

impl RowSource for OrbitPiece<'_> {
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
        let before = self.orbit.start.minus(self.task.start());
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

/// True if a crank angle, rad, is that of a dead centre.
pub(super) fn is_dead_centre(task: &RunSetup<'_>, theta: f64) -> bool {
    let mut dead_centres = task.limits.dead_centres.iter();
    let tolerance = dead_centre_tolerance(theta.abs());
    dead_centres.any(|dead_centre| circular_distance(theta, dead_centre.theta) <= tolerance)
}
