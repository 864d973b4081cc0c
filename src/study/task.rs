//! A run that is ready to be computed.

use super::row::RowMaker;
use super::simulate::Options;
use crate::engine::time::Start;
use crate::mechanism::{Equation, Limits};
use crate::numeric::angle::Angle;
use crate::plan::Plan;
use crate::scene::{Extent, Scene};

/// A scene with all that its engine needs.
pub(super) struct Task<'a> {
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub plan: Plan,
    pub extent: Extent,
    pub limits: Limits,
    pub maker: RowMaker<'a>,
}

impl<'a> Task<'a> {
    pub fn equation(&self) -> &'a Equation {
        self.maker.equation
    }

    pub fn start(&self) -> Angle {
        Angle::from(self.scene.motion.angle).reduced()
    }

    /// The state of the crank at the start.
    pub fn first_state(&self) -> Start {
        Start {
            t: 0.0,
            angle: self.start(),
            speed: self.scene.motion.speed,
        }
    }
}
