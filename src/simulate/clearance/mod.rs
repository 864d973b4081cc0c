//! Motion with a loose joint: flight and contact, by the contact engine.

mod conclude;
mod follow;
mod motion;
mod peak;
mod press;
mod record;
mod result;

use std::f64::consts::TAU;
use std::time::Instant;

pub use record::ContactStatistics;
pub use result::{Beyond, ClearanceSummary, Horizon, LooseFinal};

use super::closed_form;
use super::error_estimate::{TIGHTER, TIGHTEST};
use super::result::Cost;
use super::row::{NoRows, RowSink};
use super::run_setup::RunSetup;
use super::schedule::Schedule;
use super::simulation::Simulation;
use super::stop::Why;
use crate::engine::contact::{self, Ended, Finish, Phase, Settings, Stretch};
use crate::engine::time::FAR;
use crate::error::Error;
use crate::mechanism::{LooseMechanism, LooseState};
use crate::numeric::angle::Angle;
use crate::scene::{ContactLaw, Every, Extent, Instant as State, Load, MotionKind};
use follow::{Asked, Follow, Seen};
use motion::{DRIVEN, FREE, Loose};
use record::Record;

/// Samples of the journal's path in a turn, while there are few enough turns.
const SAMPLES_IN_A_TURN: f64 = 64.0;

/// Runs a scene with a loose joint.
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
        MotionKind::ConstantSpeed => Run::<DRIVEN>::new(task, &mechanism, start)?.all(rows),
        MotionKind::Free => Run::<FREE>::new(task, &mechanism, start)?.all(rows),
    }
}

struct Run<'a, const N: usize> {
    task: &'a RunSetup<'a>,
    mechanism: &'a LooseMechanism,
    start: LooseState,
    t_end: f64,
}

