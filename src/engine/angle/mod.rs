//! The angle engine: crank angle as the independent variable, for loads that depend on speed and time too,
//! as long as the speed keeps its sign.
//!
//! On each panel of Chebyshev points the kinetic energy and the time are found together by collocation,
//! K' = F(θ) + L(θ, ω, t), t' = 1/ω, with fixed-point sweeps that start from the profile of the turn before.
//! What depends on the position alone is tabulated in the first turn and used in all.

mod station;

use std::f64::consts::TAU;

use super::energy::leg::Leg;
use super::energy::panel::Panel;
use super::energy::{Orbit, Unserved};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{self, DEGREE, POINTS, Values};
use station::{Station, split, stations};

/// What the engine needs of a mechanism.
pub trait Driven {
    /// What the loads need to know of a position.
    type Place: Copy;

    /// Inertia M, the part F of the force that depends on the position alone (N m), and the place itself, at
    /// an angle, rad.
    fn place(&self, theta: f64) -> (f64, f64, Self::Place);

    /// The rest L of the force, N m, at time t (s), angle and speed (rad/s).
    fn drive(&self, place: &Self::Place, t: f64, angle: Angle, speed: f64) -> f64;

    /// Angles in [0, 2π), in rising order, at which panels end.
    fn corners(&self) -> &[f64];
}

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// At this time, s.
    Time(f64),
    /// When the crank has turned by this, rad, in its direction.
    Turned(f64),
}

/// A finished run.
pub struct Driving {
    /// Its motion.
    pub orbit: Orbit,
    /// Its last time, s.
    pub end: f64,
    /// Work of L until its end, J.
    pub work: f64,
    /// How often L was evaluated.
    pub evaluations: u64,
}

/// With less than this part of the largest kinetic energy the crank is near to rest.
const SLOW: f64 = 1e-2;
/// Most panels that are kept.
const MOST_PANELS: usize = 200_000;
/// Most sweeps over a panel.
const MOST_SWEEPS: u32 = 40;

/// How fine the panels are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Series end where their coefficients have decayed to this.
    pub tail: f64,
    /// Panels are cut unevenly once more from the start, which makes another discretization to compare with.
    pub other: bool,
}

/// Runs from `angle` with `speed` (rad/s) until the goal is reached.
///
/// # Errors
/// [`Unserved`] where the angle cannot be the independent variable.
pub fn run<D: Driven>(
    driven: &D,
    angle: Angle,
    speed: f64,
    goal: Goal,
    resolution: Resolution,
) -> Result<Driving, Unserved> {
    let tail = resolution.tail;
    let start = angle.reduced();
    let direction = speed.signum();
    let (inertia, ..) = driven.place(start.rest);
    let kinetic = 0.5 * inertia * speed * speed;
    if !kinetic.is_finite() {
        return Err(Unserved::NotFinite);
    }
    if kinetic == 0.0 {
        return Err(Unserved::TooSlow);
    }
    let mut stations = stations(driven, start.rest, direction)?;
    if resolution.other {
        for index in (0..stations.len()).rev() {
            split(driven, &mut stations, index, 0.37)?;
        }
    }
    let mut now = Now {
        t: 0.0,
        kinetic,
        turns: start.turns,
        direction,
        work: 0.0,
        evaluations: 0,
    };
    let mut leg = Leg::open();
    let mut next = 0;
    let mut fastest = kinetic;
    loop {
        if leg.len() >= MOST_PANELS {
            return Err(Unserved::TooLong);
        }
        fastest = fastest.max(now.kinetic);
        let before = now.work;
        let Some((panel, drives)) = now.sweep(driven, &mut stations[next], tail) else {
            if !split(driven, &mut stations, next, 0.5)? {
                let slow = now.kinetic < SLOW * fastest;
                return Err(if slow {
                    Unserved::TooSlow
                } else {
                    Unserved::NotSmooth
                });
            }
            continue;
        };
        let mut panel = panel;
        panel.turns = now.turns - start.turns;
        leg.push(panel);
        let passed = match goal {
            Goal::Time(until) => leg.duration.0 > until,
            Goal::Turned(way) => {
                let turned = direction * (stations[next].piece.to - start.rest);
                turned + direction * (now.turns - start.turns) * TAU >= way - 1e-12
            }
        };
        if passed {
            let orbit = Orbit::one_way(start, speed, leg);
            let end = match goal {
                Goal::Time(until) => until,
                Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(orbit.length()),
            };
            let work = before + work_until(orbit.leg(), end, &stations[next], &drives);
            return Ok(Driving {
                orbit,
                end,
                work,
                evaluations: now.evaluations,
            });
        }
        now.t = leg.duration.0;
        next += 1;
        if next == stations.len() {
            next = 0;
            now.turns += direction;
        }
    }
}

