//! What a run in time gives beside its end: rows, events, extreme speeds, the dense trajectory.

use std::time::Instant;

use super::bounded_motion::Swing;
use super::event_log::Log;
use super::result::Event;
use super::row::{RowMaker, RowSink};
use super::schedule::{Schedule, passed};
use crate::engine::events::{self, Crossing};
use crate::engine::step::Step;
use crate::engine::{Counted, time::Start};
use crate::error::Error;
use crate::numeric::angle::Angle;

/// Follows the steps of a run.
pub(super) struct Recorder<'a> {
    pub motion: &'a Counted<'a>,
    pub maker: &'a RowMaker<'a>,
    pub rows: &'a mut dyn RowSink,
    pub schedule: Schedule,
    pub start: Start,
    /// Angles that are watched, in [0, 2π): the dead centres, then the limits of the crank's motion, where
    /// the run ends.
    pub watched: Vec<f64>,
    /// How many of them are dead centres.
    pub dead_centres: usize,
    /// The run ends when the crank has turned by this, rad.
    pub turn_limit: Option<f64>,
    /// Turning points, if they may show that the crank never does.
    pub swing: Option<Swing>,
    pub log: Log,
    pub seen: Seen,
    /// Refined steps, while there is room for them.
    pub recorded: Option<Vec<Step>>,
}

/// What was seen so far that ends the run.
#[derive(Debug, Default)]
pub(super) struct Seen {
    /// When the turn limit or a limit of the motion was reached, or the crank was caught.
    pub ends_at: Option<f64>,
    /// Whether it was a limit of the motion.
    pub at_limit: bool,
    pub error: Option<Error>,
    /// Angle and speed (rad/s) of a start at a dead centre that was noted before.
    pub passed: Option<(Angle, f64)>,
    crossings: Vec<(f64, Crossing)>,
}

