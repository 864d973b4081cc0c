//! Motion with a loose joint: alternating flight and contact, integrated by the contact engine.

mod conclude;
mod contact_follower;
mod journal_record;
mod motion;
mod peak;
mod press;
mod result;

use std::f64::consts::TAU;
use std::time::Instant;

pub use result::{Beyond, ClearanceSummary, ContactStatistics, Horizon, LooseFinal};

use super::closed_form;
use super::recorder::{Record, Recorder};
use super::result::Cost;
use super::row::RowSink;
use super::run_setup::RunSetup;
use super::schedule::Schedule;
use super::second_run::TIGHTER;
use super::simulation::Simulation;
use super::stop::Why;
use crate::engine::contact::{self, AcceptedStep, ContactEnd, Finish, Settings};
use crate::engine::time::{FAR, Start};
use crate::error::Error;
use crate::mechanism::{LooseMechanism, LooseState};
use crate::scene::{ContactLaw, Extent, Instant as State, Load, MotionKind};
use contact_follower::{ContactFollower, ContactHistory};
use journal_record::JournalRecord;
use motion::{DRIVEN, FREE, Loose};

/// Number of samples of the journal path in a turn; halved again and again in a long run.
const SAMPLES_IN_A_TURN: f64 = 64.0;

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
        MotionKind::ConstantSpeed => LooseRun::<DRIVEN>::new(task, &mechanism, start).all(rows),
        MotionKind::Free => LooseRun::<FREE>::new(task, &mechanism, start).all(rows),
    }
}

struct LooseRun<'a, const N: usize> {
    task: &'a RunSetup<'a>,
    mechanism: &'a LooseMechanism,
    start: LooseState,
    t_end: f64,
}

impl<'a, const N: usize> LooseRun<'a, N> {
    fn new(
        task: &'a RunSetup<'a>,
        mechanism: &'a LooseMechanism,
        start: LooseState,
    ) -> LooseRun<'a, N> {
        let t_end = match task.extent {
            Extent::Duration(duration) => duration,
            Extent::Revolutions(_) if N == FREE => FAR,
            Extent::Revolutions(_) => closed_form::duration(task.extent, start.omega),
        };
        LooseRun {
            task,
            mechanism,
            start,
            t_end,
        }
    }

    fn all(&self, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
        let begun = Instant::now();
        let model = self.model();
        let every = self.task.scene.run.output_every;
        let schedule = match N {
            DRIVEN => Schedule::at_speed(every, self.start.omega, self.t_end),
            _ => self.task.schedule(),
        };
        let recorder = Recorder::new(self.task, rows, schedule);
        let mut follow = self.follow(&model, Some(recorder));
        let tolerance = self.task.scene.run.tolerance;
        let ended = self.go(&model, tolerance, self.t_end, &mut |s| follow.take(s));
        let ContactFollower { recorder, seen, .. } = follow;
        let last = seen.ends_at.unwrap_or(model.state(&ended.last));
        let record = match recorder {
            Some(mut recorder) => {
                recorder.end_piece(last.t);
                recorder.finish(|| Some(model.row(&last, ended.phase)))?
            }
            None => Record::default(),
        };
        let wall_s = record.wall_s(begun);
        Ok(self.concluded(&model, &ended, &seen, record, &last, wall_s))
    }

    fn follow<'b>(
        &'b self,
        model: &'b Loose<'b, N>,
        recorder: Option<Recorder<'b>>,
    ) -> ContactFollower<'b, N> {
        let turn = TAU / self.start.omega.abs().max(1.0);
        let width = (turn / SAMPLES_IN_A_TURN).min((self.t_end / SAMPLES_IN_A_TURN).max(1e-12));
        ContactFollower {
            model,
            dead_centres: self.task.dead_centres(),
            recorder,
            seen: ContactHistory::new(width, self.mechanism.energy(&self.start).abs()),
        }
    }

    fn model(&self) -> Loose<'a, N> {
        let geometry = &self.task.scene.geometry;
        let length = geometry
            .crank
            .min(100.0 * self.mechanism.clearance().radial);
        Loose {
            mechanism: self.mechanism,
            task: self.task,
            start: (self.start.theta, self.start.omega),
            length,
            angle: length / geometry.crank,
            pace: self.start.omega.abs().max(1.0),
            reach: geometry.crank + geometry.rod,
        }
    }

    fn linked(&self) -> bool {
        self.mechanism.clearance().law == ContactLaw::MasslessLink
    }

    fn go(
        &self,
        model: &Loose<'_, N>,
        tolerance: f64,
        t_end: f64,
        follower: &mut dyn FnMut(&mut AcceptedStep<'_, N>) -> bool,
    ) -> ContactEnd<N> {
        let settings = Settings {
            tolerance,
            t_end,
            limit: self.task.options.limit(),
        };
        let start = model.numbers(&self.start, [0.0; 2]);
        contact::run(model, start, self.linked(), settings, follower)
    }

    /// Runs again at a tighter tolerance: last state, record and cost; none if the run does not reach `t_end`.
    fn tighter(&self, model: &Loose<'_, N>, t_end: f64) -> Option<Tighter> {
        let begun = Instant::now();
        let mut follow = self.follow(model, None);
        let tolerance = (self.task.scene.run.tolerance / TIGHTER).max(4.0 * f64::EPSILON);
        let ended = self.go(model, tolerance, t_end, &mut |s| follow.take(s));
        (ended.finish == Finish::AtEnd).then(|| Tighter {
            last: model.state(&ended.last),
            record: follow.seen.record,
            cost: Cost {
                evaluations: ended.evaluations,
                wall_s: begun.elapsed().as_secs_f64(),
            },
        })
    }

    fn stopped(&self, ended: &ContactEnd<N>, last: &LooseState) -> Option<Why> {
        match ended.finish {
            Finish::AtEnd => match self.task.extent {
                Extent::Revolutions(turns) if last.t >= FAR => Some(Why::TurnsNeverComplete(turns)),
                _ => None,
            },
            Finish::Stopped | Finish::Broken => None,
            Finish::WorkLimit => Some(self.task.limited()),
            Finish::StepTooSmall => Some(self.too_small(last)),
        }
    }

    /// Returns the reason for steps that became too small.
    fn too_small(&self, last: &LooseState) -> Why {
        if self.mechanism.jams(last) {
            return Why::JamLoose;
        }
        let load = self.without_value(last).cloned();
        load.map_or(Why::ContactTooStiff, |load| Why::NoValue {
            asked: Start {
                t: last.t,
                angle: self.task.angle(last.theta),
                speed: last.omega,
            },
            load: Some(load),
        })
    }

    /// Returns the load without a value at a state, or a few roundings after it.
    fn without_value(&self, last: &LooseState) -> Option<&Load> {
        let dt = 64.0 * f64::EPSILON * last.t.max(f64::MIN_POSITIVE);
        let at = |dt: f64| State {
            t: last.t + dt,
            theta: self.task.angle(last.theta).radians() + last.omega * dt,
            omega: last.omega,
            x: last.x + last.v * dt,
            v: last.v,
        };
        let loads = self.task.equation().loads();
        let found = loads.without_value(&at(0.0));
        found.or_else(|| loads.without_value(&at(dt)))
    }
}

struct Tighter {
    last: LooseState,
    record: JournalRecord,
    cost: Cost,
}
