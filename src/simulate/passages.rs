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

impl Stretch<'_> {
    /// Sign of the turns it makes: +1 or −1.
    fn direction(&self) -> f64 {
        self.orbit.direction()
    }

    fn is_over(&self, t: f64) -> bool {
        t > self.end * (1.0 + 1e-14)
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

/// Dead centres and turning points in the order of time, those of a period again and again: the first ones, at most
/// `kept`, and how many there are.
pub(super) fn events(task: &RunSetup<'_>, stretch: &Stretch<'_>, kept: usize) -> (Vec<Event>, u64) {
    let Stretch {
        orbit, begin, end, ..
    } = *stretch;
    let mut once: Vec<(f64, &'static str, Angle, f64)> = Vec::new();
    let marks = dead_centres(task);
    for passage in orbit.passages(&marks) {
        let kind = if passage.turning {
            "turning-point"
        } else {
            "dead-centre"
        };
        once.push((passage.t, kind, passage.angle, passage.speed));
    }
    let period = orbit.period().map_or(f64::INFINITY, |period| period.0);
    let total = once
        .iter()
        .filter(|event| !stretch.is_over(event.0))
        .map(|event| {
            if period.is_finite() {
                ((end - event.0) / period + 1e-9).floor() + 1.0
            } else {
                1.0
            }
        })
        .sum::<f64>();
    let mut events = Vec::new();
    let mut round = 0.0;
    'all: loop {
        for (t, kind, angle, speed) in &once {
            let t = if round == 0.0 { *t } else { t + round * period };
            if stretch.is_over(t) || events.len() >= kept {
                break 'all;
            }
            let turns = if orbit.rotates() {
                round * stretch.direction()
            } else {
                0.0
            };
            let angle = Angle {
                turns: angle.turns + turns,
                rest: angle.rest,
            };
            events.push(Event {
                kind,
                t_s: begin + t,
                theta_rad: angle.radians(),
                omega_rad_per_s: *speed,
            });
        }
        round += 1.0;
        if !period.is_finite() || once.is_empty() {
            break;
        }
    }
    let later = later_events(&marks, stretch, kept, &mut events);
    (events, total as u64 + later)
}

/// Crank angles of the dead centres, in [0, 2π).
fn dead_centres(task: &RunSetup<'_>) -> Vec<f64> {
    let dead_centres = task.limits.dead_centres.iter();
    dead_centres.map(|dead_centre| dead_centre.theta).collect()
}

/// Whether a crank angle, rad, is that of a dead centre.
pub(super) fn is_dead_centre(task: &RunSetup<'_>, theta: f64) -> bool {
    task.limits.dead_centres.iter().any(|dead_centre| {
        let apart = (theta - dead_centre.theta).rem_euclid(TAU);
        apart.min(TAU - apart) < 1e-12
    })
}

/// Adds the dead centres of the turns after the first ones, and says how many there are.
fn later_events(
    dead_centres: &[f64],
    stretch: &Stretch<'_>,
    kept: usize,
    events: &mut Vec<Event>,
) -> u64 {
    let orbit = stretch.orbit;
    // Each dead centre is passed once in a turn.
    let Some(first) = orbit.later_from() else {
        return 0;
    };
    orbit.later_passages(dead_centres, |passage| {
        if stretch.is_over(passage.t) {
            return false;
        }
        if events.len() < kept {
            events.push(Event {
                kind: "dead-centre",
                t_s: stretch.begin + passage.t,
                theta_rad: passage.angle.radians(),
                omega_rad_per_s: passage.speed,
            });
        }
        events.len() < kept
    });
    let start = orbit.start();
    let last = orbit.state(stretch.end).0.minus(start).abs();
    let passes = |dead_centre: &f64| {
        let ahead = (stretch.direction() * (dead_centre - start.rest)).rem_euclid(TAU);
        let until = |way: f64| ((way - ahead) / TAU + 1e-12).floor();
        (until(last) - until(first)).max(0.0) as u64
    };
    dead_centres.iter().map(passes).sum()
}
