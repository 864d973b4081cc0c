//! What a run on the curve gives beside its end: rows, events, extreme speeds, the dense trajectory.

use std::time::Instant;

use super::super::bounded_motion::Swing;
use super::super::dense_rows::{Spell, lengthen};
use super::super::event_log::Log;
use super::super::result::Event;
use super::super::row::{Row, RowSink};
use super::super::schedule::{Schedule, passed};
use super::arrived::Observer;
use super::stick_slip::{InPhase, Phase};
use crate::engine::events;
use crate::engine::step::Step;
use crate::error::Error;
use crate::mechanism::{CurveEquation, Reactor};
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// Follows a run.
pub(in crate::simulate) struct CurveWatch<'a> {
    pub equation: &'a CurveEquation,
    pub reactor: Option<&'a Reactor>,
    pub rows: &'a mut dyn RowSink,
    pub schedule: Schedule,
    /// Crank angle of the start.
    pub start: Angle,
    /// Turning points of the coordinate, if they may show that the crank never completes its turns.
    pub swing: Option<Swing>,
    pub log: Log,
    /// Refined steps, while there is room for them, and their phases.
    pub recorded: Option<Vec<Step>>,
    pub spells: Vec<Spell>,
    pub error: Option<Error>,
    /// How the last piece touched the guide.
    pub phase: Phase,
}

/// A step is looked at in this many pieces.
const PIECES: usize = 8;

impl Observer for CurveWatch<'_> {
    fn step(&mut self, step: &Step, phase: Phase) -> bool {
        self.phase = phase;
        self.log.checkpoints.pass(step);
        let mut step = *step;
        let equation = self.equation;
        let motion = InPhase { equation, phase };
        if phase != Phase::Sticking {
            self.follow_speed(&mut step, &motion);
        }
        if self.rows.wants_rows() {
            let begun = Instant::now();
            let result = self.write_rows(&mut step, &motion);
            self.log.row_time += begun.elapsed();
            if let Err(error) = result {
                self.error = Some(error);
                return true;
            }
        }
        if let Some(mut recorded) = self.recorded.take()
            && self.log.take_room()
        {
            step.refine(&motion);
            recorded.push(step);
            lengthen(&mut self.spells, [step.start.t, step.end.t], phase);
            self.recorded = Some(recorded);
        }
        self.swing.is_some_and(|swing| swing.is_caught())
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        if kind == "turning-point"
            && let Some(swing) = &mut self.swing
        {
            swing.turns_at(angle);
        }
        let curve = self.equation.curve();
        self.log.event(|| Event {
            kind,
            t_s: t,
            theta_rad: curve.crank_angle(angle).radians(),
            omega_rad_per_s: curve.place(angle.rest).dtheta * speed,
        });
    }
}

impl CurveWatch<'_> {
    fn crank_speed(&self, step: &Step, t: f64) -> f64 {
        let (q, speed) = step.at(t);
        self.equation.curve().place(q).dtheta * speed
    }

    fn turned(&self, step: &Step, t: f64) -> f64 {
        let angle = step.angle(step.at(t).0);
        self.equation.curve().crank_angle(angle).minus(self.start)
    }

    /// Least and largest crank speed.
    fn follow_speed(&mut self, step: &mut Step, motion: &InPhase<'_>) {
        let curve = self.equation.curve();
        self.log.speed = events::follow(step, motion, self.log.speed, |step, t| {
            let (q, speed) = step.at(t);
            let place = curve.place(q);
            let rate = place.dtheta * step.acceleration_at(t) + place.d2theta * speed * speed;
            (place.dtheta * speed, rate)
        });
    }

    fn write_rows(&mut self, step: &mut Step, motion: &InPhase<'_>) -> Result<(), Error> {
        if let Some(spacing) = self.schedule.angle_step() {
            return self.write_rows_at_angles(step, motion, spacing);
        }
        while let Some(t) = self.schedule.time(self.log.next_row) {
            if t > step.end.t {
                break;
            }
            if t > step.start.t && t < step.end.t {
                step.refine(motion);
            }
            self.write_row(step, motion, t)?;
            self.log.next_row += 1;
        }
        Ok(())
    }

    fn write_rows_at_angles(
        &mut self,
        step: &mut Step,
        motion: &InPhase<'_>,
        spacing: f64,
    ) -> Result<(), Error> {
        if self.log.next_row == 0 {
            self.write_row(step, motion, step.start.t)?;
            self.log.next_row = 1;
        }
        // Between the times at which the crank turns back its angle is monotone.
        let mut cuts = vec![step.start.t];
        for i in 0..PIECES {
            let (from, to) = (time(step, i), time(step, i + 1));
            let (a, b) = (self.crank_speed(step, from), self.crank_speed(step, to));
            if a * b < 0.0 {
                cuts.extend(root::bracketed(|t| self.crank_speed(step, t), from, to));
            }
        }
        cuts.push(step.end.t);
        for w in cuts.windows(2) {
            let way = |t: f64| self.turned(step, t) / spacing;
            for k in passed(way(w[0]), way(w[1])) {
                step.refine(motion);
                let target = k * spacing;
                let t = root::bracketed(|t| self.turned(step, t) - target, w[0], w[1]);
                self.write_row(step, motion, t.unwrap_or(w[1]))?;
            }
        }
        Ok(())
    }

    fn write_row(&mut self, step: &Step, motion: &InPhase<'_>, t: f64) -> Result<(), Error> {
        let (theta, speed) = step.at(t);
        let now = (t, step.angle(theta), speed);
        let row = row_on_curve(self.equation, self.reactor, motion.phase, now);
        self.rows.row(&row)
    }

    /// The last state is a row always.
    pub fn write_last_row(&mut self, last: &Step) -> Result<(), Error> {
        if self.rows.wants_rows() {
            let motion = InPhase {
                equation: self.equation,
                phase: self.phase,
            };
            self.write_row(last, &motion, last.end.t)?;
        }
        Ok(())
    }
}

/// The row of a time (s), a coordinate and its rate (rad/s) in one phase.
pub(in crate::simulate) fn row_on_curve(
    equation: &CurveEquation,
    reactor: Option<&Reactor>,
    phase: Phase,
    (t, angle, speed): (f64, Angle, f64),
) -> Row {
    let motion = InPhase { equation, phase };
    let curve = equation.curve();
    let place = curve.place(angle.rest);
    let (acceleration, touch, _) = motion.state(t, angle, speed);
    let reactions = reactor.map(|reactor| {
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

fn time(step: &Step, piece: usize) -> f64 {
    if piece == PIECES {
        step.end.t
    } else {
        step.start.t + step.length() * piece as f64 / PIECES as f64
    }
}
