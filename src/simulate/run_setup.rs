//! A run that is ready to be computed.

use super::options::Options;
use super::row_maker::RowMaker;
use super::schedule::Schedule;
use super::stop::Why;
use crate::engine::runge_kutta;
use crate::engine::time::{self, Settings, Start};
use crate::mechanism::{Class, Equation, Limits};
use crate::numeric::angle::Angle;
use crate::plan::{Plan, Stepper};
use crate::scene::{Extent, Scene};

/// A scene with all that its engine needs.
pub(super) struct RunSetup<'a> {
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub plan: Plan,
    pub extent: Extent,
    /// Most steps or pieces of the dense motion that are kept.
    pub kept: usize,
    pub limits: Limits,
    pub maker: RowMaker,
}

impl RunSetup<'_> {
    /// When rows are due.
    pub fn schedule(&self) -> Schedule {
        Schedule::new(self.scene.run.output_every, self.extent)
    }

    pub fn equation(&self) -> &Equation {
        &self.maker.equation
    }

    pub fn start(&self) -> Angle {
        Angle::from(self.scene.motion.angle).reduced()
    }

    /// Whether the crank turns right round.
    pub fn turns_fully(&self) -> bool {
        self.limits.class == Class::RotatingCrank
    }

    /// The state of the crank at the start.
    pub fn first_state(&self) -> Start {
        Start {
            t: 0.0,
            angle: self.start(),
            speed: self.scene.motion.speed,
        }
    }

    /// Why a run ends at its limit of work.
    pub fn limited(&self) -> Why {
        match &self.options.stop {
            Some(stop) if stop.is_requested() => Why::Interrupted,
            _ => Why::WorkLimit,
        }
    }

    /// How the run is integrated in time.
    pub fn settings(&self) -> Settings<'_> {
        let motion = &self.scene.motion;
        let inertia = self.equation().terms(motion.angle).inertia.m;
        let unit = 0.5 * inertia * motion.speed.powi(2).max(1.0);
        Settings {
            method: match self.plan.stepper {
                Some(Stepper::Dop853) => time::Method::Library(runge_kutta::Method::Dop853),
                Some(Stepper::Dopri5) => time::Method::Library(runge_kutta::Method::Dopri5),
                _ => time::Method::Picard,
            },
            tolerance: self.scene.run.tolerance,
            t_end: match self.extent {
                Extent::Duration(duration) => duration,
                Extent::Revolutions(_) => time::FAR,
            },
            way: self.extent.angle().unwrap_or(f64::INFINITY),
            limit: self.options.limit(),
            work_unit: if unit > 0.0 { unit } else { 1.0 },
            guide: &[],
        }
    }
}
