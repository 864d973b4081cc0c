//! Motion piece by piece: between the changes of friction it is smooth.

use std::cell::Cell;

use super::phase::{
    CLEAR, DEAD_CENTRE, InPhase, LIMIT, NORMAL, Phase, Quantities, SPEED, Signs, TURNED, jam_text,
    signs, sliding,
};
use super::release;
use crate::engine::guard::{self, Watched};
use crate::engine::step::{Node, Step};
use crate::engine::time::{self, Finish, Settings, Start};
use crate::engine::{Counted, Motion};
use crate::mechanism::{Constrained, FromRest};
use crate::numeric::angle::Angle;
use crate::scene::{Friction, Variable};

/// Takes what is computed.
pub(super) trait Observer {
    /// A part of the motion; true ends the run.
    fn step(&mut self, step: &Step, phase: Phase) -> bool;

    /// Something that happened.
    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64);
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum End {
    /// At its time, or after its turns.
    Done,
    /// The integrator could not go on.
    Integrator(Finish),
    /// Rigid bodies do not say how it goes on.
    Jam(String),
    /// At rest for good before its turns are complete.
    AtRest,
    /// The observer ended it.
    Stopped,
}

/// A run.
pub(super) struct Follow<'a> {
    pub equation: &'a Constrained,
    pub settings: Settings,
    /// Of the coordinate.
    pub start: Start,
    /// How far the crank may turn, rad.
    pub turn_limit: Option<f64>,
}

/// Where a run arrived.
pub(super) struct Arrived {
    /// Last piece.
    pub last: Step,
    /// Work of all that has no potential, J.
    pub work: f64,
    pub steps: u64,
    pub evaluations: u64,
    /// Pieces of the motion.
    pub pieces: u64,
    pub end: End,
    /// Time, crank angle (rad) and crank speed of the last evaluation without a finite result.
    pub impossible: Option<(f64, f64, f64)>,
}

/// How far ahead a run without a last time looks for a release, in units of its time so far.
const FAR_AHEAD: f64 = 1e3;

/// A run under way.
struct Run<'a, 'o> {
    follow: &'a Follow<'a>,
    quantities: Quantities<'a>,
    observer: &'o mut dyn Observer,
    now: Start,
    signs: Signs,
    arrived: Arrived,
}

/// What ends a piece of the motion.
enum Cut {
    At { t: f64, index: usize },
    Ended(Finish),
    Stopped,
}

impl Follow<'_> {
    /// Follows the motion to its end.
    pub fn run(&self, observer: &mut dyn Observer) -> Arrived {
        let Start { t, angle, speed } = self.start;
        let crank = self.equation.curve().crank_angle(angle);
        let node = Node {
            t,
            theta: angle.rest,
            omega: speed,
            ..Node::default()
        };
        let mut run = Run {
            follow: self,
            quantities: Quantities {
                equation: self.equation,
                turning: self.turn_limit.map(|limit| (crank, limit)),
                evaluations: Cell::new(0),
            },
            observer,
            now: self.start,
            signs: Signs::default(),
            arrived: Arrived {
                last: Step::new(angle.turns, node, node),
                work: 0.0,
                steps: 0,
                evaluations: 0,
                pieces: 0,
                end: End::Done,
                impossible: None,
            },
        };
        run.begin();
        run.arrived.evaluations += run.quantities.evaluations.get();
        run.arrived
    }

    fn friction(&self) -> Option<Friction> {
        self.equation.friction()
    }
}

impl Run<'_, '_> {
    fn begin(&mut self) {
        let speed = self.now.speed;
        let end = if speed == 0.0 && self.follow.friction().is_some() {
            self.from_rest(None)
        } else {
            let direction = if speed < 0.0 { -1.0 } else { 1.0 };
            self.signs = self.signs_for(direction);
            self.check_jam()
        };
        let end = end.or_else(|| self.pieces());
        self.arrived.end = end.unwrap_or(End::Done);
    }

    fn signs_for(&self, direction: f64) -> Signs {
        let Start { t, angle, speed } = self.now;
        let mut signs = signs(self.quantities.values(t, angle, speed), direction);
        // A start without speed says nothing about its direction.
        if speed == 0.0 && self.follow.friction().is_none() {
            let motion = self.in_phase(Phase::Sliding { c: 0.0 });
            if motion.acceleration(t, angle, speed) < 0.0 {
                signs[SPEED] = -1.0;
            }
        }
        signs
    }