impl<'a, const N: usize> Run<'a, N> {
    fn new(
        task: &'a RunSetup<'a>,
        mechanism: &'a LooseMechanism,
        start: LooseState,
    ) -> Result<Run<'a, N>, Error> {
        let t_end = match task.extent {
            Extent::Duration(duration) => duration,
            Extent::Revolutions(_) if N == FREE => FAR,
            Extent::Revolutions(_) => closed_form::duration(task.extent, start.omega),
        };
        Ok(Run {
            task,
            mechanism,
            start,
            t_end,
        })
    }

    fn all(&self, rows: &mut dyn RowSink) -> Result<Simulation, Error> {
        let begun = Instant::now();
        let corners = |t: f64| self.task.equation().loads().next_corner(t);
        let model = self.model(&corners);
        let asked = self.asked();
        let mut follow = Follow {
            model: &model,
            asked: &asked,
            rows,
            seen: self.seen(),
        };
        let tolerance = self.task.scene.run.tolerance;
        let ended = self.go(&model, tolerance, self.t_end, &mut |s| follow.take(s));
        if let Some(error) = follow.seen.error.take() {
            return Err(error);
        }
        let last = follow.seen.ends_at.unwrap_or(model.state(&ended.last));
        follow.write_row(&last, ended.phase)?;
        let seen = follow.seen;
        let wall_s = (begun.elapsed() - seen.row_time).as_secs_f64();
        let stopped = self.stopped(&ended, &last);
        let tighter = (self.task.options.estimate && stopped.is_none())
            .then(|| self.tighter(&model, last.t))
            .flatten();
        Ok(self.concluded(&model, &ended, seen, last, tighter, wall_s, stopped))
    }

    fn model<'b>(&self, corners: &'b dyn Fn(f64) -> f64) -> Loose<'b, N>
    where
        'a: 'b,
    {
        let geometry = &self.task.scene.geometry;
        let length = geometry
            .crank
            .min(100.0 * self.mechanism.clearance().radial);
        Loose {
            mechanism: self.mechanism,
            start: (self.start.theta, self.start.omega),
            length,
            angle: length / geometry.crank,
            pace: self.start.omega.abs().max(1.0),
            reach: geometry.crank + geometry.rod,
            corners,
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
        follower: &mut dyn FnMut(&mut Stretch<'_, N>) -> bool,
    ) -> Ended<N> {
        let settings = Settings {
            tolerance,
            t_end,
            max_evaluations: self.task.options.max_evaluations,
        };
        let start = model.numbers(&self.start, [0.0; 2]);
        contact::run(model, start, self.linked(), settings, follower)
    }

    fn seen(&self) -> Seen {
        let turn = TAU / self.start.omega.abs().max(1.0);
        let width = (turn / SAMPLES_IN_A_TURN).min((self.t_end / SAMPLES_IN_A_TURN).max(1e-12));
        let energy = self.mechanism.energy(&self.start).abs();
        Seen::new(width, self.start.omega, energy, Phase::Flight)
    }

    fn asked(&self) -> Asked<'a> {
        let task = self.task;
        let speed = self.start.omega;
        let (every, extent) = match (task.scene.run.output_every, N) {
            // At constant speed angles are times.
            (Some(Every::Angle(step)), DRIVEN) if speed != 0.0 => (
                Some(Every::Time(step / speed.abs())),
                Extent::Duration(self.t_end),
            ),
            (every, DRIVEN) => (every, Extent::Duration(self.t_end)),
            (every, _) => (every, task.extent),
        };
        Asked {
            maker: &task.maker,
            schedule: Schedule::new(every, extent),
            branch: task.scene.geometry.branch.sign(),
            turns: task.start().turns,
            start: self.start.theta,
            watched: task.limits.dead_centres.iter().map(|dc| dc.theta).collect(),
            turn_limit: task.extent.angle(),
            events_kept: task.options.events_kept,
            keep_steps: self.task.kept > 0,
            sampled: task.options.estimate,
            forces: task.options.reactions,
        }
    }

    /// A second run at a tighter tolerance: its end, its record and its cost. None if it does not get there.
    fn tighter(&self, model: &Loose<'_, N>, t_end: f64) -> Option<Tighter> {
        let begun = Instant::now();
        let asked = Asked {
            turn_limit: None,
            keep_steps: false,
            forces: false,
            events_kept: 0,
            ..self.asked()
        };
        let mut follow = Follow {
            model,
            asked: &asked,
            rows: &mut NoRows,
            seen: self.seen(),
        };
        let tolerance = (self.task.scene.run.tolerance / TIGHTER).max(TIGHTEST);
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

    fn stopped(&self, ended: &Ended<N>, last: &LooseState) -> Option<Why> {
        match (ended.finish, self.task.extent) {
            (Finish::AtEnd, Extent::Revolutions(turns)) if last.t >= FAR => Some(Why::Turns(turns)),
            (Finish::AtEnd | Finish::Stopped | Finish::Broken, _) => None,
            (Finish::StepTooSmall, _) if self.mechanism.jams(last) => Some(Why::JamLoose),
            (Finish::WorkLimit, _) => Some(Why::WorkLimit),
            (Finish::StepTooSmall, _) => Some(match self.without_value(last) {
                Some(load) => Why::NoValueLoose(load.clone()),
                None => Why::ContactTooStiff,
            }),
        }
    }

    /// A load that ends at a state, or a few roundings after it.
    fn without_value(&self, last: &LooseState) -> Option<&Load> {
        let dt = 64.0 * f64::EPSILON * last.t.max(f64::MIN_POSITIVE);
        let at = |dt: f64| State {
            t: last.t + dt,
            theta: self.angle(last).radians() + last.omega * dt,
            omega: last.omega,
            x: last.x + last.v * dt,
            v: last.v,
        };
        let loads = self.task.equation().loads();
        let found = loads.without_value(&at(0.0));
        found.or_else(|| loads.without_value(&at(dt)))
    }

    fn angle(&self, s: &LooseState) -> Angle {
        Angle {
            turns: self.task.start().turns,
            rest: s.theta,
        }
    }
}

/// The run at a tighter tolerance.
struct Tighter {
    last: LooseState,
    record: Record,
    cost: Cost,
}