impl Recorder<'_> {
    /// Takes a step; true ends the run.
    pub fn step(&mut self, step: &Step) -> bool {
        self.log.checkpoints.pass(step);
        let mut step = *step;
        self.reached_turn_limit(&mut step);
        self.look_for_events(&mut step);
        let until = self.seen.ends_at.unwrap_or(step.end.t);
        if self.seen.ends_at.is_none() {
            self.follow_speed(&mut step);
        }
        if self.rows.wants_rows() {
            let begun = Instant::now();
            let result = self.write_rows(&mut step, until);
            self.log.row_time += begun.elapsed();
            if let Err(error) = result {
                self.seen.error = Some(error);
                return true;
            }
        }
        if let Some(mut recorded) = self.recorded.take()
            && self.log.take_room()
        {
            step.refine(self.motion);
            recorded.push(step);
            self.recorded = Some(recorded);
        }
        self.seen.ends_at.is_some()
    }

    /// Least and largest speed.
    pub fn follow_speed(&mut self, step: &mut Step) {
        self.log.speed = events::follow_speed(step, self.motion, self.log.speed);
    }

    /// Whether the crank swings to and fro for ever.
    pub fn is_caught(&self) -> bool {
        self.swing.is_some_and(|swing| swing.is_caught())
    }

    pub fn turned(&self, step: &Step, theta: f64) -> f64 {
        step.angle(theta).minus(self.start.angle)
    }

    fn reached_turn_limit(&mut self, step: &mut Step) {
        let Some(limit) = self.turn_limit else {
            return;
        };
        if self.turned(step, step.end.theta).abs() < limit {
            return;
        }
        step.refine(self.motion);
        let beyond = self.turned(step, step.end.theta);
        let target = step.end.theta - (beyond - limit.copysign(beyond));
        let t = step.time_of_angle(target, step.start.t, step.end.t);
        self.seen.ends_at = Some(t.unwrap_or(step.end.t));
    }

    fn look_for_events(&mut self, step: &mut Step) {
        let mut crossings = std::mem::take(&mut self.seen.crossings);
        events::crossings(step, &self.watched, &mut crossings);
        let rough = !step.is_refined();
        let wanted = self.log.keeps_more() || self.swing.is_some();
        if rough && !crossings.is_empty() && wanted {
            step.refine(self.motion);
            events::crossings(step, &self.watched, &mut crossings);
        }
        for &(t, what) in &crossings {
            // An event at the end of the run may be off it by rounding.
            let end = self.seen.ends_at.unwrap_or(t);
            if t > end * (1.0 + 8.0 * f64::EPSILON) {
                break;
            }
            let t = t.min(end);
            let at_limit = matches!(what, Crossing::Angle(index) if index >= self.dead_centres);
            if at_limit {
                self.seen.ends_at = Some(t);
                self.seen.at_limit = true;
            }
            let (theta, omega) = step.at(t);
            if let Some((angle, speed)) = self.seen.passed.take()
                && step.angle(theta).minus(angle).abs() < 1e-9
                && omega * speed > 0.0
            {
                continue;
            }
            let at = step.angle(theta);
            self.log.event(|| Event {
                kind: match what {
                    Crossing::Angle(_) if at_limit => "limit",
                    Crossing::Angle(_) => "dead-centre",
                    Crossing::Turning => "turning-point",
                },
                t_s: t,
                theta_rad: at.radians(),
                omega_rad_per_s: match what {
                    Crossing::Angle(_) => omega,
                    Crossing::Turning => 0.0,
                },
            });
            if what == Crossing::Turning
                && let Some(swing) = &mut self.swing
            {
                swing.turns_at(at);
                if swing.is_caught() {
                    self.seen.ends_at = Some(t);
                    break;
                }
            }
        }
        self.seen.crossings = crossings;
    }

    fn write_rows(&mut self, step: &mut Step, until: f64) -> Result<(), Error> {
        if let Some(spacing) = self.schedule.angle_step() {
            return self.write_rows_at_angles(step, until, spacing);
        }
        while let Some(t) = self.schedule.time(self.log.next_row) {
            if t > until {
                break;
            }
            if t > step.start.t && t < step.end.t {
                step.refine(self.motion);
            }
            self.write_row(step, t)?;
            self.log.next_row += 1;
        }
        Ok(())
    }

    fn write_rows_at_angles(
        &mut self,
        step: &mut Step,
        until: f64,
        spacing: f64,
    ) -> Result<(), Error> {
        if self.log.next_row == 0 {
            self.write_row(step, step.start.t)?;
            self.log.next_row = 1;
        }
        let turning = self.seen.crossings.iter();
        let turning = turning.filter(|(_, what)| *what == Crossing::Turning);
        let mut cuts: Vec<f64> = turning.map(|(t, _)| *t).filter(|t| *t < until).collect();
        cuts.push(until);
        let mut from = step.start.t;
        for to in cuts {
            let way = |t: f64| self.turned(step, step.at(t).0) / spacing;
            for k in passed(way(from), way(to)) {
                step.refine(self.motion);
                let theta = step.start.theta + (k * spacing - self.turned(step, step.start.theta));
                // A turning point may fall short of its angle by rounding.
                let t = step.time_of_angle(theta, from, to).unwrap_or(to);
                self.write_row(step, t)?;
            }
            from = to;
        }
        Ok(())
    }

    fn write_row(&mut self, step: &Step, t: f64) -> Result<(), Error> {
        let (theta, omega) = step.at(t);
        self.write(t, step.angle(theta), omega)
    }

    /// Writes the row of a state.
    pub fn write(&mut self, t: f64, angle: Angle, omega: f64) -> Result<(), Error> {
        let row = self.maker.row(t, angle, omega, None);
        self.rows.row(&row)
    }

    /// The last state is a row always.
    pub fn write_last_row(&mut self, last: &Step) -> Result<(), Error> {
        if self.rows.wants_rows() {
            self.write(last.end.t, last.angle(last.end.theta), last.end.omega)?;
        }
        Ok(())
    }
}
