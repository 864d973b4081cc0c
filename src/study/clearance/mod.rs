//! Motion with a loose joint: flight and contact, by the contact engine.

mod follow;
mod motion;
mod record;
mod result;

use std::f64::consts::TAU;
use std::time::Instant;

pub use record::ContactStatistics;
pub use result::{Beyond, ClearanceSummary, Horizon, LooseFinal};

use super::in_time::FAR;
use super::row::{NoRows, RowSink};
use super::schedule::Schedule;
use super::simulate::Simulation;
use super::summary::{Cost, ErrorEstimate, Event, Final, Solved, Summary};
use super::task::Task;
use super::watch::radians;
use super::closed_form;
use crate::engine::contact::{self, Ended, Finish, Phase, Settings, Stretch};
use crate::error::Error;
use crate::mechanism::{LooseMechanism, LooseState};
use crate::numeric::angle::Angle;
use crate::scene::{ContactLaw, Every, Extent, Joint, MotionKind};
use crate::trajectory::Trajectory;
use follow::{Asked, Follow, Seen, phi};
use motion::{DRIVEN, FREE, Loose};
use record::Record;

/// The second run of the horizon is this much tighter.
const TIGHTER: f64 = 50.0;
/// What is stated is larger than the distance of the two runs by this, for the error of the second.
const MARGIN: f64 = 1.5;
/// Two journals at the same place: this part of the clearance apart.
const SAME_PLACE: f64 = 0.01;
/// Samples of the journal's path in a turn, while there are few enough turns.
const SAMPLES_IN_A_TURN: f64 = 256.0;

/// Runs a scene with a loose joint.
pub(super) fn run(
    task: &Task<'_>,
    rows: &mut dyn RowSink,
    record: bool,
) -> Result<Simulation, Error> {
    if task.options.reactions {
        return Err(Error::refused(
            "joint forces of a mechanism with clearance are not part of this version",
            "leave out --reactions; the rows have the force in the loose joint",
        ));
    }
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
        MotionKind::ConstantSpeed => Run::<DRIVEN>::new(task, &mechanism, start)?.all(rows, record),
        MotionKind::Free => Run::<FREE>::new(task, &mechanism, start)?.all(rows, record),
    }
}

struct Run<'a, const N: usize> {
    task: &'a Task<'a>,
    mechanism: &'a LooseMechanism,
    start: LooseState,
    t_end: f64,
}

