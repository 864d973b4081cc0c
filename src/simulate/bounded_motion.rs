//! When a run of a number of turns is given up: a crank that swings to and fro has come no further for long.

use super::run_setup::RunSetup;
use super::stop::Why;
use crate::numeric::angle::Angle;
use crate::scene::{Extent, Variable};

/// A turning point counts as further out from this part of the swing on: far more than a run in time is off.
const FURTHER: f64 = 1e-3;

/// The turning points of a run that ends after a number of turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swing {
    /// Turning points furthest out, to both sides.
    reach: [Angle; 2],
    /// Turning points since one led further out, and before it.
    since: u64,
    before: u64,
    /// Turning points without a further one after which the swing is taken to stay as it is.
    enough: u64,
    turns: f64,
}

impl Swing {
    /// None if the run has a last time. `start`: of the coordinate.
    pub fn new(task: &RunSetup<'_>, start: Angle) -> Option<Swing> {
        let Extent::Revolutions(turns) = task.extent else {
            return None;
        };
        let loads = task.equation().loads();
        // Friction brings most swings to rest, which says more, and loads in time may push the crank later: both are waited for.
        let enough = match task.scene.reduced().friction {
            _ if task.one_way => 0,
            _ if loads.reads().has(Variable::T) => 10_000,
            None if !loads.are_dry() => 50,
            _ => 200,
        };
        Some(Swing {
            reach: [start; 2],
            since: 0,
            before: 0,
            enough,
            turns,
        })
    }

    pub fn turns_at(&mut self, at: Angle) {
        let [low, high] = self.reach;
        let (above, below) = (at.minus(high), low.minus(at));
        if above.max(below) > FURTHER * high.minus(low) {
            self.reach[usize::from(above > 0.0)] = at;
            self.before += self.since + 1;
            self.since = 0;
        } else {
            self.since += 1;
        }
    }

    /// Whether it led no further for so long, and as long as it took to get there, that the run ends.
    pub fn is_caught(&self) -> bool {
        let seen = self.since + self.before;
        seen > 0 && (self.enough == 0 || self.since >= self.enough.max(self.before))
    }

    /// Why the run ends; `crank`: crank angle of the coordinate.
    pub fn why(&self, crank: impl Fn(Angle) -> Angle) -> Option<Why> {
        self.is_caught().then(|| Why::Caught {
            turns: self.turns,
            since: self.since,
            reach: self.reach.map(|at| crank(at).radians()),
        })
    }
}
