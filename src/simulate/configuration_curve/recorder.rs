//! A run on the configuration curve as it is recorded: its rows, its events, the speeds of its crank.

use super::super::bounded_motion::Swing;
use super::super::recorder::{Coordinate, Recorder};
use super::super::result::Event;
use super::super::row::Row;
use super::arrived::Observer;
use super::row::row_on_curve;
use super::stick_slip::{InPhase, Phase};
use crate::engine::Motion;
use crate::engine::events;
use crate::engine::step::Step;
use crate::mechanism::{CurveEquation, Reactor};
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// Follows a run.
pub(in crate::simulate) struct CurveWatch<'a, 'r> {
    pub equation: &'a CurveEquation,
    pub recorder: &'a mut Recorder<'r>,
    /// Turning points of the coordinate, if they may show that the crank never completes its turns.
    pub swing: Option<Swing>,
    /// How the last piece touched the guide.
    pub phase: Phase,
}

/// A step is looked at in this many pieces.
const PIECES: usize = 8;

impl Observer for CurveWatch<'_, '_> {
    fn step(&mut self, step: &Step, phase: Phase) -> bool {
        self.phase = phase;
        let mut step = *step;
        let along = self.along(phase);
        if phase != Phase::Sticking {
            let speed = self.recorder.speed();
            *speed = events::follow(&mut step, &along.motion, *speed, |step, t| {
                along.crank_speed(step, t)
            });
        }
        let until = step.end.t;
        let fails = self.recorder.step(&mut step, until, &along, Some(phase));
        fails || self.swing.is_some_and(|swing| swing.is_caught())
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        if kind == "turning-point"
            && let Some(swing) = &mut self.swing
        {
            swing.turns_at(angle);
        }
        let curve = self.equation.curve();
        self.recorder.event(|| Event {
            kind,
            t_s: t,
            theta_rad: curve.crank_angle(angle).radians(),
            omega_rad_per_s: curve.place(angle.rest).dtheta * speed,
        });
    }
}

impl<'a> CurveWatch<'a, '_> {
    fn along(&self, phase: Phase) -> AlongCurve<'a> {
        let task = self.recorder.task();
        let equation = self.equation;
        AlongCurve {
            motion: InPhase { equation, phase },
            reactor: task.maker.reactor,
            start: task.start(),
        }
    }
}

/// The coordinate of the curve in one phase.
struct AlongCurve<'a> {
    motion: InPhase<'a>,
    reactor: Option<&'a Reactor>,
    /// Crank angle of the start.
    start: Angle,
}

impl AlongCurve<'_> {
    /// Crank speed (rad/s) and its rate (rad/s²) at a time of a step, s.
    fn crank_speed(&self, step: &Step, t: f64) -> (f64, f64) {
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
        let InPhase { equation, phase } = self.motion;
        row_on_curve(equation, self.reactor, phase, (t, angle, speed))
    }
}
