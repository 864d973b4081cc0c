//! Follows a run with a loose joint: rows, events, and what the contact does.

use std::time::{Duration, Instant};

use super::super::joint_force_maxima::{FORCES, Peak};
use super::super::result::Event;
use super::super::row::{LooseRow, Row, RowMaker, RowSink};
use super::super::schedule::{Schedule, passed};
use super::motion::{Loose, touch};
use super::record::{Record, Tally};
use crate::engine::contact::{Phase, Stretch};
use crate::engine::events::{self, Crossing};
use crate::engine::step::{Node, Step};
use crate::error::Error;
use crate::mechanism::LooseState;
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// What a run is asked for beside its end.
pub(super) struct Asked<'a> {
    pub maker: &'a RowMaker<'a>,
    pub schedule: Schedule,
    /// Sign of the branch.
    pub branch: f64,
    /// Whole turns of the start.
    pub turns: f64,
    /// Crank angle of the start, rad.
    pub start: f64,
    /// Dead centres that are watched, rad in [0, 2π).
    pub watched: Vec<f64>,
    /// The run ends when the crank has turned by this, rad.
    pub turn_limit: Option<f64>,
    pub events_kept: usize,
    /// Whether the dense motion of the crank is kept.
    pub keep_steps: bool,
    /// Whether the journal is sampled, for comparison with another run.
    pub sampled: bool,
    /// Whether the largest joint forces are looked for.
    pub forces: bool,
}

/// What was seen so far.
pub(super) struct Seen {
    pub record: Record,
    pub total: Tally,
    pub separations: u64,
    pub events: Vec<Event>,
    pub events_total: u64,
    /// Least and largest crank speed, rad/s.
    pub speed: (f64, f64),
    /// Largest of the energy put in so far, J.
    pub energy: f64,
    pub ends_at: Option<LooseState>,
    pub steps: Vec<Step>,
    pub row_time: Duration,
    pub error: Option<Error>,
    pub peaks: Option<[Peak; FORCES]>,
    phase: Phase,
    sticking: bool,
    next_row: u64,
}

impl Seen {
    pub fn new(width: f64, speed: f64, energy: f64, phase: Phase) -> Seen {
        Seen {
            record: Record::new(width),
            total: Tally::default(),
            separations: 0,
            events: Vec::new(),
            events_total: 0,
            speed: (speed, speed),
            energy,
            ends_at: None,
            steps: Vec::new(),
            row_time: Duration::ZERO,
            error: None,
            peaks: None,
            phase,
            sticking: false,
            next_row: 0,
        }
    }
}

pub(super) struct Follow<'a, const N: usize> {
    pub model: &'a Loose<'a, N>,
    pub asked: &'a Asked<'a>,
    pub rows: &'a mut dyn RowSink,
    pub seen: Seen,
}

