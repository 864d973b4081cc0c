//! Recording of a free motion, whatever engine computes it: rows, events, speeds, and an end inside a step.

use std::sync::Arc;

use super::super::angle_model::SAME_CORNER;
use super::super::bounded_motion::BoundedMotion;
use super::super::configuration_curve::{CurveProblem, StepObserver};
use super::super::coordinate::{Coordinate, crank_state};
use super::super::passages::{OrbitPiece, is_dead_centre};
use super::super::recorder::{Record, Recorder};
use super::super::result::Event;
use super::super::row::RowSink;
use super::super::run_setup::RunSetup;
use super::super::stick_slip::{CurveMotion, StickSlipPhase};
use super::super::stop::Why;
use super::engine_loop::{AnglePiece, PassObserver, PassResult, Reason};
use crate::engine::Counted;
use crate::engine::events::{self, Crossing};
use crate::engine::step::Step;
use crate::engine::time::{self, MotionState, Settings};
use crate::error::Error;
use crate::mechanism::CurveEquation;
use crate::plan::Engine;
use crate::trajectory::Trajectory;

/// Observer that records a free motion: rows, dead centres, turning points and speeds.
pub(super) struct ForwardRecorder<'a> {
    task: &'a RunSetup<'a>,
    recorder: Recorder<'a>,
    /// Dead centres, rad in [0, 2π).
    dead_centres: Vec<f64>,
    /// Record of turning points, if the crank may never complete its turns.
    bounded_motion: Option<BoundedMotion>,
    /// Time of an end inside the last step, s: the turns are complete, or the swing of the crank no longer grows.
    ends_at: Option<f64>,
    /// Start of a piece at a dead centre that is already recorded.
    recorded_dead_centre: Option<MotionState>,
    crossings: Vec<(f64, Crossing)>,
    /// Configuration curve of the last piece in time, if it follows one.
    curve: Option<Arc<CurveEquation>>,
    /// Last phase of the slider in its guide.
    phase: StickSlipPhase,
}

