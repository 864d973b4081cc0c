//! Set-up of a run: a scene with its plan, equation, limits and integration settings.

use std::sync::Arc;

use super::guide_friction::GuideFriction;
use super::options::Options;
use super::row::RowMaker;
use super::schedule::Schedule;
use super::stop::Why;
use crate::engine::runge_kutta::RungeKutta;
use crate::engine::time::{self, MotionState, Settings};
use crate::error::Error;
use crate::mechanism::{Class, Equation, Limits, Reactor};
use crate::numeric::angle::Angle;
use crate::plan::{Plan, Stepper};
use crate::scene::{Extent, Scene};

/// Scene with all that its engine needs.
#[derive(Clone)]
pub(super) struct RunSetup<'a> {
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub plan: Plan,
    pub extent: Extent,
    /// Crank speed at the start, rad/s.
    pub speed: f64,
    /// Whether the run ends where the crank turns back.
    pub stops_at_reversal: bool,
    /// Largest number of steps or pieces of the dense motion that are kept.
    pub steps_kept: usize,
    pub limits: Limits,
    pub maker: RowMaker,
}

impl<'a> RunSetup<'a> {
    /// Plans a scene; the run keeps at most `steps_kept` steps or pieces of its motion.
    ///
    /// # Errors
    /// [`Error::Scene`] for impossible values, [`Error::Refused`] for what cannot be computed.
    pub fn new(
        scene: &'a Scene,
        options: &'a Options,
        steps_kept: usize,
    ) -> Result<RunSetup<'a>, Error> {
        let plan = Plan::of_run(scene, options.method)?;
        let equation = Equation::new(scene);
        let reactor = options.reactions.then(|| Reactor::new(scene));
        Ok(RunSetup {
            scene,
            options,
            plan,
            extent: match scene.run.extent {
                None | Some(Extent::Revolutions(0.0)) => Extent::Duration(0.0),
                Some(extent) => extent,
            },
            speed: scene.motion.speed,
            stops_at_reversal: false,
            steps_kept,
            limits: Limits::new(equation.linkage(), scene.motion.speed),
            maker: RowMaker {
                reactor: reactor.transpose()?.map(Arc::new),
                driving_torque: options.driving_torque,
                guide: GuideFriction::new(scene, &equation).map(Arc::new),
                equation: Arc::new(equation),
            },
        })
    }

    pub fn schedule(&self) -> Schedule {
        Schedule::new(self.scene.run.output_every, self.extent)
    }

    pub fn equation(&self) -> &Equation {
        &self.maker.equation
    }

    pub fn start(&self) -> Angle {
        Angle::from(self.scene.motion.angle).reduced()
    }

    /// Returns the angle that is a crank angle (rad) beyond the whole turns of the start.
    pub fn angle(&self, theta: f64) -> Angle {
        Angle::new(self.start().turns, theta)
    }

    /// True if the crank turns fully.
    pub fn turns_fully(&self) -> bool {
        self.limits.class == Class::RotatingCrank
    }

    /// Whether friction or a dry load may hold the mechanism at rest.
    pub fn may_stick(&self) -> bool {
        self.maker.guide.is_some() || self.equation().loads().are_dry()
    }

    /// Lists the dead centres, rad in [0, 2π).
    pub fn dead_centres(&self) -> Vec<f64> {
        self.limits.dead_centres.iter().map(|dc| dc.theta).collect()
    }

    /// True if the inertia vanishes at a dead centre, where the speed of a crank without inertia has no bound.
    pub fn inertia_vanishes(&self) -> bool {
        let mut dead_centres = self.dead_centres().into_iter();
        dead_centres.any(|theta| self.inertia_is_below(1e-12, theta))
    }

    /// Whether the inertia at an angle (rad) is at most a part of that a radian further on.
    pub fn inertia_is_below(&self, part: f64, theta: f64) -> bool {
        let inertia = |theta: f64| self.equation().terms(theta).m;
        inertia(theta) <= part * inertia(theta + 1.0)
    }

    /// Returns the state of the crank at the start.
    pub fn first_state(&self) -> MotionState {
        MotionState {
            t: 0.0,
            angle: self.start(),
            speed: self.speed,
        }
    }

    /// Returns the reason for an end at the work limit: a request to stop or the limit itself.
    pub fn limited(&self) -> Why {
        match &self.options.stop {
            Some(stop) if stop.is_requested() => Why::Interrupted,
            _ => Why::WorkLimit,
        }
    }

    /// Returns the settings of the integration in time.
    pub fn settings(&self) -> Settings<'_> {
        let inertia = self.equation().terms(self.scene.motion.angle).m;
        let unit = 0.5 * inertia * self.speed.powi(2).max(1.0);
        Settings {
            method: match self.plan.stepper {
                Some(Stepper::Dop853) => Some(RungeKutta::Dop853),
                Some(Stepper::Dopri5) => Some(RungeKutta::Dopri5),
                _ => None,
            },
            tolerance: self.scene.run.tolerance,
            t_end: match self.extent {
                Extent::Duration(duration) => duration,
                Extent::Revolutions(_) => time::UNLIMITED_TIME,
            },
            way: self.extent.angle().unwrap_or(f64::INFINITY),
            limit: self.options.limit(),
            work_unit: if unit > 0.0 { unit } else { 1.0 },
            guide: &[],
        }
    }
}
