//! Follower of a run with a loose joint: rows, events and contact statistics, step by step.

use super::super::recorder::Recorder;
use super::super::result::{Event, FORCES, Peak};
use super::super::row::Row;
use super::super::row_writer::RowSource;
use super::journal_record::{JournalRecord, Tally};
use super::motion::{FREE, Loose};
use crate::engine::contact::{AcceptedStep, Phase};
use crate::engine::events::{self, Crossing};
use crate::engine::step::{Node, Step};
use crate::engine::time::MotionState;
use crate::mechanism::LooseState;

/// Observer of the accepted steps of a run, with what it has seen up to now.
pub(super) struct ContactFollower<'a, const N: usize> {
    pub model: &'a Loose<'a, N>,
    /// Dead centres, rad in [0, 2π).
    pub dead_centres: Vec<f64>,
    /// Recorder of rows and events; none for the run of comparison.
    pub recorder: Option<Recorder<'a>>,
    pub journal: JournalRecord,
    pub total: Tally,
    pub separations: u64,
    /// Largest absolute energy up to now, J: of the start, and of work minus loss.
    pub energy: f64,
    pub ends_at: Option<LooseState>,
    pub peaks: Option<[Peak; FORCES]>,
    pub phase: Phase,
    pub sticking: bool,
}

impl<const N: usize> ContactFollower<'_, N> {
    /// Follows an accepted step; true ends the run.
    pub fn take(&mut self, accepted: &mut AcceptedStep<'_, N>) -> bool {
        self.follow_phase(accepted);
        self.follow_guide(accepted);
        if N == FREE {
            self.follow_crank(accepted);
        }
        self.follow_contact(accepted);
        self.follow_forces(accepted);
        while self.model.task.options.estimate && self.journal.due() <= accepted.end[0] {
            let y = accepted.at(self.journal.due());
            let journal = self.model.mechanism.journal(&self.model.state(&y));
            self.journal.sample(journal);
        }
        let [work, lost] = self.model.work(&accepted.end);
        self.energy = self.energy.max((work - lost).abs());
        let mut part = InAccepted {
            until: self.until(accepted),
            accepted,
            model: self.model,
        };
        let recorder = self.recorder.as_mut();
        let fails = recorder.is_some_and(|recorder| recorder.rows(&mut part));
        fails || self.ends_at.is_some()
    }

    /// Returns the last time (s) of a step that belongs to the run.
    pub(super) fn until(&self, accepted: &AcceptedStep<'_, N>) -> f64 {
        self.ends_at.map_or(accepted.end[0], |s| s.t)
    }

    fn event(&mut self, kind: &'static str, t: f64, theta: f64, speed: f64) {
        let angle = self.model.task.angle(theta);
        if let Some(recorder) = &mut self.recorder {
            recorder.event(Event::new(kind, MotionState { t, angle, speed }));
        }
    }

    fn follow_phase(&mut self, accepted: &AcceptedStep<'_, N>) {
        let s = self.model.state(&accepted.start);
        let before = std::mem::replace(&mut self.phase, accepted.phase);
        let kind = match (before, accepted.phase) {
            (Phase::Flight, Phase::Contact { .. }) => {
                let one = Tally {
                    impacts: 1,
                    ..Tally::default()
                };
                self.total.add(&one);
                self.journal.tally(s.t, &one);
                "impact"
            }
            (Phase::Contact { .. } | Phase::Release { .. }, Phase::Flight) => {
                self.separations += 1;
                "separation"
            }
            _ => return,
        };
        self.event(kind, s.t, s.theta, s.omega);
    }

    /// Records where friction holds and releases the slider; a held slider has exactly zero velocity.
    fn follow_guide(&mut self, accepted: &AcceptedStep<'_, N>) {
        let [from, to] = [accepted.start, accepted.end].map(|y| self.model.state(&y));
        let sticking = self.model.mechanism.rubs() && from.v == 0.0 && to.v == 0.0;
        if sticking != self.sticking {
            let kind = if sticking { "stick" } else { "slip" };
            self.event(kind, from.t, from.theta, from.omega);
        }
        self.sticking = sticking;
    }

    /// Records dead centres, turning points, extreme speeds and the turn limit of a free crank.
    fn follow_crank(&mut self, accepted: &mut AcceptedStep<'_, N>) {
        let node = |s: LooseState, alpha: f64| Node {
            t: s.t,
            theta: s.theta,
            omega: s.omega,
            alpha,
            work: 0.0,
        };
        let [from, to] = [accepted.start, accepted.end].map(|y| self.model.state(&y));
        let step = Step::new(
            self.model.task.start().turns,
            node(from, accepted.before.rates[4]),
            node(to, accepted.after.rates[4]),
        );
        let Some(recorder) = &mut self.recorder else {
            return;
        };
        *recorder.speed() = events::speed_range(&step, *recorder.speed());
        recorder.keep_step(step);
        let start = self.model.start.theta;
        let turned = |theta: f64| theta - start;
        if let Some(limit) = self.model.task.extent.angle()
            && turned(to.theta).abs() >= limit
        {
            let target = start + limit.copysign(turned(to.theta));
            let t = step.time_of_angle(target, from.t, to.t).unwrap_or(to.t);
            self.ends_at = Some(self.model.state(&accepted.at(t)));
        }
        let last = self.until(accepted);
        let mut found = Vec::new();
        events::crossings(&step, &self.dead_centres, &mut found);
        for (t, what) in found.into_iter().filter(|(t, _)| *t <= last) {
            let (theta, omega) = step.at(t);
            match what {
                Crossing::Angle => self.event("dead-centre", t, theta, omega),
                Crossing::Turning => self.event("turning-point", t, theta, 0.0),
            }
        }
    }
}

/// Accepted step until a time inside it.
struct InAccepted<'s, 'y, 'a, const N: usize> {
    accepted: &'s mut AcceptedStep<'y, N>,
    /// Last time, s.
    until: f64,
    model: &'a Loose<'a, N>,
}

impl<const N: usize> RowSource for InAccepted<'_, '_, '_, N> {
    fn times(&self) -> [f64; 2] {
        [self.accepted.start[0], self.until]
    }

    fn turned(&mut self, t: f64) -> f64 {
        self.model.state(&self.accepted.at(t)).theta - self.model.start.theta
    }

    fn row(&mut self, t: f64) -> Row {
        let s = self.model.state(&self.accepted.at(t));
        self.model.row(&s, self.accepted.phase)
    }
}