impl<'a, const N: usize> Run<'a, N> {
    fn new(
        task: &'a Task<'a>,
        mechanism: &'a LooseMechanism,
        start: LooseState,
    ) -> Result<Run<'a, N>, Error> {
        let t_end = match task.extent {
            Extent::Duration(duration) => duration,
            Extent::Revolutions(_) if N == FREE => FAR,
            Extent::Revolutions(_) => closed_form::duration(task.extent, start.omega)?,
        };
        Ok(Run {
            task,
            mechanism,
            start,
            t_end,
        })
    }

    fn all(&self, rows: &mut dyn RowSink, record: bool) -> Result<Simulation, Error> {
        let begun = Instant::now();
        let corners = |t: f64| self.task.equation().loads().next_corner(t);
        let model = self.model(&corners);
        let asked = self.asked(record);
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
        let trajectory = self.trajectory(&seen, last.t, record);
        let solved = self.solved(&model, &ended, seen, last, tighter, wall_s, stopped);
        Ok(Simulation {
            summary: Summary::new(self.task, solved),
            trajectory,
        })
    }

    fn model<'b>(&self, corners: &'b dyn Fn(f64) -> f64) -> Loose<'b, N>
    where
        'a: 'b,
    {
        let geometry = &self.task.scene.geometry;
        let length = geometry.crank.min(100.0 * self.mechanism.clearance().radial);
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

    fn asked(&self, record: bool) -> Asked<'a> {
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
            turn_limit: match task.extent {
                Extent::Revolutions(turns) => Some(radians(turns)),
                Extent::Duration(_) => None,
            },
            events_kept: task.options.events_kept,
            keep_steps: record,
        }
    }

    /// The same run at a tighter tolerance: its end, its record and its cost. None if it does not get there.
    fn tighter(&self, model: &Loose<'_, N>, t_end: f64) -> Option<Tighter> {
        let begun = Instant::now();
        let asked = Asked {
            turn_limit: None,
            keep_steps: false,
            events_kept: 0,
            ..self.asked(false)
        };
        let mut follow = Follow {
            model,
            asked: &asked,
            rows: &mut NoRows,
            seen: self.seen(),
        };
        let tolerance = (self.task.scene.run.tolerance / TIGHTER).max(1e-15);
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

    fn stopped(&self, ended: &Ended<N>, last: &LooseState) -> Option<String> {
        let place = format!(
            "at t = {} s, theta = {} rad, omega = {} rad/s",
            last.t,
            self.angle(last).radians(),
            last.omega
        );
        match (ended.finish, self.task.extent) {
            (Finish::AtEnd, Extent::Revolutions(turns)) if last.t >= FAR => Some(format!(
                "the crank does not complete {turns} turns: stopped {place}; give a duration instead"
            )),
            (Finish::AtEnd | Finish::Stopped, _) => None,
            (Finish::WorkLimit, _) => Some(format!(
                "the work limit of evaluations is reached: stopped {place}; raise --max-evaluations, shorten the run or loosen the tolerance"
            )),
            (Finish::StepTooSmall, _) => Some(format!(
                "a load has no finite value, or the contact is too stiff for steps in double precision: stopped {place}"
            )),
        }
    }

    fn angle(&self, s: &LooseState) -> Angle {
        Angle {
            turns: self.task.start().turns,
            rest: s.theta,
        }
    }

    fn trajectory(&self, seen: &Seen, t_end: f64, record: bool) -> Option<Trajectory> {
        if N == DRIVEN {
            return Some(Trajectory::uniform(self.task.start(), self.start.omega, t_end));
        }
        record.then(|| Trajectory::from_steps(seen.steps.clone(), t_end))
    }

    #[allow(clippy::too_many_arguments)]
    fn solved(
        &self,
        model: &Loose<'_, N>,
        ended: &Ended<N>,
        seen: Seen,
        last: LooseState,
        tighter: Option<Tighter>,
        wall_s: f64,
        stopped: Option<String>,
    ) -> Solved {
        let [work, lost] = model.work(&ended.last);
        let at_end = model.state(&ended.last);
        let gained = self.mechanism.energy(&at_end) - self.mechanism.energy(&self.start);
        let horizon = tighter.as_ref().map(|t| self.horizon(&seen, t, &last));
        let same = horizon.is_some_and(|h| h.whole_run);
        let against = tighter.as_ref().filter(|_| same).map(|t| &t.last);
        let error = |value: fn(&LooseState) -> f64, size: f64| {
            against.map(|t| MARGIN * (value(t) - value(&last)).abs() + 8.0 * f64::EPSILON * size)
        };
        let reach = model.reach;
        let summary = self.summary(&seen, [work, lost], &last, |value| error(value, reach), horizon);
        let mut warnings = self.warnings(&summary, &seen, tighter.is_some() || stopped.is_some());
        let (events, events_total) = self.events(&seen, last.t);
        let theta = self.angle(&last).radians();
        let estimate = match N {
            DRIVEN => Some((2.0 * f64::EPSILON * theta.abs(), 0.0)),
            _ => error(|s| s.theta, 1.0 + theta.abs())
                .zip(error(|s| s.omega, 1.0 + last.omega.abs())),
        };
        if N == FREE && estimate.is_none() && self.task.options.estimate && stopped.is_none() {
            warnings.push("the crank at the end lies beyond the reproducible horizon: its error is not stated".to_owned());
        }
        Solved {
            last: Final {
                t_s: last.t,
                theta_rad: theta,
                omega_rad_per_s: last.omega,
            },
            turned: last.theta - self.start.theta,
            error_estimate: estimate.map(|(theta_rad, omega_rad_per_s)| ErrorEstimate {
                theta_rad,
                omega_rad_per_s,
            }),
            energy: (gained - work + lost, seen.energy),
            evaluations: ended.evaluations,
            steps: ended.steps,
            wall_s,
            estimate_cost: tighter.map(|t| t.cost),
            speed: seen.speed,
            events,
            events_total,
            warnings,
            stopped,
            clearance: Some(summary),
            ..Solved::default()
        }
    }

    /// Until when the journal's path is that of the tighter run, and what both runs say of the time after.
    fn horizon(&self, seen: &Seen, tighter: &Tighter, end: &LooseState) -> Horizon {
        let distance = SAME_PLACE * self.mechanism.clearance().radial;
        let parted = seen.record.agrees_until(&tighter.record, distance);
        let t = parted.unwrap_or(end.t);
        let statistics = |record: &Record| {
            let (tally, from) = record.since(t);
            ContactStatistics::new(&tally, from, end.t)
        };
        Horizon {
            t_s: t,
            // The mean speed will do for a number of turns.
            revolutions: match end.t > 0.0 {
                true => ((end.theta - self.start.theta) * t / end.t).abs() / TAU,
                false => 0.0,
            },
            whole_run: parted.is_none(),
            beyond: parted.map(|_| Beyond {
                run: statistics(&seen.record),
                tighter: statistics(&tighter.record),
            }),
        }
    }

    fn summary(
        &self,
        seen: &Seen,
        [work, lost]: [f64; 2],
        last: &LooseState,
        error: impl Fn(fn(&LooseState) -> f64) -> Option<f64>,
        horizon: Option<Horizon>,
    ) -> ClearanceSummary {
        let clearance = self.mechanism.clearance();
        let whole = ContactStatistics::new(&seen.total, 0.0, last.t);
        let linked = self.linked();
        ClearanceSummary {
            joint: match clearance.joint {
                Joint::CrankPin => "crank-pin",
                Joint::WristPin => "wrist-pin",
            },
            contact_law: clearance.law.name(),
            radial_m: clearance.radial,
            stiffness_n_per_m_1_5: (!linked).then(|| self.mechanism.force().stiffness),
            impacts: whole.impacts,
            separations: seen.separations,
            contact_share: whole.contact_share,
            drawn_share: (linked && last.t > 0.0).then(|| seen.total.drawn / last.t),
            force_peak_n: whole.force_peak_n,
            force_mean_n: whole.force_mean_n,
            penetration_peak_m: seen.total.deepest,
            dissipated_j: lost,
            work_j: work,
            last: LooseFinal {
                x_m: last.x,
                v_m_per_s: last.v,
                phi_rad: phi(last.psi, self.task.scene.geometry.branch.sign()),
                error_x_m: error(|s| s.x),
                error_phi_rad: error(|s| s.psi),
            },
            horizon,
        }
    }

    fn warnings(&self, summary: &ClearanceSummary, seen: &Seen, compared: bool) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.task.options.estimate && !compared {
            warnings.push("the reproducible horizon is not known: the second, tighter run did not finish".to_owned());
        }
        if let Some(horizon) = summary.horizon.filter(|h| !h.whole_run) {
            warnings.push(format!(
                "the motion is reproducible up to t = {:.6} s ({:.2} turns); beyond it only its statistics mean something",
                horizon.t_s, horizon.revolutions
            ));
        }
        let deepest = seen.total.deepest;
        if deepest > summary.radial_m {
            warnings.push(format!(
                "the penetration reaches {deepest:.1e} m, more than the clearance: Hertz's law for a small spot of contact does not describe it"
            ));
        }
        if let Some(drawn) = summary.drawn_share.filter(|share| *share > 0.0) {
            warnings.push(format!(
                "the massless link is drawn for {:.1} % of the time: there a journal would leave the bearing's wall",
                100.0 * drawn
            ));
        }
        warnings
    }

    /// Impacts, separations and dead centres in the order of time.
    fn events(&self, seen: &Seen, end: f64) -> (Vec<Event>, u64) {
        let (mut events, mut total) = (seen.events.clone(), seen.events_total);
        if N == DRIVEN {
            let (passages, count) =
                closed_form::events(self.task, self.task.start(), self.start.omega, end);
            events.extend(passages);
            total += count;
            events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
            events.truncate(self.task.options.events_kept);
        }
        (events, total)
    }
}

/// The run at a tighter tolerance.
struct Tighter {
    last: LooseState,
    record: Record,
    cost: Cost,
}