/// The state between two panels.
struct Now {
    t: f64,
    kinetic: f64,
    turns: f64,
    direction: f64,
    work: f64,
    evaluations: u64,
}

impl Now {
    /// Sweeps a panel until its kinetic energy stands still; none if it does not, or is not resolved.
    /// Also gives L at the points.
    fn sweep<D: Driven>(
        &mut self,
        driven: &D,
        station: &mut Station<D::Place>,
        tail: f64,
    ) -> Option<(Panel, Values)> {
        let half = 0.5 * (station.piece.to - station.piece.from);
        let mut kinetic = match &station.last {
            Some(last) => {
                let lift = self.kinetic - last[0];
                last.map(|k| k + lift)
            }
            None => {
                let gained = chebyshev::integrals(&station.force);
                gained.map(|work| self.kinetic + half * work)
            }
        };
        let mut drives = [0.0; POINTS];
        let mut change = f64::INFINITY;
        for _ in 0..MOST_SWEEPS {
            let slopes = slopes(&kinetic, &station.inertia, half)?;
            let times = chebyshev::integrals(&slopes);
            for j in 0..POINTS {
                let angle = Angle {
                    turns: self.turns,
                    rest: station.piece.angle(chebyshev::points()[j]),
                };
                let speed = self.direction * half.abs() / slopes[j];
                drives[j] = driven.drive(&station.places[j], self.t + times[j], angle, speed);
            }
            self.evaluations += POINTS as u64;
            let forces: Values = std::array::from_fn(|j| station.force[j] + drives[j]);
            let gained = chebyshev::integrals(&forces);
            let mut largest: f64 = 0.0;
            for (k, work) in kinetic.iter_mut().zip(&gained) {
                let new = self.kinetic + half * work;
                largest = largest.max((new - *k).abs() / new.abs());
                *k = new;
            }
            if !largest.is_finite() {
                return None;
            }
            let still = largest <= 0.1 * tail || (largest < 1e-14 && largest >= 0.3 * change);
            if still {
                return self.finish(station, kinetic, &forces, drives, tail);
            }
            if largest > 0.5 * change {
                return None;
            }
            change = largest;
        }
        None
    }

    fn finish<P>(
        &mut self,
        station: &mut Station<P>,
        kinetic: Values,
        forces: &Values,
        drives: Values,
        tail: f64,
    ) -> Option<(Panel, Values)> {
        let half = 0.5 * (station.piece.to - station.piece.from);
        let slopes = slopes(&kinetic, &station.inertia, half)?;
        let series = chebyshev::coefficients(&slopes);
        let noise = 8.0 * f64::EPSILON * (1.0 + station.piece.from.abs() / half.abs());
        let accepted = tail.max(noise);
        let series_tail = chebyshev::tail(&series);
        let force_series = chebyshev::coefficients(forces);
        let largest = force_series.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        let share = (largest * half.abs() / self.kinetic).min(1.0);
        if series_tail > accepted || chebyshev::tail(&force_series) * share > accepted {
            return None;
        }
        self.kinetic = kinetic[DEGREE];
        let weights = chebyshev::weights().iter();
        self.work += half * weights.zip(&drives).map(|(w, d)| w * d).sum::<f64>();
        station.last = Some(kinetic);
        let panel = Panel::from_slopes(station.piece, &slopes, series, series_tail, self.kinetic);
        Some((panel, drives))
    }
}

/// dt/dx at the points; none where the kinetic energy is not positive.
fn slopes(kinetic: &Values, inertia: &Values, half: f64) -> Option<Values> {
    let slopes = std::array::from_fn(|j| half.abs() * (0.5 * inertia[j] / kinetic[j]).sqrt());
    slopes
        .iter()
        .all(|slope: &f64| slope.is_finite())
        .then_some(slopes)
}

/// Work of L from the begin of the last panel until a time in it.
fn work_until<P>(leg: &Leg, until: f64, station: &Station<P>, drives: &Values) -> f64 {
    let Some((panel, since)) = leg.panel_at(until) else {
        return 0.0;
    };
    let work = chebyshev::integral(&chebyshev::coefficients(drives));
    let half = 0.5 * (station.piece.to - station.piece.from);
    half * chebyshev::value(&work, panel.position(since))
}
