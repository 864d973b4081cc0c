//! Loop of a free motion: the engines of the plan take turns until the goal is met, and an observer takes their pieces.

use std::borrow::Cow;

use super::super::angle_model::AngleModel;
use super::super::configuration_curve::{CurveProblem, StepObserver};
use super::super::run_setup::RunSetup;
use super::super::stop::Why;
use super::stop_reason;
use crate::engine::angle::{AngleRun, Dynamics, Resolution};
use crate::engine::energy::NotApplicable;
use crate::engine::step::Step;
use crate::engine::time::{MotionState, Settings};
use crate::engine::{Counted, WorkLimit};
use crate::error::Error;
use crate::plan::{Engine, Method};
use crate::scene::Extent;

/// Settings of one pass: set-up, first engine, extent and resolution.
#[derive(Clone)]
pub(super) struct PassSettings<'a> {
    pub task: &'a RunSetup<'a>,
    pub model: &'a AngleModel<'a>,
    pub first_engine: Engine,
    pub extent: Extent,
    pub resolution: Resolution<'a>,
    pub time_settings: Settings<'a>,
    /// Crank rotation in one direction, rad, after which the angle engine resumes.
    pub resume_rotation: f64,
}

/// Reason for an engine, in words.
pub(super) type Reason = Cow<'static, str>;

/// Receiver of the pieces of a pass.
pub(super) trait PassObserver: StepObserver {
    /// Takes a piece over the angle, with the reason for its engine.
    fn over_angle(&mut self, piece: &AnglePiece, reason: Reason) -> Result<(), Error>;

    /// Keeps the motion of a piece over the angle that is one of several.
    fn keep(&mut self, _piece: AnglePiece) {}

    /// Begins a piece in time, on a configuration curve or with the crank angle as the coordinate, for a reason.
    fn begin_in_time(&mut self, from: MotionState, curve: Option<&CurveProblem>, reason: Reason);

    /// Ends a piece in time; returns the shortened last step if the run ends inside it.
    fn end_in_time(
        &mut self,
        _motion: &Counted<'_>,
        _last: &Step,
        _settings: &Settings<'_>,
    ) -> Option<Step> {
        None
    }
}

/// Piece over the crank angle, placed in the time of the run.
pub(super) struct AnglePiece {
    pub run: AngleRun,
    pub engine: Engine,
    pub from: MotionState,
    pub to: MotionState,
}

/// Reason for the end of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PieceEnd {
    /// The run reached its goal or cannot go on.
    Ended,
    /// The crank is clear of rest again.
    ClearOfRest,
    /// The engine cannot begin or go on.
    NotApplicable(NotApplicable),
}

/// State and totals of a pass, up to now and at its end.
#[derive(Default)]
pub(super) struct PassResult {
    pub state: MotionState,
    /// Last step, if the last piece was in time.
    pub last_step: Option<Step>,
    /// Motion along the configuration curve, if the last piece followed it.
    pub curve: Option<CurveProblem>,
    /// Last piece, if over the angle, until the next piece begins; after the pass, the piece if it is the only one.
    pub angle_piece: Option<AnglePiece>,
    /// Work of friction and of the loads without potential, J.
    pub work: f64,
    /// Largest kinetic energy at the ends of panels and steps, J.
    pub largest_kinetic: f64,
    pub evaluations: u64,
    pub steps: u64,
    pub pieces_over_angle: u64,
    pub pieces_in_time: u64,
    /// Reason for an end before the goal, but for one of the observer.
    pub stopped: Option<Why>,
}

impl PassResult {
    /// Whether one engine computed the run in one piece.
    pub fn is_one_piece(&self) -> bool {
        self.pieces_over_angle + self.pieces_in_time == 1
    }
}

/// Pass under way.
pub(super) struct Pass<'a, 'o> {
    pub settings: &'a PassSettings<'a>,
    pub motion: &'a Counted<'a>,
    pub observer: &'o mut dyn PassObserver,
    pub result: PassResult,
    /// Positions of the angle model evaluated before this pass.
    positions_before: u64,
    /// Number of evaluations of loads over the angle and along the configuration curve.
    pub other_evaluations: u64,
    /// Crank rotation in one direction, rad, after which the angle engine resumes next time.
    pub resume_rotation: f64,
}

