//! A run that engines hand to one another as it is recorded.

use super::super::configuration_curve;
use super::super::configuration_curve::{CurveWatch, Phase};
use super::super::crank_watch::CrankWatch;
use super::super::passages::{Stretch, is_dead_centre};
use super::super::record::Record;
use super::super::row::RowSink;
use super::super::run_setup::RunSetup;
use super::arrived::{Arrived, Observer};
use crate::engine::Counted;
use crate::engine::angle::Driving;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::plan::Engine;
use crate::trajectory::Trajectory;

/// Notes of a run.
pub(super) struct Notes<'a> {
    task: &'a RunSetup<'a>,
    watch: CrankWatch<'a>,
    /// How the slider touched its guide at the end of a piece in time with friction.
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
    pub fn caught(&self, arrived: &Arrived) -> Option<String> {
        self.watch.swing?.why(arrived.now.t, |theta| theta)
    }

    /// The record, with the row of the end.
    pub fn finish(self, arrived: &Arrived) -> Result<Record, Error> {
        let Start { t, angle, speed } = arrived.now;
        let maker = &self.task.maker;
        self.watch
            .recorder
            .finish(|| match (&arrived.rubbed, maker.sliding) {
                (Some(rubbed), Some(sliding)) => configuration_curve::last_row(
                    self.task,
                    sliding.equation(),
                    self.touched,
                    &rubbed.last,
                ),
                _ => maker.row(t, angle, speed, None),
            })
    }
}

impl Observer for Notes<'_> {
    fn begins(&mut self, engine: Engine, from: f64, why: &'static str) {
        self.watch.recorder.begins(engine, from, why);
    }

    fn over_angle(&mut self, from: Start, until: f64, driving: Driving) -> Result<(), Error> {
        let recorder = &mut self.watch.recorder;
        recorder.stretch(&Stretch {
            orbit: &driving.orbit,
            begin: from.t,
            end: driving.end,
        })?;
        recorder.keep(|| Trajectory::orbit(driving.orbit, from.t, until));
        Ok(())
    }

    fn begin_in_time(&mut self, from: Start) {
        self.watch.passed = (from.t > 0.0 && is_dead_centre(self.task, from.angle.rest))
            .then_some((from.angle, from.speed));
    }

    fn step(&mut self, step: &Step) -> bool {
        self.watch.step(step)
    }

    fn with_friction(&mut self, run: &mut dyn FnMut(&mut dyn configuration_curve::Observer)) {
        let Some(sliding) = self.task.maker.sliding else {
            return;
        };
        let mut watch = CurveWatch {
            equation: sliding.equation(),
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
