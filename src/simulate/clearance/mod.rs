//! Motion with a loose joint: alternating flight and contact, integrated by the contact engine.

mod conclude;
mod contact_follower;
mod journal_record;
mod motion;
mod result;
mod step_forces;

use std::f64::consts::TAU;
use std::time::Instant;

pub use result::{Beyond, ClearanceSummary, ContactStatistics, Horizon, LooseFinal};

use super::closed_form;
use super::recorder::Recorder;
use super::result::Cost;
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::schedule::Schedule;
use super::second_run::other_method_tolerance;
use super::simulation::Simulation;
use super::stop::Why;
use crate::engine::contact::{self, ContactEnd, ContactSettings, Phase};
use crate::engine::time::{Finish, UNLIMITED_TIME};
use crate::error::Error;
use crate::mechanism::{LooseMechanism, LooseState};
use crate::scene::{Extent, Load, MotionKind};
use contact_follower::ContactFollower;
use journal_record::{JournalRecord, Tally};
use motion::{DRIVEN, FREE, Loose};

pub(super) fn run(task: &RunSetup<'_>, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
    let scene = task.scene.reduced();
    let Some(clearance) = scene.clearance else {
        return Err(Error::refused(
            "the scene has no clearance in a joint",
            "add [clearance]",
        ));
    };
    let mechanism = LooseMechanism::new(&scene, clearance)?;
    let start = mechanism.start(task.scene)?;
    match task.scene.motion.kind {
        MotionKind::ConstantSpeed => Loose::<DRIVEN>::new(task, &mechanism, start).all(rows),
        MotionKind::Free => Loose::<FREE>::new(task, &mechanism, start).all(rows),
    }
}

impl<'a, const N: usize> Loose<'a, N> {
    fn new(
        task: &'a RunSetup<'a>,
        mechanism: &'a LooseMechanism,
        start: LooseState,
    ) -> Loose<'a, N> {
        let geometry = &task.scene.geometry;
        let length = geometry.crank.min(100.0 * mechanism.clearance.radial);
        Loose {
            mechanism,
            task,
            start,
            length,
            angle: length / geometry.crank,
            pace: start.omega.abs().max(1.0),
            reach: geometry.crank + geometry.rod,
            t_end: match task.extent {
                Extent::Duration(duration) => duration,
                Extent::Revolutions(_) if N == FREE => UNLIMITED_TIME,
                Extent::Revolutions(_) => closed_form::duration(task.extent, start.omega),
            },
        }
    }

    fn all(&self, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
        let begun = Instant::now();
        let task = self.task;
        let schedule = match N {
            DRIVEN => {
                let every = task.scene.run.output_every;
                Schedule::at_speed(every, self.start.omega, self.t_end)
            }
            _ => task.schedule(),
        };
        let recorder = Recorder::new(task, rows, schedule);
        let tolerance = task.scene.run.tolerance;
        let (ended, mut seen) = self.integrate(Some(recorder), tolerance, 1.0, self.t_end);
        let last = seen.ends_at.unwrap_or(self.state(&ended.last));
        let record = seen.recorder.take().map(|mut recorder| {
            recorder.end_piece(last.t);
            recorder.finish(|| Some(self.row(&last, ended.phase)))
        });
        let record = record.transpose()?.unwrap_or_default();
        let wall_s = record.wall_s(begun);
        Ok(self.concluded(&ended, &seen, record, &last, wall_s))
    }

    /// Integrates at a tolerance, with a share of the longest steps of the phases, until a time, s.
    fn integrate<'b>(
        &'b self,
        recorder: Option<Recorder<'b>>,
        tolerance: f64,
        share: f64,
        t_end: f64,
    ) -> (ContactEnd<N>, ContactFollower<'b, N>) {
        let (task, start) = (self.task, &self.start);
        let turn = TAU / start.omega.abs().max(1.0);
        // Samples of the journal path in a turn, or in a shorter run; a long run halves their number again and again.
        let samples = 64.0;
        let width = (turn / samples).min((self.t_end / samples).max(1e-12));
        let mut follower = ContactFollower {
            model: self,
            dead_centres: task.dead_centres(),
            recorder,
            journal: JournalRecord::new(width),
            total: Tally::default(),
            separations: 0,
            energy: self.mechanism.energy(start).abs(),
            ends_at: None,
            peaks: None,
            phase: Phase::Flight,
            sticking: false,
        };
        let settings = ContactSettings {
            tolerance,
            share,
            t_end,
            limit: task.options.limit(),
        };
        let y = self.numbers(start, [0.0; 2]);
        let ended = contact::run(self, y, self.mechanism.is_linked(), settings, &mut |step| {
            follower.take(step)
        });
        (ended, follower)
    }

    /// Runs again at a tighter tolerance: last state, record and cost; none if the run does not reach `t_end`.
    fn second_run(&self, t_end: f64) -> Option<SecondRun> {
        let begun = Instant::now();
        // Steps of a contact are bounded by its phases, too: bounds that stay would err alike.
        let share = 0.5;
        let tolerance = other_method_tolerance(self.task.scene.run.tolerance);
        let (ended, follower) = self.integrate(None, tolerance, share, t_end);
        (ended.finish == Finish::AtEnd).then(|| SecondRun {
            last: self.state(&ended.last),
            record: follower.journal,
            cost: Cost {
                evaluations: ended.evaluations,
                wall_s: begun.elapsed().as_secs_f64(),
            },
        })
    }

    fn stopped(&self, ended: &ContactEnd<N>, last: &LooseState) -> Option<Why> {
        Some(match (ended.finish, self.task.extent) {
            (Finish::AtEnd, Extent::Revolutions(turns)) if last.t >= UNLIMITED_TIME => {
                Why::TurnsNeverComplete(turns)
            }
            (Finish::AtEnd | Finish::Stopped, _) => return None,
            (Finish::WorkLimit | Finish::WorkLimitAhead | Finish::TooManyTurns, _) => {
                self.task.limited()
            }
            (Finish::StepTooSmall | Finish::NoValue | Finish::NoStart, _) => self.too_small(last),
        })
    }

    /// Returns the reason for steps that became too small.
    fn too_small(&self, last: &LooseState) -> Why {
        if self.mechanism.jams(last) {
            return Why::JamLoose;
        }
        let load = self.without_value(last).cloned();
        load.map_or(Why::ContactTooStiff, |load| Why::NoValue {
            asked: self.crank(last),
            load: Some(load),
        })
    }

    /// Returns the load without a value at a state, or a few roundings after it.
    fn without_value(&self, last: &LooseState) -> Option<&Load> {
        let dt = 64.0 * f64::EPSILON * last.t.max(f64::MIN_POSITIVE);
        let after = LooseState {
            t: last.t + dt,
            theta: last.theta + last.omega * dt,
            x: last.x + last.v * dt,
            ..*last
        };
        let loads = self.task.equation().loads();
        let at = |s: &LooseState| loads.without_value(&self.mechanism.instant(s));
        at(last).or_else(|| at(&after))
    }
}

struct SecondRun {
    last: LooseState,
    record: JournalRecord,
    cost: Cost,
}
