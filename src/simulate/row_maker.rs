//! Maker of output rows from states of the crank: kinematics, accelerations and joint forces.

use std::sync::Arc;

use super::guide_friction::GuideFriction;
use super::row::Row;
use crate::engine::time::Start;
use crate::mechanism::{Equation, Reactor};
use crate::numeric::angle::Angle;
use crate::scene::Load;

#[derive(Clone, Debug)]
pub(super) struct RowMaker {
    pub equation: Arc<Equation>,
    pub reactor: Option<Arc<Reactor>>,
    pub driving_torque: bool,
    /// Guide, if it has friction.
    pub guide: Option<Arc<GuideFriction>>,
}

impl RowMaker {
    /// Returns the load without a finite value at a state, if there is one.
    pub fn without_value(&self, at: Start) -> Option<Load> {
        let pose = self.equation.linkage().pose(at.angle.rest);
        let now = pose.instant(at.t, at.angle, at.speed);
        self.equation.loads().without_value(&now).cloned()
    }

    /// Returns the friction on the slider (N, along +x) in a prescribed motion; not a number where the guide locks.
    pub fn friction(&self, t: f64, angle: Angle, omega: f64, alpha: f64) -> f64 {
        self.guide.as_ref().map_or(0.0, |guide| {
            let touch = guide.equation.driven(t, angle, omega, alpha);
            touch.map_or(f64::NAN, |touch| touch.friction)
        })
    }

    /// Returns θ̈ of a free motion, rad/s², and the friction on the slider, N.
    pub fn forward(&self, t: f64, angle: Angle, omega: f64) -> (f64, f64) {
        match &self.guide {
            Some(guide) => {
                let (alpha, touch) = guide.state(t, angle, omega);
                (alpha, touch.friction)
            }
            None => (self.equation.acceleration(t, angle, omega), 0.0),
        }
    }

    /// Makes the row of a free motion or, with `alpha`, of a prescribed one.
    pub fn row(&self, t: f64, angle: Angle, omega: f64, alpha: Option<f64>) -> Row {
        let pose = self.equation.linkage().pose(angle.rest);
        let (alpha, friction) = match alpha {
            Some(alpha) => (alpha, self.friction(t, angle, omega, alpha)),
            None => self.forward(t, angle, omega),
        };
        let reactions = self.reactor.as_ref().map(|reactor| {
            let mut load = self.equation.loads().value(t, angle, omega, &pose);
            load.force += friction;
            reactor.reactions(&pose, omega, alpha, &load)
        });
        let driving_torque = self.driving_torque.then(|| {
            let torque = self.equation.driving_torque(t, angle, omega, alpha);
            torque - friction * pose.dx
        });
        Row {
            t,
            theta: angle.radians(),
            omega,
            alpha,
            x: pose.x,
            v: pose.dx * omega,
            a: pose.dx * alpha + pose.d2x * omega * omega,
            phi: pose.phi(),
            reactions,
            driving_torque,
            clearance: None,
        }
    }
}
