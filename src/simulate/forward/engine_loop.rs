//! Loop of a free motion: the engines of the plan take turns until the goal is met.

use std::cell::OnceCell;

use super::super::angle_model::AngleModel;
use super::super::configuration_curve::{End, OnCurve};
use super::super::run_setup::RunSetup;
use super::arrived::{Arrived, PieceEnd, Sink};
use super::stop_reason;
use crate::engine::angle::Resolution;
use crate::engine::energy::NotApplicable;
use crate::engine::time::{Finish, Settings};
use crate::engine::{Counted, WorkLimit};
use crate::error::Error;
use crate::plan::{Engine, Method};
use crate::scene::Extent;

/// Settings of one pass: set-up, first engine, extent and resolution.
#[derive(Clone)]
pub(super) struct Course<'a> {
    pub task: &'a RunSetup<'a>,
    pub model: &'a AngleModel<'a>,
    pub first: Engine,
    /// Whether this is the second pass, with which the first is compared.
    pub is_second: bool,
    pub extent: Extent,
    pub resolution: Resolution<'a>,
    pub settings: Settings<'a>,
    /// Crank rotation in one direction, rad, after which the angle engine resumes.
    pub wait: f64,
    /// Configuration curve through the start, once a piece follows it.
    pub curve: OnceCell<OnCurve>,
}

pub(super) struct Pass<'a, 'o> {
    pub course: &'a Course<'a>,
    pub motion: &'a Counted<'a>,
    pub sink: &'o mut dyn Sink,
    pub arrived: Arrived,
    /// Positions of the angle model evaluated before this pass.
    positions: u64,
    /// Number of evaluations of loads over the angle and along the configuration curve.
    pub beside: u64,
    pub wait: f64,
}

impl Course<'_> {
    /// Runs to the end. All evaluations of `motion` during the pass count for the work limit.
    pub fn run(&self, motion: &Counted<'_>, sink: &mut dyn Sink) -> Result<Arrived, Error> {
        let mut pass = Pass {
            course: self,
            motion,
            sink,
            arrived: Arrived {
                now: self.task.first_state(),
                ..Arrived::default()
            },
            positions: self.model.evaluations(),
            beside: 0,
            wait: self.wait,
        };
        pass.pieces()?;
        if !pass.arrived.is_one_piece() {
            pass.keep();
        }
        let spent = pass.spent();
        let mut arrived = pass.arrived;
        arrived.evaluations = spent;
        Ok(arrived)
    }
}

impl<'a> Pass<'a, '_> {
    /// Returns the number of evaluations beside those of `motion`.
    pub fn spent_beside(&self) -> u64 {
        self.course.model.evaluations() - self.positions + self.beside
    }

    fn spent(&self) -> u64 {
        self.spent_beside() + self.motion.evaluations()
    }

    /// Returns the rest of the work limit.
    pub fn left(&self) -> WorkLimit<'a> {
        self.course.settings.limit.after(self.spent())
    }

    fn pieces(&mut self) -> Result<(), Error> {
        let task = self.course.task;
        let mut engine = self.course.first;
        let mut reason = task.plan.reason.clone();
        // Rotation, rad, before the angle engine resumes; infinite unless that engine stopped at low speed.
        let mut wait = f64::INFINITY;
        loop {
            let why = match engine {
                Engine::Energy => self.by_energy(reason)?,
                Engine::Angle => self.by_angle(reason)?,
                _ => self.in_time(wait, reason)?,
            };
            let Some(next) = self.next(engine, why)? else {
                return Ok(());
            };
            wait = match why {
                PieceEnd::NotApplicable(NotApplicable::TooSlow)
                    if task.plan.has(Engine::Angle) && task.turns_fully() =>
                {
                    self.wait
                }
                _ => f64::INFINITY,
            };
            reason = match why {
                PieceEnd::NotApplicable(why) if next == Engine::Time => {
                    stop_reason::not_applicable(task, why).into()
                }
                _ => "the crank turns".into(),
            };
            engine = next;
        }
    }

    /// Returns the next engine; none at the end of the run.
    fn next(&mut self, engine: Engine, why: PieceEnd) -> Result<Option<Engine>, Error> {
        use NotApplicable::{TooLong, TooManyTurns, TooSlow, WorkLimit};
        let why = match why {
            PieceEnd::Ended => return Ok(None),
            PieceEnd::Clear => return Ok(Some(Engine::Angle)),
            PieceEnd::NotApplicable(why) => why,
        };
        let plan = &self.course.task.plan;
        if !self.has_begun() {
            if self.course.task.options.method != Method::Auto && !self.course.is_second {
                return Err(stop_reason::refusal(self.course.task, why));
            }
            // Evaluations of an engine that could not begin do not count for this run.
            self.positions = self.course.model.evaluations();
        }
        Ok(match (engine, why) {
            (Engine::Energy, TooLong | TooSlow) if plan.has(Engine::Angle) => Some(Engine::Angle),
            (Engine::Angle, TooLong) if self.has_begun() => Some(Engine::Angle),
            (Engine::Angle, WorkLimit | TooManyTurns) if self.has_begun() => {
                self.arrived.end = End::Integrator(match why {
                    WorkLimit => Finish::WorkLimit,
                    _ => Finish::TooManyTurns,
                });
                None
            }
            _ => Some(Engine::Time),
        })
    }

    pub fn has_begun(&self) -> bool {
        self.arrived.over_angle + self.arrived.in_time > 0
    }
}
