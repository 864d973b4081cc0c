//! What is noted of a run while it is computed, piece by piece, whatever engine computes the pieces.

use std::time::{Duration, Instant};

use super::checkpoints::Checkpoints;
use super::passages::{self, Stretch};
use super::result::Event;
use super::run_setup::RunSetup;
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::trajectory::Trajectory;

/// Writes the row of a time (s), an angle and a speed (rad/s).
pub(super) type Write<'a> = dyn FnMut(f64, Angle, f64) -> Result<(), Error> + 'a;

/// Events, extreme speeds, rows and pieces so far.
#[derive(Debug)]
pub(super) struct Log {
    /// The first ones.
    pub events: Vec<Event>,
    pub events_total: u64,
    kept: usize,
    /// Least and largest crank speed, rad/s.
    pub speed: (f64, f64),
    /// Index of the next row at a time; 0 before the first row of all.
    pub next_row: u64,
    /// States on the way.
    pub checkpoints: Checkpoints,
    /// Time spent on rows.
    pub row_time: Duration,
    /// Steps and pieces of the motion that may still be kept.
    room: usize,
    /// Pieces of the motion, while there is room for them.
    pub pieces: Option<Vec<Trajectory>>,
}

impl Log {
    /// Before a run that starts with this speed, rad/s.
    pub fn new(task: &RunSetup<'_>) -> Log {
        let speed = task.scene.motion.speed;
        Log {
            events: Vec::new(),
            events_total: 0,
            kept: task.options.events_kept,
            speed: (speed, speed),
            next_row: 0,
            checkpoints: Checkpoints::default(),
            row_time: Duration::ZERO,
            room: task.kept,
            pieces: (task.kept > 0).then(Vec::new),
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

    /// Whether there is room for another event.
    pub fn keeps_more(&self) -> bool {
        self.events.len() < self.kept
    }

    /// Counts an event, and keeps it if there is room.
    pub fn event(&mut self, event: impl FnOnce() -> Event) {
        self.events_total += 1;
        if self.keeps_more() {
            self.events.push(event());
        }
    }

    /// Takes least and largest speed (rad/s) of a piece.
    pub fn speeds(&mut self, (low, high): (f64, f64)) {
        self.speed = (self.speed.0.min(low), self.speed.1.max(high));
    }

    /// Takes a piece over the crank angle: its events, its rows if they are wanted, its speeds.
    pub fn stretch(
        &mut self,
        task: &RunSetup<'_>,
        stretch: &Stretch<'_>,
        write: Option<&mut Write<'_>>,
    ) -> Result<(), Error> {
        let left = self.kept - self.events.len();
        let (events, total) = passages::events(task, stretch, left);
        self.events.extend(events);
        self.events_total += total;
        self.speeds(stretch.orbit.speed_range(stretch.end));
        if let Some(write) = write {
            let begun = Instant::now();
            let result = passages::write_rows(task, stretch, &mut self.next_row, write);
            self.row_time += begun.elapsed();
            result?;
        }
        Ok(())
    }

    /// Takes room for a step or a piece of the motion; where there is none, nothing of it is kept.
    pub fn take_room(&mut self) -> bool {
        let room = self.room.checked_sub(1);
        self.room = room.unwrap_or(0);
        if room.is_none() {
            self.pieces = None;
        }
        room.is_some()
    }

    /// Keeps a piece of the motion, if there is room.
    pub fn keep(&mut self, piece: impl FnOnce() -> Trajectory) {
        if self.take_room()
            && let Some(pieces) = &mut self.pieces
        {
            pieces.push(piece());
        }
    }
}
