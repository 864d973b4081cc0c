//! The motion of a finished run: crank angle and speed at any time inside it.

use std::fmt;
use std::sync::Arc;

use crate::engine::energy::Orbit;
use crate::engine::step::Step;
use crate::numeric::angle::Angle;

/// A dense trajectory; the same type from every engine.
#[derive(Clone, Debug)]
pub struct Trajectory {
    motion: Motion,
    end: f64,
    view: Option<View>,
}

type CrankOf = dyn Fn(Angle, f64) -> (Angle, f64) + Send + Sync;

/// Crank angle and speed from those of another coordinate.
#[derive(Clone)]
struct View(Arc<CrankOf>);

impl fmt::Debug for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("View")
    }
}

#[derive(Clone, Debug)]
enum Motion {
    Uniform { angle: Angle, speed: f64 },
    Orbit(Box<Orbit>),
    Steps(Vec<Step>),
}

impl Trajectory {
    /// Constant speed (rad/s) from `angle` at t = 0 until `end`, s.
    pub fn uniform(angle: Angle, speed: f64, end: f64) -> Trajectory {
        Trajectory {
            motion: Motion::Uniform { angle, speed },
            end,
            view: None,
        }
    }

    /// A motion known from its energy, until `end`, s.
    pub fn orbit(orbit: Orbit, end: f64) -> Trajectory {
        Trajectory {
            motion: Motion::Orbit(Box::new(orbit)),
            end,
            view: None,
        }
    }

    /// Refined steps, each beginning where the one before ends, until `end`, s.
    pub fn from_steps(steps: Vec<Step>, end: f64) -> Trajectory {
        Trajectory {
            motion: Motion::Steps(steps),
            end,
            view: None,
        }
    }

    /// The same steps, of a coordinate from which `view` gives crank angle and speed.
    pub fn seen_as(mut self, view: Arc<CrankOf>) -> Trajectory {
        self.view = Some(View(view));
        self
    }

    /// Last time, s; the first is 0.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Crank angle, as turns and rest, and speed (rad/s) at time `t` (s); none outside the run.
    pub fn state(&self, t: f64) -> Option<(Angle, f64)> {
        if !(0.0..=self.end).contains(&t) {
            return None;
        }
        match &self.motion {
            Motion::Uniform { angle, speed } => Some((angle.plus(speed * t), *speed)),
            Motion::Orbit(orbit) => Some(orbit.state(t)),
            Motion::Steps(steps) => {
                let after = steps.partition_point(|step| step.end.t < t);
                let step = steps.get(after)?;
                let (theta, omega) = step.at(t);
                let angle = step.angle(theta);
                Some(match &self.view {
                    Some(View(crank)) => crank(angle, omega),
                    None => (angle, omega),
                })
            }
        }
    }

    /// Unwrapped crank angle (rad) and speed (rad/s) at time `t` (s); none outside the run.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
        let (angle, speed) = self.state(t)?;
        Some((angle.radians(), speed))
    }
}
