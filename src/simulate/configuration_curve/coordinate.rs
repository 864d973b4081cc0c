//! The coordinate of the curve as rows and speeds see it.

use super::super::recorder::Coordinate;
use super::super::row::Row;
use super::stick_slip::{InPhase, Phase};
use crate::engine::Motion;
use crate::engine::step::Step;
use crate::mechanism::{CurveEquation, Reactor};
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// A step is looked at in this many pieces.
const PIECES: usize = 8;

/// The coordinate of the curve in one phase.
pub(in crate::simulate) struct AlongCurve<'a> {
    motion: InPhase<'a>,
    reactor: Option<&'a Reactor>,
    /// Crank angle of the start.
    start: Angle,
}

impl<'a> AlongCurve<'a> {
    pub fn new(
        equation: &'a CurveEquation,
        phase: Phase,
        reactor: Option<&'a Reactor>,
        start: Angle,
    ) -> AlongCurve<'a> {
        AlongCurve {
            motion: InPhase { equation, phase },
            reactor,
            start,
        }
    }

    /// Crank speed (rad/s) and its rate (rad/s²) at a time of a step, s.
    pub fn crank_speed(&self, step: &Step, t: f64) -> (f64, f64) {
        let (q, speed) = step.at(t);
        let place = self.motion.equation.curve().place(q);
        let rate = place.dtheta * step.acceleration_at(t) + place.d2theta * speed * speed;
        (place.dtheta * speed, rate)
    }
}

impl Coordinate for AlongCurve<'_> {
    fn motion(&self) -> &dyn Motion {
        &self.motion
    }

    fn turned(&self, step: &Step, t: f64) -> f64 {
        let angle = step.angle(step.at(t).0);
        let curve = self.motion.equation.curve();
        curve.crank_angle(angle).minus(self.start)
    }

    fn time_of(&self, step: &Step, turned: f64, [from, to]: [f64; 2]) -> Option<f64> {
        root::bracketed(|t| self.turned(step, t) - turned, from, to)
    }

    fn turning_times(&self, step: &Step) -> Vec<f64> {
        let time = |piece: usize| match piece {
            PIECES => step.end.t,
            _ => step.start.t + step.length() * piece as f64 / PIECES as f64,
        };
        let speed = |t: f64| {
            let (q, speed) = step.at(t);
            self.motion.equation.curve().place(q).dtheta * speed
        };
        let turns = |i: usize| {
            let (from, to) = (time(i), time(i + 1));
            let turns = speed(from) * speed(to) < 0.0;
            turns.then(|| root::bracketed(speed, from, to))?
        };
        (0..PIECES).filter_map(turns).collect()
    }

    fn row(&self, t: f64, angle: Angle, speed: f64) -> Row {
        let motion = &self.motion;
        let curve = motion.equation.curve();
        let place = curve.place(angle.rest);
        let (acceleration, touch, _) = motion.state(t, angle, speed);
        let reactions = self.reactor.map(|reactor| {
            let load = motion.load(&place, t, angle, speed);
            let force = load.force + touch.friction;
            reactor.on_curve(&place, speed, acceleration, force, touch.normal)
        });
        Row {
            clearance: None,
            t,
            theta: curve.crank_angle(angle).radians(),
            omega: place.dtheta * speed,
            alpha: place.dtheta * acceleration + place.d2theta * speed * speed,
            x: place.x,
            v: place.dx * speed,
            a: place.dx * acceleration + place.d2x * speed * speed,
            phi: place.phi(),
            reactions,
            driving_torque: None,
        }
    }
}