    fn in_phase(&self, phase: Phase) -> InPhase<'_> {
        InPhase {
            equation: self.follow.equation,
            phase,
        }
    }

    /// Pieces of sliding until the end.
    fn pieces(&mut self) -> Option<End> {
        loop {
            self.arrived.pieces += 1;
            let end = match self.slide() {
                Cut::Ended(Finish::AtEnd) => Some(End::Done),
                Cut::Ended(finish) => Some(self.singular(finish)),
                Cut::Stopped => Some(End::Stopped),
                Cut::At { index: TURNED, .. } => Some(End::Done),
                Cut::At { index: CLEAR, .. } => Some(self.jam()),
                Cut::At { index: SPEED, .. } => {
                    let before = self.signs[SPEED];
                    self.now.speed = 0.0;
                    self.from_rest(Some(before))
                }
                Cut::At { t, index } => {
                    self.signs[index] = -self.signs[index];
                    self.report(index, t);
                    None
                }
            };
            if end.is_some() || self.now.t >= self.follow.settings.t_end {
                return end.or(Some(End::Done));
            }
            if self.arrived.evaluations + self.quantities.evaluations.get()
                >= self.follow.settings.max_evaluations
            {
                return Some(End::Integrator(Finish::WorkLimit));
            }
        }
    }

    fn report(&mut self, index: usize, t: f64) {
        let kind = match index {
            SPEED => "turning-point",
            DEAD_CENTRE => "dead-centre",
            LIMIT => "limit",
            _ => return,
        };
        let speed = if index == SPEED { 0.0 } else { self.now.speed };
        self.observer.event(kind, t, self.now.angle, speed);
    }

    /// One piece of sliding, up to the next change of friction.
    fn slide(&mut self) -> Cut {
        let equation = self.follow.equation;
        let friction = self.follow.friction();
        let phase = sliding(friction, &self.signs);
        let in_phase = InPhase { equation, phase };
        let motion = Counted::new(&in_phase);
        let looked_at = Counted::new(&in_phase);
        let spent = self.arrived.evaluations + self.quantities.evaluations.get();
        let settings = Settings {
            max_evaluations: self.follow.settings.max_evaluations.saturating_sub(spent),
            ..self.follow.settings
        };
        let mut cut = None;
        let mut stopped = false;
        let (quantities, observer) = (&self.quantities, &mut *self.observer);
        let signs = &mut self.signs;
        let (finish, last, steps) = time::run(&motion, self.now, &settings, &mut |step| {
            let mut step = *step;
            let mut after = *signs;
            for change in guard::changes(&mut step, &looked_at, quantities, &mut after) {
                let ends = match change.index {
                    SPEED | DEAD_CENTRE | NORMAL => friction.is_some(),
                    LIMIT => false,
                    _ => true,
                };
                if ends {
                    cut = Some((step, change));
                    return true;
                }
                signs[change.index] = -signs[change.index];
                let from_rest = change.index == SPEED && step.start.omega == 0.0;
                if from_rest {
                    continue;
                }
                let (theta, speed) = step.at(change.t);
                let (kind, speed) = match change.index {
                    SPEED => ("turning-point", 0.0),
                    DEAD_CENTRE => ("dead-centre", speed),
                    _ => ("limit", speed),
                };
                observer.event(kind, change.t, step.angle(theta), speed);
            }
            stopped = observer.step(&step, phase);
            stopped
        });
        self.arrived.steps += steps;
        self.arrived.impossible = motion.impossible().map(|(t, angle, speed)| {
            let curve = equation.curve();
            let omega = curve.place(angle.rest).dtheta * speed;
            (t, curve.crank_angle(angle).radians(), omega)
        });
        let Some((step, change)) = cut else {
            self.arrived.evaluations += motion.evaluations();
            self.arrive(last);
            return if stopped {
                Cut::Stopped
            } else {
                Cut::Ended(finish)
            };
        };
        let last = self.shorten(&motion, &step, change.t, change.index == TURNED, phase);
        self.arrived.evaluations += motion.evaluations();
        self.arrive(last);
        Cut::At {
            t: change.t,
            index: change.index,
        }
    }

    /// The step ended at time `t` inside it, integrated anew.
    fn shorten(
        &mut self,
        motion: &Counted<'_>,
        step: &Step,
        t: f64,
        turned: bool,
        phase: Phase,
    ) -> Step {
        let start = Start {
            t: step.start.t,
            angle: step.angle(step.start.theta),
            speed: step.start.omega,
        };
        let until = |t_end: f64, sink: &mut dyn FnMut(&Step) -> bool| {
            let settings = Settings {
                t_end,
                max_evaluations: u64::MAX,
                ..self.follow.settings
            };
            time::run(motion, start, &settings, sink).1
        };
        let mut t = t;
        if turned {
            for _ in 0..2 {
                let last = until(t, &mut |_| false);
                let angle = last.angle(last.end.theta);
                let missing = self.quantities.values(t, angle, last.end.omega)[TURNED];
                let dtheta = self.follow.equation.curve().place(angle.rest).dtheta;
                let pace = (dtheta * last.end.omega).abs();
                if missing == 0.0 || pace == 0.0 {
                    break;
                }
                t = (t + missing / pace).clamp(step.start.t, step.end.t);
            }
        }
        let observer = &mut *self.observer;
        let mut last = until(t, &mut |step| {
            observer.step(step, phase);
            false
        });
        last.end.work += step.start.work;
        last
    }

    fn arrive(&mut self, last: Step) {
        self.arrived.work += last.end.work;
        self.now = Start {
            t: last.end.t,
            angle: last.angle(last.end.theta).reduced(),
            speed: last.end.omega,
        };
        self.arrived.last = last;
    }

    /// Goes on from rest: none if it moves. `before`: the direction in which it moved.
    fn from_rest(&mut self, before: Option<f64>) -> Option<End> {
        let friction = self.follow.friction()?;
        let (mu, mu_static) = (friction.coefficient, friction.static_coefficient);
        let Start { t, angle, .. } = self.now;
        let free = self.follow.equation.free(t, angle, 0.0);
        let direction = match free.from_rest(mu, mu_static) {
            FromRest::Move(direction) => {
                if before.is_some_and(|before| before != direction) {
                    self.observer.event("turning-point", t, angle, 0.0);
                }
                direction
            }
            FromRest::Hold(_) => match self.rest(mu_static) {
                Some(direction) => direction,
                None if self.follow.turn_limit.is_some() => return Some(End::AtRest),
                None => return Some(End::Done),
            },
            FromRest::Jam(_) => return Some(self.jam()),
        };
        self.signs = self.signs_for(direction);
        self.check_jam()
    }

    /// Stays at rest until the static band does not hold any more: the direction in which it then slips.
    fn rest(&mut self, mu_static: f64) -> Option<f64> {
        let Start { t, angle, .. } = self.now;
        let equation = self.follow.equation;
        let end = match self.follow.turn_limit {
            Some(_) => t + FAR_AHEAD * t.max(1.0),
            None => self.follow.settings.t_end,
        };
        let changes = equation.loads().reads().has(Variable::T);
        let (until, looked) = if changes {
            let allowed = self.follow.settings.max_evaluations;
            release::time(equation, angle, mu_static, t, end, allowed)
        } else {
            (None, 0)
        };
        self.arrived.evaluations += looked;
        let kind = if until.is_some() { "stick" } else { "rest" };
        self.observer.event(kind, t, angle, 0.0);
        if until.is_none() && self.follow.turn_limit.is_some() {
            return None;
        }
        let node = |t: f64| Node {
            t,
            theta: angle.rest,
            ..Node::default()
        };
        let still = Step::new(angle.turns, node(t), node(until.unwrap_or(end)));
        self.observer.step(&still, Phase::Sticking);
        self.arrive(still);
        let t = until?;
        self.observer.event("slip", t, angle, 0.0);
        let pull = equation.free(t, angle, 0.0);
        Some(if pull.pulls_forward() { 1.0 } else { -1.0 })
    }

    fn check_jam(&mut self) -> Option<End> {
        let friction = self.follow.friction()?;
        let Start { t, angle, speed } = self.now;
        let free = self.follow.equation.free(t, angle, speed);
        (free.clear_of_jam(friction.coefficient) <= 0.0).then(|| self.jam())
    }

    fn jam(&self) -> End {
        let Start { t, angle, speed } = self.now;
        let free = self.follow.equation.free(t, angle, speed);
        let mu = self.follow.friction().map_or(0.0, |f| f.coefficient);
        End::Jam(jam_text(&free, mu, self.signs[SPEED] * self.signs[DEAD_CENTRE]))
    }

    /// A run whose steps became too small next to jamming has jammed.
    fn singular(&self, finish: Finish) -> End {
        let Start { t, angle, speed } = self.now;
        if finish == Finish::StepTooSmall
            && let Some(friction) = self.follow.friction()
        {
            let free = self.follow.equation.free(t, angle, speed);
            if free.clear_of_jam(friction.coefficient) < 1e-3 {
                return self.jam();
            }
        }
        End::Integrator(finish)
    }
}
