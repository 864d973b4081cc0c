//! Motion on the configuration curve, piece by piece: smooth integration between located changes of friction.

use std::cell::Cell;

use super::super::coordinate::{Coordinate, crank_state};
use super::super::stick_slip::EventIndex::{
    self, CrankRate, DeadCentre, JamDistance, Limit, NormalForce, Speed, TurnLimit,
};
use super::super::stick_slip::{CurveEvents, CurveMotion, Signs, StickSlipPhase, sliding};
use super::super::stop::Why;
use super::{EndReason, StepObserver, TimePiece};
use crate::engine::event_functions::{self, Change, EventFunction};
use crate::engine::step::{Node, Step};
use crate::engine::time::{self, Finish, MotionState, Settings};
use crate::engine::work_forecast::WorkForecast;
use crate::engine::{Counted, Motion};
use crate::mechanism::CurveEquation;
use crate::numeric::angle::Angle;

/// Run in time on the configuration curve.
pub(in super::super) struct CurveRun<'a, 'o> {
    pub(super) equation: &'a CurveEquation,
    pub(super) settings: Settings<'a>,
    pub(super) events: CurveEvents<'a>,
    pub(super) observer: &'o mut dyn StepObserver,
    pub(super) state: MotionState,
    pub(super) signs: Signs,
    pub(super) piece: TimePiece,
}

/// Returns the kind of event of an event function, if it reports one.
fn event(index: EventIndex) -> Option<&'static str> {
    match index {
        Speed => Some("turning-point"),
        DeadCentre => Some("dead-centre"),
        Limit => Some("limit"),
        _ => None,
    }
}

impl<'a, 'o> CurveRun<'a, 'o> {
    /// Runs a piece from a state of the coordinate. `turn_limit`: crank angle at the start of the turns, and the largest
    /// rotation from there (rad); none without a turn limit.
    pub fn run(
        equation: &'a CurveEquation,
        settings: Settings<'a>,
        start: MotionState,
        turn_limit: Option<(Angle, f64)>,
        observer: &'o mut dyn StepObserver,
    ) -> TimePiece {
        let MotionState { t, angle, speed } = start;
        let node = Node {
            t,
            theta: angle.rest,
            omega: speed,
            ..Node::default()
        };
        let mut run = CurveRun {
            equation,
            settings,
            events: CurveEvents {
                equation,
                turn_limit,
                evaluations: Cell::new(0),
                opposed: Cell::default(),
            },
            observer,
            state: start,
            signs: Signs::default(),
            piece: TimePiece {
                last: Step::new(angle.turns, node, node),
                work: 0.0,
                steps: 0,
                evaluations: 0,
                end: EndReason::Done,
                singular_state: None,
            },
        };
        let end = if speed == 0.0 && run.may_stick() {
            run.leave_rest(None)
        } else {
            run.signs = run.signs_for(if speed < 0.0 { -1.0 } else { 1.0 });
            run.check_jam()
        };
        run.piece.end = end.unwrap_or_else(|| run.run_pieces());
        run.piece.evaluations = run.spent();
        run.piece
    }

    /// Returns the number of evaluations, with those of the event functions.
    pub(super) fn spent(&self) -> u64 {
        self.piece.evaluations + self.events.evaluations.get()
    }

    /// Whether friction or a dry load may hold the mechanism at rest.
    pub(super) fn may_stick(&self) -> bool {
        self.equation.friction.is_some() || self.equation.loads().are_dry()
    }