impl<'a> ForwardRecorder<'a> {
    pub fn new(task: &'a RunSetup<'a>, rows: &'a mut dyn RowSink) -> ForwardRecorder<'a> {
        ForwardRecorder {
            task,
            recorder: Recorder::new(task, rows, task.schedule()),
            dead_centres: task.dead_centres(),
            bounded_motion: BoundedMotion::new(task, task.start()),
            ends_at: None,
            recorded_dead_centre: None,
            crossings: Vec::new(),
            curve: None,
            phase: StickSlipPhase::Sticking,
        }
    }

    /// Returns the reason for the end, if the crank is caught in a swing.
    pub fn caught(&self) -> Option<Why> {
        let curve = self.curve.as_ref().map(|equation| equation.curve());
        let crank = |at| curve.map_or(at, |curve| curve.crank_angle(at));
        self.bounded_motion?.why(crank)
    }

    /// Returns the record, with the row of the end.
    pub fn finish(self, result: &PassResult) -> Result<Record, Error> {
        let MotionState { t, angle, speed } = result.state;
        let ForwardRecorder { task, phase, .. } = self;
        let mut record = self.recorder.finish(|| {
            Some(match (result.last_step, &result.curve) {
                (Some(last), Some(curve)) => {
                    let equation = &*curve.equation;
                    let motion = CurveMotion { equation, phase };
                    let end = last.end;
                    motion.row(&task.maker, t, last.angle(end.theta), end.omega)
                }
                _ => task.maker.row(t, angle, speed, None),
            })
        })?;
        record.curve = self.curve;
        Ok(record)
    }

    /// Records a step of the crank; true ends the run.
    fn step_of_crank(&mut self, mut step: Step, along: &Coordinate<'_>) -> bool {
        self.reach_turn_limit(&mut step);
        self.look_for_events(&mut step);
        if self.ends_at.is_none() {
            self.follow_speed(&mut step);
        }
        let until = self.ends_at.unwrap_or(step.end.t);
        self.recorder.step(&mut step, until, along) || self.ends_at.is_some()
    }

    /// Records a step along the configuration curve; true ends the run.
    fn step_on_curve(&mut self, mut step: Step, motion: CurveMotion<'_>) -> bool {
        self.phase = motion.phase;
        if motion.phase != StickSlipPhase::Sticking {
            let speed = self.recorder.speed();
            let crank = |step: &Step, t: f64| motion.crank_speed(step, t);
            *speed = events::follow(&mut step, &motion, *speed, crank);
        }
        let until = step.end.t;
        let curve = Coordinate::Curve(motion);
        self.recorder.step(&mut step, until, &curve) || self.is_bounded()
    }

    /// Whether the crank swings to and fro, and its swing no longer grows.
    fn is_bounded(&self) -> bool {
        self.bounded_motion
            .is_some_and(|motion| motion.is_bounded())
    }

    fn follow_speed(&mut self, step: &mut Step) {
        let speed = self.recorder.speed();
        *speed = events::follow_speed(step, self.task.equation(), *speed);
    }

    /// Returns the rotation of the crank from the start of the run to the end of a step, rad.
    fn turned(&self, step: &Step) -> f64 {
        step.angle(step.end.theta).minus(self.task.start())
    }

    /// Integrates the last step anew up to the end of the run inside it; iterates at a turn limit to meet it exactly.
    fn shortened(
        &mut self,
        motion: &Counted<'_>,
        step: &Step,
        settings: &Settings<'_>,
    ) -> Option<Step> {
        let until = |t_end: f64, sink: &mut dyn FnMut(&Step) -> bool| {
            time::shortened(motion, step, t_end, settings, sink)
        };
        let mut t = self.ends_at?;
        if let Some(limit) = self.task.extent.angle().filter(|_| !self.is_bounded()) {
            t = step.newton_time(t, 3, |t| {
                let last = until(t, &mut |_| false);
                let turned = self.turned(&last);
                [limit.copysign(turned) - turned, last.end.omega]
            });
        }
        Some(until(t, &mut |step| {
            self.follow_speed(&mut step.clone());
            false
        }))
    }

    fn reach_turn_limit(&mut self, step: &mut Step) {
        let Some(limit) = self.task.extent.angle() else {
            return;
        };
        let turned = self.turned(step);
        if turned.abs() < limit {
            return;
        }
        step.refine(self.task.equation());
        let target = step.end.theta - (turned - limit.copysign(turned));
        let t = step.time_of_angle(target, step.start.t, step.end.t);
        self.ends_at = Some(t.unwrap_or(step.end.t));
    }

    fn look_for_events(&mut self, step: &mut Step) {
        let mut crossings = std::mem::take(&mut self.crossings);
        events::crossings(step, &self.dead_centres, &mut crossings);
        let wanted = self.recorder.keeps_events() || self.bounded_motion.is_some();
        if !step.is_refined() && !crossings.is_empty() && wanted {
            step.refine(self.task.equation());
            events::crossings(step, &self.dead_centres, &mut crossings);
        }
        for &(t, what) in &crossings {
            // Rounding may put an event at the end of the run beside the end.
            let end = self.ends_at.unwrap_or(t);
            if t > end * (1.0 + 8.0 * f64::EPSILON) {
                break;
            }
            self.record_crossing(step, t.min(end), what);
            if self.is_bounded() {
                break;
            }
        }
        self.crossings = crossings;
    }

    /// Records a crossing at a time (s) of a step, and the end of the run if the crank is caught.
    fn record_crossing(&mut self, step: &Step, t: f64, what: Crossing) {
        let (theta, speed) = step.at(t);
        let angle = step.angle(theta);
        let at = MotionState { t, angle, speed };
        if let Some(known) = self.recorded_dead_centre.take()
            && angle.minus(known.angle).abs() < SAME_CORNER
            && speed * known.speed > 0.0
        {
            return;
        }
        match what {
            Crossing::Angle => self.event("dead-centre", at),
            Crossing::Turning => {
                self.event("turning-point", MotionState { speed: 0.0, ..at });
                if self.is_bounded() {
                    self.ends_at = Some(t);
                }
            }
        }
    }
}

impl StepObserver for ForwardRecorder<'_> {
    fn step(&mut self, step: &Step, along: &Coordinate<'_>) -> bool {
        match *along {
            Coordinate::Curve(along) => self.step_on_curve(*step, along),
            Coordinate::Crank(_) => self.step_of_crank(*step, along),
        }
    }

    fn event(&mut self, kind: &'static str, at: MotionState) {
        if kind == "turning-point"
            && let Some(bounded_motion) = &mut self.bounded_motion
        {
            bounded_motion.add_turning_point(at.angle);
        }
        let crank = |equation: &Arc<CurveEquation>| crank_state(equation, at);
        let at = self.curve.as_ref().map_or(at, crank);
        self.recorder.event(Event::new(kind, at));
    }
}

impl PassObserver for ForwardRecorder<'_> {
    fn over_angle(&mut self, piece: &AnglePiece, reason: Reason) -> Result<(), Error> {
        self.recorder.begins(piece.engine, piece.from.t, reason);
        self.recorder.orbit_piece(&mut OrbitPiece {
            orbit: &piece.run.orbit,
            begin: piece.from.t,
            end: piece.run.end,
            task: self.task,
        })
    }

    fn keep(&mut self, piece: AnglePiece) {
        let (from, until) = (piece.from.t, piece.to.t);
        self.recorder
            .keep(|| Trajectory::orbit(piece.run.orbit, from, until));
    }

    fn begin_in_time(&mut self, from: MotionState, curve: Option<&CurveProblem>, reason: Reason) {
        self.recorder.begins(Engine::Time, from.t, reason);
        self.curve = curve.map(|curve| curve.equation.clone());
        let again = curve.is_none() && from.t > 0.0 && is_dead_centre(self.task, from.angle.rest);
        self.recorded_dead_centre = again.then_some(from);
        if curve.is_some() && !self.task.turns_fully() {
            self.bounded_motion = BoundedMotion::new(self.task, from.angle);
        }
    }

    fn end_in_time(
        &mut self,
        motion: &Counted<'_>,
        last: &Step,
        settings: &Settings<'_>,
    ) -> Option<Step> {
        let shortened = self.shortened(motion, last, settings);
        let end = shortened.as_ref().unwrap_or(last).end.t;
        self.recorder.end_piece(end);
        shortened
    }
}
