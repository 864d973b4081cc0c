//! One cycle and its motion, however it is computed.

use super::super::angle_model::AngleModel;
use crate::engine::angle::{Cycle, CycleMap, Turns};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::trajectory::Trajectory;

/// A cycle.
pub(super) struct Round {
    pub motion: Motion,
    /// s
    pub period: f64,
    /// Speed at its start, rad/s.
    pub speed: f64,
    /// Kinetic energy it gains, J.
    pub gain: f64,
    /// Largest kinetic energy, J.
    pub largest: f64,
    /// What is left open of its energies, relative to them.
    pub uncertain: f64,
}

/// Motion of one cycle.
pub(super) enum Motion {
    /// Over the crank angle.
    Orbit(Box<Orbit>),
    /// In time, from an angle on.
    Timed {
        trajectory: Box<Trajectory>,
        start: Angle,
    },
}

impl Motion {
    /// Speed (rad/s) where the crank has turned by this since the start, rad.
    pub fn omega(&self, turned: f64) -> f64 {
        let speed = match self {
            Motion::Orbit(orbit) => orbit.passage(turned).map(|(_, speed)| speed),
            Motion::Timed { trajectory, start } => {
                let state = |t: f64| trajectory.state(t);
                let ahead = |t: f64| {
                    let way = |(angle, _): (Angle, f64)| angle.minus(*start).abs();
                    state(t).map_or(f64::NAN, way) - turned
                };
                let end = trajectory.end();
                // At the end the way is rounded.
                let t = root::bracketed(ahead, 0.0, end).unwrap_or(end);
                state(t).map(|(_, speed)| speed)
            }
        };
        speed.unwrap_or(f64::NAN)
    }
}

/// What runs through cycles.
pub(super) trait Rounds: CycleMap {
    /// The cycle that begins with a kinetic energy, J.
    fn round(&mut self, kinetic: f64) -> Result<Round, NotApplicable>;
}

impl Rounds for Turns<'_, AngleModel<'_>> {
    fn round(&mut self, kinetic: f64) -> Result<Round, NotApplicable> {
        let Cycle {
            orbit,
            period,
            speed,
            gain,
            largest,
            uncertain,
        } = self.turn(kinetic)?;
        Ok(Round {
            motion: Motion::Orbit(Box::new(orbit)),
            period,
            speed,
            gain,
            largest,
            uncertain,
        })
    }
}
