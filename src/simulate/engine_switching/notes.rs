//! What is noted of a run while its pieces are computed.

use super::super::configuration_curve;
use super::super::configuration_curve::{CurveWatch, Phase};
use super::super::dense_rows::Spell;
use super::super::event_log::Log;
use super::super::in_time;
use super::super::passages::{Stretch, is_dead_centre};
use super::super::recorder::Recorder;
use super::super::row::RowSink;
use super::super::run_setup::RunSetup;
use super::arrived::{Arrived, Observer};
use crate::engine::Counted;
use crate::engine::angle::Driving;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::trajectory::Trajectory;

/// Notes of a run.
pub(super) struct Notes<'a> {
    task: &'a RunSetup<'a>,
    watch: Recorder<'a>,
    /// Pieces in time with friction.
    spells: Vec<Spell>,
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
            watch: in_time::watch(task, looked_at, rows),
            spells: Vec::new(),
            touched: Phase::Sticking,
        }
    }

    /// Why the run ended, if the crank is caught.
    pub fn caught(&self, arrived: &Arrived) -> Option<String> {
        self.watch.swing?.why(arrived.now.t, |theta| theta)
    }

    /// The log, with the row of the end, and the pieces in time with friction.
    pub fn finish(mut self, arrived: &Arrived) -> Result<(Log, Vec<Spell>), Error> {
        if let Some(error) = self.watch.seen.error.take() {
            return Err(error);
        }
        if let Some(rubbed) = &arrived.rubbed {
            let mut result = Ok(());
            let phase = self.touched;
            self.rubbing(&mut |watch| {
                watch.phase = phase;
                result = watch.write_last_row(&rubbed.last);
            });
            result?;
        } else if self.watch.rows.wants_rows() {
            let Start { t, angle, speed } = arrived.now;
            self.watch.write(t, angle, speed)?;
        }
        Ok((self.watch.log, self.spells))
    }
}

impl Notes<'_> {
    /// Lends rows and log to what watches a motion with friction.
    fn rubbing(&mut self, work: &mut dyn FnMut(&mut CurveWatch<'_>)) {
        let task = self.task;
        let Some(sliding) = task.maker.sliding else {
            return;
        };
        let log = std::mem::replace(&mut self.watch.log, Log::new(task));
        let mut watch = CurveWatch {
            equation: sliding.equation(),
            reactor: task.maker.reactor,
            rows: &mut *self.watch.rows,
            schedule: task.schedule(),
            start: task.start(),
            swing: self.watch.swing,
            log,
            recorded: None,
            spells: Vec::new(),
            error: None,
            phase: Phase::Sticking,
        };
        work(&mut watch);
        self.watch.log = watch.log;
        self.watch.swing = watch.swing;
    }
}

impl Observer for Notes<'_> {
    fn over_angle(&mut self, from: Start, until: f64, driving: Driving) -> Result<(), Error> {
        let Recorder {
            rows, maker, log, ..
        } = &mut self.watch;
        let stretch = Stretch {
            orbit: &driving.orbit,
            begin: from.t,
            end: driving.end,
        };
        if rows.wants_rows() {
            let mut write = |t: f64, angle, omega| rows.row(&maker.row(t, angle, omega, None));
            log.stretch(self.task, &stretch, Some(&mut write))?;
        } else {
            log.stretch(self.task, &stretch, None)?;
        }
        log.keep(|| Trajectory::orbit(driving.orbit, from.t, until));
        Ok(())
    }

    fn begin_in_time(&mut self, from: Start) {
        self.watch.seen.passed = (from.t > 0.0 && is_dead_centre(self.task, from.angle.rest))
            .then_some((from.angle, from.speed));
        self.watch.recorded = self.watch.log.pieces.is_some().then(Vec::new);
    }

    fn step(&mut self, step: &Step) -> bool {
        self.watch.step(step)
    }

    fn with_friction(&mut self, run: &mut dyn FnMut(&mut dyn configuration_curve::Observer)) {
        let mut spells = std::mem::take(&mut self.spells);
        let mut seen = None;
        self.rubbing(&mut |watch| {
            watch.recorded = watch.log.pieces.is_some().then(Vec::new);
            std::mem::swap(&mut watch.spells, &mut spells);
            run(watch);
            std::mem::swap(&mut watch.spells, &mut spells);
            seen = Some((watch.phase, watch.error.take(), watch.recorded.take()));
        });
        self.spells = spells;
        let Some((phase, error, recorded)) = seen else {
            return;
        };
        self.touched = phase;
        self.watch.seen.error = error;
        if let Some(steps) = recorded.filter(|steps| !steps.is_empty()) {
            let end = steps[steps.len() - 1].end.t;
            self.watch.log.keep(|| Trajectory::from_steps(steps, end));
        }
    }

    fn end_in_time(
        &mut self,
        motion: &Counted<'_>,
        last: &Step,
        settings: &Settings,
    ) -> Option<Step> {
        let watch = &mut self.watch;
        let shortened = watch
            .seen
            .ends_at
            .map(|t| in_time::shortened(motion, last, t, settings, watch));
        let end = shortened.as_ref().unwrap_or(last).end.t;
        if let Some(steps) = watch.recorded.take().filter(|steps| !steps.is_empty()) {
            watch.log.keep(|| Trajectory::from_steps(steps, end));
        }
        shortened
    }
}
