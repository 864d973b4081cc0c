//! Trajectory of a finished run: crank angle and speed at any time within it, from the dense output of the engines.

use std::fmt;
use std::sync::Arc;

use crate::engine::energy::Orbit;
use crate::engine::step::Step;
use crate::numeric::angle::Angle;

/// Dense trajectory, one type for all engines.
#[derive(Clone, Debug)]
pub struct Trajectory {
    motion: Stored,
    begin: f64,
    end: f64,
    /// Map of the stored coordinate to the crank, if it is another one.
    map: Option<Arc<dyn CrankMap>>,
}

/// Map of another coordinate to the crank.
pub(crate) trait CrankMap: fmt::Debug + Send + Sync {
    /// Returns crank angle and crank speed (rad/s) from angle and speed (rad/s) of the coordinate.
    fn crank(&self, angle: Angle, speed: f64) -> (Angle, f64);
}

#[derive(Clone, Debug)]
enum Stored {
    Uniform {
        angle: Angle,
        speed: f64,
    },
    Orbit(Box<Orbit>),
    Steps(Vec<Step>),
    /// Consecutive pieces; each begins where the one before ends.
    Pieces(Vec<Trajectory>),
}

impl Trajectory {
    fn new(motion: Stored, begin: f64, end: f64) -> Trajectory {
        Trajectory {
            motion,
            begin,
            end,
            map: None,
        }
    }

    /// Creates a motion at constant speed (rad/s) from `angle` at t = 0 until `end`, s.
    pub fn uniform(angle: Angle, speed: f64, end: f64) -> Trajectory {
        Trajectory::new(Stored::Uniform { angle, speed }, 0.0, end)
    }

    /// Creates a trajectory from a motion over the crank angle that begins at time `begin`, until `end`, s.
    pub fn orbit(orbit: Orbit, begin: f64, end: f64) -> Trajectory {
        Trajectory::new(Stored::Orbit(Box::new(orbit)), begin, end)
    }

    /// Creates a trajectory from refined steps, each beginning where the one before ends, until `end`, s.
    pub fn from_steps(steps: Vec<Step>, end: f64) -> Trajectory {
        let begin = steps.first().map_or(end, |step| step.start.t);
        Trajectory::new(Stored::Steps(steps), begin, end)
    }

    /// Joins pieces in the crank angle, each beginning where the one before ends.
    ///
    /// ```
    /// use slider_crank::numeric::angle::Angle;
    /// use slider_crank::trajectory::Trajectory;
    /// let whole = Trajectory::joined(vec![Trajectory::uniform(Angle::from(0.5), 2.0, 1.0)]);
    /// assert_eq!(whole.at(0.5), Some((1.5, 2.0)));
    /// assert_eq!(whole.at(1.5), None);
    /// ```
    pub fn joined(pieces: Vec<Trajectory>) -> Trajectory {
        let begin = pieces.first().map_or(0.0, |piece| piece.begin);
        let end = pieces.last().map_or(0.0, |piece| piece.end);
        Trajectory::new(Stored::Pieces(pieces), begin, end)
    }

    /// Maps a trajectory of another coordinate to the crank.
    pub(crate) fn mapped_to_crank(mut self, map: Arc<dyn CrankMap>) -> Trajectory {
        self.map = Some(map);
        self
    }

    /// Returns the last time, s; a whole run begins at 0.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Returns the crank angle, as turns and rest, and speed (rad/s) at time `t` (s); none outside the run.
    pub fn state(&self, t: f64) -> Option<(Angle, f64)> {
        let (angle, speed) = self.coordinate(t)?;
        Some(match &self.map {
            Some(map) => map.crank(angle, speed),
            None => (angle, speed),
        })
    }

    /// Returns the period, s, of a motion over the crank angle, if it repeats.
    pub(crate) fn period(&self) -> Option<f64> {
        match &self.motion {
            Stored::Orbit(orbit) => orbit.period().map(|(period, _)| period),
            _ => None,
        }
    }

    /// Returns the angle at t = 0 and the speed (rad/s) of a motion at constant speed; none for others.
    pub(crate) fn as_uniform(&self) -> Option<(Angle, f64)> {
        match self.motion {
            Stored::Uniform { angle, speed } => Some((angle, speed)),
            _ => None,
        }
    }

    /// Returns the motion over the crank angle if it is the whole trajectory.
    pub(crate) fn as_orbit(&self) -> Option<&Orbit> {
        match &self.motion {
            Stored::Orbit(orbit) if self.map.is_none() && self.begin == 0.0 => Some(orbit),
            _ => None,
        }
    }

    /// Returns the integrated coordinate (crank angle or coordinate of the configuration curve), an angle as turns and
    /// rest, and its rate (rad/s) at time `t` (s); none outside the run.
    pub(crate) fn coordinate(&self, t: f64) -> Option<(Angle, f64)> {
        if !(self.begin..=self.end).contains(&t) {
            return None;
        }
        match &self.motion {
            Stored::Uniform { angle, speed } => Some((angle.plus(speed * t), *speed)),
            Stored::Orbit(orbit) => Some(orbit.state(t - self.begin)),
            Stored::Pieces(pieces) => {
                let after = pieces.partition_point(|piece| piece.end < t);
                pieces.get(after)?.state(t)
            }
            Stored::Steps(steps) => {
                let after = steps.partition_point(|step| step.end.t < t);
                let step = steps.get(after)?;
                let (theta, omega) = step.at(t);
                Some((step.angle(theta), omega))
            }
        }
    }

    /// Returns the unwrapped crank angle (rad) and speed (rad/s) at time `t` (s); none outside the run.
    pub fn at(&self, t: f64) -> Option<(f64, f64)> {
        let (angle, speed) = self.state(t)?;
        Some((angle.radians(), speed))
    }
}
