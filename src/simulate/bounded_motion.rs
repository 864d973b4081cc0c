//! Bounded motion: detects a crank that swings to and fro and will not complete its turns, from its turning points.

use super::run_setup::RunSetup;
use super::stop::Why;
use crate::numeric::angle::Angle;
use crate::scene::{Extent, Variable};

/// Record of the turning points of a run that ends after a number of turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundedMotion {
    /// Outermost turning points on the lower and upper side, angles of the coordinate.
    reach: [Angle; 2],
    /// Number of turning points after the last one that was further out, and up to it.
    since: u64,
    before: u64,
    /// Number of turning points without one further out from which the swing counts as bounded.
    least_count: u64,
    turns: f64,
}

impl BoundedMotion {
    /// Starts a record at angle `start` of the coordinate; none if the run has a last time.
    pub fn new(task: &RunSetup<'_>, start: Angle) -> Option<BoundedMotion> {
        let Extent::Revolutions(turns) = task.extent else {
            return None;
        };
        // Friction brings most swings to rest, which says more; loads in time may push the crank later: wait for both.
        let least_count = if task.stops_at_reversal {
            0
        } else if task.equation().loads().reads.has(Variable::T) {
            10_000
        } else if task.may_stick() {
            200
        } else {
            50
        };
        Some(BoundedMotion {
            reach: [start; 2],
            since: 0,
            before: 0,
            least_count,
            turns,
        })
    }

    pub fn add_turning_point(&mut self, at: Angle) {
        let [low, high] = self.reach;
        let (above, below) = (at.minus(high), low.minus(at));
        // Least growth of the swing, as part of its range: far above the errors of turning points.
        let growth = 1e-3;
        if above.max(below) > growth * high.minus(low) {
            self.reach[usize::from(above > 0.0)] = at;
            self.before += self.since + 1;
            self.since = 0;
        } else {
            self.since += 1;
        }
    }

    /// Whether the last turning points, at least `least_count` and as many as all before, have led no further.
    pub fn is_bounded(&self) -> bool {
        let seen = self.since + self.before;
        seen > 0 && (self.least_count == 0 || self.since >= self.least_count.max(self.before))
    }

    /// Returns the reason for the end if the crank is caught; `crank` maps the coordinate to the crank angle.
    pub fn why(&self, crank: impl Fn(Angle) -> Angle) -> Option<Why> {
        self.is_bounded().then(|| Why::Caught {
            turns: self.turns,
            since: self.since,
            reach: self.reach.map(|at| crank(at).radians()),
        })
    }
}