impl PassSettings<'_> {
    /// Runs to the end. All evaluations of `motion` during the pass count for the work limit.
    pub fn run(
        &self,
        motion: &Counted<'_>,
        observer: &mut dyn PassObserver,
    ) -> Result<PassResult, Error> {
        let mut pass = Pass {
            settings: self,
            motion,
            observer,
            result: PassResult {
                state: self.task.first_state(),
                ..PassResult::default()
            },
            positions_before: self.model.positions(),
            other_evaluations: 0,
            resume_rotation: self.resume_rotation,
        };
        pass.run_pieces()?;
        if !pass.result.is_one_piece() {
            pass.keep();
        }
        pass.result.evaluations = pass.spent();
        Ok(pass.result)
    }
}

impl<'a> Pass<'a, '_> {
    /// Returns the number of evaluations beside those of `motion`.
    pub fn spent_beside_motion(&self) -> u64 {
        self.settings.model.positions() - self.positions_before + self.other_evaluations
    }

    fn spent(&self) -> u64 {
        self.spent_beside_motion() + self.motion.evaluations()
    }

    /// Returns the rest of the work limit.
    pub fn left(&self) -> WorkLimit<'a> {
        self.settings.time_settings.limit.after(self.spent())
    }

    fn run_pieces(&mut self) -> Result<(), Error> {
        let PassSettings { task, .. } = *self.settings;
        let mut engine = self.settings.first_engine;
        let mut reason = task.plan.reason.clone();
        // Rotation, rad, before the angle engine resumes; infinite unless that engine stopped at low speed.
        let mut rotation = f64::INFINITY;
        loop {
            let end = match engine {
                Engine::Energy => self.run_energy_engine(reason)?,
                Engine::Angle => self.run_angle_engine(reason)?,
                _ => self.run_time_engine(rotation, reason)?,
            };
            (rotation, reason) = (f64::INFINITY, "the crank turns".into());
            engine = match end {
                PieceEnd::Ended => return Ok(()),
                PieceEnd::ClearOfRest => Engine::Angle,
                PieceEnd::NotApplicable(why) => {
                    let Some(next) = self.successor(engine, why)? else {
                        return Ok(());
                    };
                    let resumes = task.plan.has(Engine::Angle) && task.turns_fully();
                    if why == NotApplicable::TooSlow && resumes {
                        rotation = self.resume_rotation;
                    }
                    if next == Engine::Time {
                        reason = stop_reason::not_applicable(task, why).into();
                    }
                    next
                }
            };
        }
    }

    /// Returns the engine after one that is not applicable; none at the end of the run.
    fn successor(&mut self, engine: Engine, why: NotApplicable) -> Result<Option<Engine>, Error> {
        use NotApplicable::{TooLong, TooManyTurns, TooSlow, WorkLimit};
        let PassSettings { task, model, .. } = *self.settings;
        if !self.has_begun() {
            if task.options.method != Method::Auto && !self.settings.resolution.is_second {
                return Err(stop_reason::refusal(task, why));
            }
            // Evaluations of an engine that could not begin do not count for this run.
            self.positions_before = model.positions();
        }
        Ok(match (engine, why) {
            (Engine::Energy, TooLong | TooSlow) if task.plan.has(Engine::Angle) => {
                Some(Engine::Angle)
            }
            (Engine::Angle, TooLong) if self.has_begun() => Some(Engine::Angle),
            (Engine::Angle, WorkLimit | TooManyTurns) if self.has_begun() => {
                self.result.stopped = Some(match why {
                    WorkLimit => task.limited(),
                    _ => Why::TooManyTurns,
                });
                None
            }
            _ => Some(Engine::Time),
        })
    }

    pub fn has_begun(&self) -> bool {
        self.result.pieces_over_angle + self.result.pieces_in_time > 0
    }
}
