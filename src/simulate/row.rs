//! Output rows: state of the mechanism at one time, receivers of rows, and the maker of rows from states of the crank.

use std::sync::Arc;

use super::guide_friction::GuideFriction;
use crate::engine::time::MotionState;
use crate::error::Error;
use crate::mechanism::{Equation, Reactions, Reactor};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Interval, MotionPiece};
use crate::scene::Load;

/// Output row: state of the mechanism at one time, in SI units and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time, s.
    pub t: f64,
    /// Crank angle, rad, unwrapped.
    pub theta: f64,
    /// Crank speed, rad/s.
    pub omega: f64,
    /// Crank acceleration, rad/s².
    pub alpha: f64,
    /// Slider position, m
    pub x: f64,
    /// Slider velocity, m/s
    pub v: f64,
    /// Slider acceleration, m/s²
    pub a: f64,
    /// Rod inclination, rad
    pub phi: f64,
    /// Joint and guide forces, N, if asked for.
    pub reactions: Option<Reactions>,
    /// Torque that drives the crank in addition to the loads, N m, if asked for.
    pub driving_torque: Option<f64>,
    /// State of the loose joint, if there is one; `x`, `v`, `a` and `phi` then belong to the free rod.
    pub clearance: Option<LooseRow>,
}

/// Loose joint at one time, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LooseRow {
    /// Position (m), velocity (m/s) and acceleration (m/s²) of a slider with ideal joints at this crank motion.
    pub ideal: [f64; 3],
    /// Position of the journal centre relative to the bearing centre, m.
    pub journal: [f64; 2],
    /// Normal force in the joint, N.
    pub force: f64,
}

/// Receiver of the rows of a run, as they are computed.
pub trait RowSink {
    /// Whether rows are wanted; if not, none are computed.
    fn wants_rows(&self) -> bool {
        true
    }

    /// Takes one row.
    ///
    /// # Errors
    /// An error ends the run.
    fn row(&mut self, row: &Row) -> Result<(), Error>;

    /// Whether states at steps are wanted in addition: impacts in a loose joint are shorter than the time between rows.
    fn wants_steps(&self) -> bool {
        false
    }

    /// Takes the state at a step of the computation.
    ///
    /// # Errors
    /// An error ends the run.
    fn step(&mut self, _: &Row) -> Result<(), Error> {
        Ok(())
    }
}

/// Receiver that wants no rows.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoRows;

impl RowSink for NoRows {
    fn wants_rows(&self) -> bool {
        false
    }

    fn row(&mut self, _: &Row) -> Result<(), Error> {
        Ok(())
    }
}

impl RowSink for Vec<Row> {
    fn row(&mut self, row: &Row) -> Result<(), Error> {
        self.push(*row);
        Ok(())
    }
}

/// Maker of rows: kinematics, accelerations and joint forces from states of the crank.
#[derive(Clone, Debug)]
pub(super) struct RowMaker {
    pub equation: Arc<Equation>,
    pub reactor: Option<Arc<Reactor>>,
    pub driving_torque: bool,
    /// Guide, if it has friction.
    pub guide: Option<Arc<GuideFriction>>,
}

impl RowMaker {
    /// Returns the load without a finite value at a state, or with a pole within its rounding, if there is one.
    pub fn without_value(&self, at: MotionState) -> Option<Load> {
        let (linkage, loads) = (self.equation.linkage(), self.equation.loads());
        let pose = linkage.pose(at.angle.rest);
        let now = pose.instant(at.t, at.angle, at.speed);
        let near = |value: f64| Interval::point(value).widened(1e-9 * value.abs().max(1.0));
        let piece = MotionPiece {
            t: near(at.t),
            angle: near(at.angle.radians()),
            speed: near(at.speed),
        };
        let unbounded = || loads.unbounded(&linkage.enclosed_state(&piece, loads.slider_use()));
        loads.without_value(&now).or_else(unbounded).cloned()
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