    pub(super) fn curve_motion(&self, phase: StickSlipPhase) -> CurveMotion<'a> {
        CurveMotion {
            equation: self.equation,
            phase,
        }
    }

    fn run_pieces(&mut self) -> EndReason {
        let in_time = self
            .curve_motion(StickSlipPhase::Sticking)
            .depends_on_time();
        let settings = self.settings;
        let mut forecast = WorkForecast::new(self.state.t, 0, settings.ends(), in_time);
        loop {
            let from = self.state.angle;
            let end = self.slide().map_or_else(Some, |change| self.apply(change));
            if end.is_some() || self.state.t >= self.settings.t_end {
                return end.unwrap_or(EndReason::Done);
            }
            let spent = self.spent();
            if self.settings.limit.is_reached(spent) {
                return EndReason::Integrator(Finish::WorkLimit);
            }
            let travel = self.state.angle.minus(from);
            if let Some(finish) = forecast.reason_to_stop(spent, self.state.t, travel) {
                return EndReason::Integrator(finish);
            }
        }
    }

    /// Passes the change at the end of a piece of sliding; returns the end of the run, if it ends there.
    fn apply(&mut self, Change { t, index }: Change) -> Option<EndReason> {
        match EventIndex::ALL[index] {
            TurnLimit => Some(EndReason::Done),
            JamDistance => Some(self.jam()),
            Speed => {
                self.state.speed = 0.0;
                self.leave_rest(Some(self.signs[index]))
            }
            of => {
                self.signs[index] = -self.signs[index];
                self.update_dry_signs(of);
                if let Some(kind) = event(of) {
                    self.observer.event(kind, MotionState { t, ..self.state });
                }
                None
            }
        }
    }

    /// Integrates one piece of sliding, up to the next change of friction or the end of the run.
    fn slide(&mut self) -> Result<Change, EndReason> {
        let equation = self.equation;
        let friction = equation.friction;
        let [on_crank, on_slider] = equation.loads().dry_on();
        let along = self.curve_motion(sliding(equation, &self.signs));
        let motion = Counted::new(&along);
        let settings = Settings {
            limit: self.settings.limit.after(self.spent()),
            ..self.settings
        };
        let mut cut = None;
        let (mut reason, mut beyond) = (None, false);
        let no_inertia = || EndReason::Named(Why::NoInertiaOnCurve.into());
        let (events, observer) = (&self.events, &mut *self.observer);
        let signs = &mut self.signs;
        let begin = self.state.t;
        let (finish, last, steps) = time::run(&motion, self.state, &settings, &mut |step| {
            let mut step = *step;
            let mut after = *signs;
            let follows = step.start.t > begin;
            let changes = event_functions::changes(&mut step, &along, events, follows, &mut after);
            for change in changes {
                let Change { t, .. } = change;
                let (theta, speed) = step.at(t);
                if equation.vanishes_at(theta) {
                    (reason, beyond) = (Some(no_inertia()), true);
                    return true;
                }
                let index = EventIndex::ALL[change.index];
                let ends = match index {
                    Speed => friction.is_some() || on_crank || on_slider,
                    DeadCentre => friction.is_some() || on_slider,
                    NormalForce => friction.is_some(),
                    CrankRate => on_crank,
                    Limit => false,
                    TurnLimit | JamDistance => true,
                };
                if ends {
                    cut = Some((step, change));
                    return true;
                }
                signs[change.index] = -signs[change.index];
                let from_rest = index == Speed && step.start.omega == 0.0;
                if let Some(kind) = event(index).filter(|_| !from_rest) {
                    let speed = if index == Speed { 0.0 } else { speed };
                    let angle = step.angle(theta);
                    observer.event(kind, MotionState { t, angle, speed });
                }
            }
            reason = match observer.step(&step, &Coordinate::Curve(along)) {
                true => Some(EndReason::Stopped),
                false => equation.vanishes_at(step.end.theta).then(no_inertia),
            };
            reason.is_some()
        });
        self.piece.steps += steps;
        self.piece.singular_state = motion
            .singular_state()
            .map(|(t, angle, speed)| crank_state(equation, MotionState { t, angle, speed }));
        let Some((step, change)) = cut else {
            self.piece.evaluations += motion.evaluations();
            self.arrive(match beyond {
                true => Step::new(last.turns, last.start, last.start),
                false => last,
            });
            return Err(reason.unwrap_or_else(|| match finish {
                Finish::AtEnd => EndReason::Done,
                Finish::StepTooSmall => self.singular(),
                finish => EndReason::Integrator(finish),
            }));
        };
        let last = self.shorten(&motion, &step, change, along);
        self.piece.evaluations += motion.evaluations();
        self.arrive(last);
        Ok(change)
    }

    /// Integrates the step anew up to a change inside it.
    fn shorten(
        &mut self,
        motion: &Counted<'_>,
        step: &Step,
        change: Change,
        along: CurveMotion<'_>,
    ) -> Step {
        let settings = &self.settings;
        let until = |t_end: f64, sink: &mut dyn FnMut(&Step) -> bool| {
            time::shortened(motion, step, t_end, settings, sink)
        };
        let mut t = change.t;
        if change.index == TurnLimit as usize {
            t = step.newton_time(t, 2, |t| {
                let last = until(t, &mut |_| false);
                let angle = last.angle(last.end.theta);
                let missing = self.events.values(t, angle, last.end.omega)[TurnLimit as usize];
                let dtheta = self.equation.curve().pose(angle.rest).dtheta;
                [missing, (dtheta * last.end.omega).abs()]
            });
        }
        let observer = &mut *self.observer;
        let at_rest = change.index == Speed as usize;
        let rested = |step: &Step| {
            let mut step = *step;
            if at_rest && step.end.t >= t {
                step.end.omega = 0.0;
            }
            step
        };
        rested(&until(t, &mut |step| {
            observer.step(&rested(step), &Coordinate::Curve(along));
            false
        }))
    }

    pub(super) fn arrive(&mut self, last: Step) {
        self.piece.work += last.end.work;
        self.state = MotionState {
            t: last.end.t,
            angle: last.angle(last.end.theta).reduced(),
            speed: last.end.omega,
        };
        self.piece.last = last;
    }
}