impl<const N: usize> Follow<'_, N> {
    /// Takes a stretch; true ends the run.
    pub fn take(&mut self, stretch: &mut Stretch<'_, N>) -> bool {
        self.follow_phase(stretch);
        self.follow_guide(stretch);
        if N == super::motion::FREE {
            self.follow_crank(stretch);
        }
        self.follow_contact(stretch);
        self.follow_forces(stretch);
        while self.asked.sampled && self.seen.record.due() <= stretch.end[0] {
            let y = stretch.at(self.seen.record.due());
            let journal = self.model.mechanism.journal(&self.model.state(&y));
            self.seen.record.sample(journal);
        }
        let [work, lost] = self.model.work(&stretch.end);
        self.seen.energy = self.seen.energy.max((work - lost).abs());
        if self.rows.wants_rows() {
            let begun = Instant::now();
            if let Err(error) = self.write_rows(stretch) {
                self.seen.error = Some(error);
                return true;
            }
            self.seen.row_time += begun.elapsed();
        }
        self.seen.ends_at.is_some()
    }

    fn event(&mut self, kind: &'static str, t: f64, theta: f64, omega: f64) {
        self.seen.events_total += 1;
        if self.seen.events.len() < self.asked.events_kept {
            self.seen.events.push(Event {
                kind,
                t_s: t,
                theta_rad: self.angle(theta).radians(),
                omega_rad_per_s: omega,
            });
        }
    }

    pub(super) fn angle(&self, theta: f64) -> Angle {
        Angle {
            turns: self.asked.turns,
            rest: theta,
        }
    }

    /// Impacts and separations.
    fn follow_phase(&mut self, stretch: &Stretch<'_, N>) {
        let s = self.model.state(&stretch.start);
        let kind = match (self.seen.phase, stretch.phase) {
            (Phase::Flight, Phase::Contact { .. }) => {
                let one = Tally {
                    impacts: 1,
                    ..Tally::default()
                };
                self.seen.total.add(&one);
                self.seen.record.tally(s.t, &one);
                "impact"
            }
            (Phase::Contact { .. } | Phase::Release { .. }, Phase::Flight) => {
                self.seen.separations += 1;
                "separation"
            }
            _ => {
                self.seen.phase = stretch.phase;
                return;
            }
        };
        self.seen.phase = stretch.phase;
        self.event(kind, s.t, s.theta, s.omega);
    }

    /// Where friction holds the slider and lets it go; a slider that is held has no velocity at all.
    fn follow_guide(&mut self, stretch: &Stretch<'_, N>) {
        let (from, to) = (
            self.model.state(&stretch.start),
            self.model.state(&stretch.end),
        );
        let sticking = self.model.mechanism.rubs() && from.v == 0.0 && to.v == 0.0;
        if sticking != self.seen.sticking {
            let kind = if sticking { "stick" } else { "slip" };
            self.event(kind, from.t, from.theta, from.omega);
        }
        self.seen.sticking = sticking;
    }

    /// Dead centres, turning points, extreme speeds and the turn limit of a crank that moves by itself.
    fn follow_crank(&mut self, stretch: &mut Stretch<'_, N>) {
        let node = |s: LooseState, alpha: f64| Node {
            t: s.t,
            theta: s.theta,
            omega: s.omega,
            alpha,
            work: 0.0,
        };
        let (from, to) = (
            self.model.state(&stretch.start),
            self.model.state(&stretch.end),
        );
        let step = Step::new(
            self.asked.turns,
            node(from, stretch.before.rates[4]),
            node(to, stretch.after.rates[4]),
        );
        self.seen.speed = events::speed_range(&step, self.seen.speed);
        let turned = |theta: f64| theta - self.asked.start;
        if let Some(limit) = self.asked.turn_limit
            && turned(to.theta).abs() >= limit
        {
            let target = self.asked.start + limit.copysign(turned(to.theta));
            let t = step.time_of_angle(target, from.t, to.t).unwrap_or(to.t);
            self.seen.ends_at = Some(self.model.state(&stretch.at(t)));
        }
        let last = self.seen.ends_at.map_or(to.t, |s| s.t);
        let mut found = Vec::new();
        events::crossings(&step, &self.asked.watched, &mut found);
        for (t, what) in found.into_iter().filter(|(t, _)| *t <= last) {
            let (theta, omega) = step.at(t);
            match what {
                Crossing::Angle(_) => self.event("dead-centre", t, theta, omega),
                Crossing::Turning => self.event("turning-point", t, theta, 0.0),
            }
        }
        if self.asked.keep_steps {
            self.seen.steps.push(step);
        }
    }

    fn write_rows(&mut self, stretch: &mut Stretch<'_, N>) -> Result<(), Error> {
        let until = self.seen.ends_at.map_or(stretch.end[0], |s| s.t);
        if let Some(spacing) = self.asked.schedule.angle_step() {
            if self.seen.next_row == 0 {
                self.seen.next_row = 1;
                let start = self.model.state(&stretch.start);
                self.write_row(&start, stretch.phase)?;
            }
            let turned = |y: &[f64; N]| (self.model.state(y).theta - self.asked.start) / spacing;
            for k in passed(turned(&stretch.start), turned(&stretch.end)) {
                let (from, to) = (stretch.start[0], stretch.end[0]);
                let way = |t: f64| turned(&stretch.at(t)) - k;
                let t = root::bracketed(way, from, to).unwrap_or(to);
                if t <= until {
                    let s = self.model.state(&stretch.at(t));
                    self.write_row(&s, stretch.phase)?;
                }
            }
            return Ok(());
        }
        while let Some(t) = self.asked.schedule.time(self.seen.next_row) {
            if t > until {
                break;
            }
            let s = self.model.state(&stretch.at(t));
            self.write_row(&s, stretch.phase)?;
            self.seen.next_row += 1;
        }
        Ok(())
    }

    /// The row of a state: slider and rod as they move, and the slider of the ideal joints beside it.
    pub fn write_row(&mut self, s: &LooseState, phase: Phase) -> Result<(), Error> {
        if !self.rows.wants_rows() {
            return Ok(());
        }
        let mechanism = self.model.mechanism;
        let linked = matches!(phase, Phase::Link).then(|| mechanism.relinked(s));
        let s = linked.as_ref().unwrap_or(s);
        let rates = mechanism.rates(s, touch(phase, None));
        let maker = self.asked.maker;
        let reactor = maker.reactor;
        let ideal = maker.row(s.t, self.angle(s.theta), s.omega, Some(rates.alpha));
        self.rows.row(&Row {
            x: s.x,
            v: s.v,
            a: rates.a,
            phi: phi(s.psi, self.asked.branch),
            reactions: reactor.map(|reactor| reactor.loose(mechanism.joint(), s, &rates)),
            driving_torque: maker.driving_torque.then_some(rates.driving_torque),
            clearance: Some(LooseRow {
                ideal: [ideal.x, ideal.v, ideal.a],
                journal: mechanism.journal(s),
                force: rates.normal,
            }),
            ..ideal
        })
    }
}

/// Inclination φ of the rod from its direction, rad.
pub(super) fn phi(psi: f64, branch: f64) -> f64 {
    let (sin, cos) = psi.sin_cos();
    (-sin).atan2(branch * cos)
}
