//! A run as it is recorded, whatever engine computes it.

use std::borrow::Cow;

use super::super::bounded_motion::Swing;
use super::super::configuration_curve::{self, CurveWatch, Phase};
use super::super::crank_watch::CrankWatch;
use super::super::passages::{Stretch, is_dead_centre};
use super::super::record::Record;
use super::super::row::RowSink;
use super::super::run_setup::RunSetup;
use super::super::stop::Why;
use super::arrived::{Arrived, Driven, Sink};
use super::engine_loop::Course;
use crate::engine::Counted;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::mechanism::CurveEquation;
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::trajectory::Trajectory;

/// Notes of a run.
pub(super) struct Notes<'a> {
    task: &'a RunSetup<'a>,
    watch: CrankWatch<'a>,
    /// How the slider touched its guide at the end of a piece along the configuration curve.
    touched: Phase,
}

impl<'a> Notes<'a> {
    pub fn new(
        task: &'a RunSetup<'a>,
        looked_at: &'a Counted<'a>,
        rows: &'a mut dyn RowSink,
    ) -> Notes<'a> {
        Notes {
            task,
            watch: CrankWatch::new(task, looked_at, rows),
            touched: Phase::Sticking,
        }
    }

    /// Why the run ended, if the crank is caught.
    pub fn caught(&self, course: &Course<'_>) -> Option<Why> {
        let curve = course.curve.get().map(|on| on.equation.curve());
        let crank = |at| curve.map_or(at, |curve| curve.crank_angle(at));
        self.watch.swing?.why(crank)
    }

    /// The record, with the row of the end.
    pub fn finish(self, course: &Course<'_>, arrived: &Arrived) -> Result<Record, Error> {
        let Start { t, angle, speed } = arrived.now;
        let last = || match (&arrived.on_curve, course.curve.get()) {
            (Some(followed), Some(on)) => {
                configuration_curve::last_row(self.task, &on.equation, self.touched, &followed.last)
            }
            _ => self.task.maker.row(t, angle, speed, None),
        };
        self.watch.recorder.finish(|| Some(last()))
    }
}

impl Sink for Notes<'_> {
    fn begins(&mut self, engine: Engine, from: f64, why: Cow<'static, str>) {
        self.watch.recorder.begins(engine, from, why);
    }

    fn over_angle(&mut self, driven: &Driven) -> Result<(), Error> {
        self.watch.recorder.stretch(&mut Stretch {
            orbit: &driven.driving.orbit,
            begin: driven.from.t,
            end: driven.driving.end,
            task: self.task,
        })
    }

    fn keep(&mut self, driven: Driven) {
        let (from, until) = (driven.from.t, driven.to.t);
        let recorder = &mut self.watch.recorder;
        recorder.keep(|| Trajectory::orbit(driven.driving.orbit, from, until));
    }

    fn begin_in_time(&mut self, from: Start) {
        self.watch.passed = (from.t > 0.0 && is_dead_centre(self.task, from.angle.rest))
            .then_some((from.angle, from.speed));
    }

    fn step(&mut self, step: &Step) -> bool {
        self.watch.step(step)
    }

    fn along_curve(
        &mut self,
        equation: &CurveEquation,
        start: Angle,
        run: &mut dyn FnMut(&mut dyn configuration_curve::Observer),
    ) {
        if !self.task.turns_fully() {
            self.watch.swing = Swing::new(self.task, start);
        }
        let mut watch = CurveWatch {
            equation,
            recorder: &mut self.watch.recorder,
            swing: self.watch.swing,
            phase: Phase::Sticking,
        };
        run(&mut watch);
        (self.touched, self.watch.swing) = (watch.phase, watch.swing);
        self.watch.recorder.end_piece(f64::INFINITY);
    }

    fn end_in_time(
        &mut self,
        motion: &Counted<'_>,
        last: &Step,
        settings: &Settings,
    ) -> Option<Step> {
        let shortened = self
            .watch
            .ends_at
            .map(|_| self.watch.shortened(motion, last, settings));
        let end = shortened.as_ref().unwrap_or(last).end.t;
        self.watch.recorder.end_piece(end);
        shortened
    }
}
