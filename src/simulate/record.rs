//! What was recorded of a run, when it has ended.

use std::time::{Duration, Instant};

use super::checkpoints::Checkpoints;
use super::dense_rows::Spell;
use super::result::{Event, Piece};
use crate::trajectory::Trajectory;

/// What was recorded of a run.
#[derive(Debug)]
pub(super) struct Record {
    /// The first events, at most as many as were asked for.
    pub events: Vec<Event>,
    pub events_total: u64,
    /// Least and largest crank speed, rad/s.
    pub speed: (f64, f64),
    /// Pieces of the dense motion, if there was room for all.
    pub pieces: Option<Vec<Trajectory>>,
    /// How the slider touched its guide, where the motion was computed along a configuration curve.
    pub spells: Vec<Spell>,
    /// Which engines ran, if they took turns.
    pub engines: Vec<Piece>,
    /// States on the way.
    pub checkpoints: Checkpoints,
    /// Time spent on rows.
    pub row_time: Duration,
}

impl Record {
    /// Of a run that starts with this speed, rad/s.
    pub fn new(speed: f64) -> Record {
        Record {
            events: Vec::new(),
            events_total: 0,
            speed: (speed, speed),
            pieces: None,
            spells: Vec::new(),
            engines: Vec::new(),
            checkpoints: Checkpoints::default(),
            row_time: Duration::ZERO,
        }
    }

    /// Wall time since the run began, without that of its rows, s.
    pub fn wall_s(&self, begun: Instant) -> f64 {
        begun.elapsed().saturating_sub(self.row_time).as_secs_f64()
    }

    /// Largest crank speed in either sense, rad/s.
    pub fn fastest(&self) -> f64 {
        self.speed.0.abs().max(self.speed.1.abs())
    }
}
