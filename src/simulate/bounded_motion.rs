//! Whether a crank that swings to and fro will ever do anything else.
//!
//! Without loads in time the motion is a path in the plane of angle and speed, and paths do not cross where the state
//! says what follows. From turning point to turning point each arc of one direction lies inside or outside the one
//! before it in that direction: turning points on one side move inwards for ever or outwards for ever. One that lies
//! inside an earlier one encloses all that follows (Andronov, Vitt & Khaikin, Theory of Oscillators, on the sequence
//! function). Outwards they may lead to a swing of its own that is never left, as that of a clock: then one further out
//! moves inwards, and encloses it. Where it suffices that the state says what follows, and not what was before, friction is no exception:
//! paths may join.

use super::enclosed_swing::further_out;
use super::run_setup::RunSetup;
use crate::numeric::angle::Angle;
use crate::scene::{Extent, Variable};

/// A turning point is inside another one by this part of the swing at least: far more than a run in time is off.
const CLEARLY: f64 = 1e-3;
/// With friction a crank that is caught may turn so many times more: mostly it comes to rest, which says more.
const UNTIL_REST: u32 = 200;

/// Turning points after which a larger swing is tried first; then it is after twice as many.
const FIRST_TRIAL: u64 = 6;

/// Under loads in time anything may follow. So many turning points, and as many as there were before, that lead no
/// further out are taken as an answer.
const ENOUGH: u64 = 10_000;

/// The turning points of a run that ends after a number of turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swing {
    /// Turning points furthest out, if the loads depend on the time.
    furthest: Option<Furthest>,
    /// The last turning points, how many there were, and after how many a larger swing is tried.
    recent: [Angle; 5],
    count: u64,
    trial: u64,
    /// Whether no load takes or gives energy: then the swing from one turning point to another repeats.
    conserves: bool,
    /// The start, or a turning point,
    from: Angle,
    /// the turning point after it,
    to: Option<Angle>,
    /// and the last one.
    last: Angle,
    /// The angles between which it swings for ever.
    caught: Option<[Angle; 2]>,
    /// Turning points for which it may go on when it is caught.
    patience: u32,
    /// Turns that it then never completes.
    turns: f64,
}

impl Swing {
    /// None if the run has a last time. `start`: of the coordinate.
    pub fn new(task: &RunSetup<'_>, start: Angle) -> Option<Swing> {
        let reads = task.equation().loads().reads();
        let Extent::Revolutions(turns) = task.extent else {
            return None;
        };
        let of_speed = reads.has(Variable::Omega) || reads.has(Variable::V);
        let rubs = task.scene.reduced().friction.is_some() || task.equation().loads().are_dry();
        Some(Swing {
            furthest: reads.has(Variable::T).then(|| Furthest::new(start)),
            recent: [start; 5],
            count: 0,
            trial: FIRST_TRIAL,
            conserves: !of_speed && !rubs,
            from: start,
            to: None,
            last: start,
            caught: None,
            patience: if rubs { UNTIL_REST } else { 0 },
            turns,
        })
    }

    /// Takes a turning point; whether the run may end there, as the motion stays between it and the one before, or inside
    /// the swing that `enclosed` finds from rest at an angle further out.
    pub fn turns_at(
        &mut self,
        at: Angle,
        enclosed: impl FnOnce(Angle) -> Option<[Angle; 2]>,
    ) -> bool {
        if let Some(furthest) = &mut self.furthest {
            self.caught = furthest.turns_at(at);
            return self.caught.is_some();
        }
        let before = std::mem::replace(&mut self.last, at);
        let Some(to) = self.to else {
            self.to = Some(at).filter(|_| at != self.from);
            return false;
        };
        let width = to.minus(self.from);
        let is_beside_to = at.minus(before) * width > 0.0;
        let inside = match is_beside_to {
            true => to.minus(at) / width,
            false => at.minus(self.from) / width,
        };
        if self.conserves || (CLEARLY..=1.0).contains(&inside) {
            self.caught = (self.patience == 0).then_some([before, at]);
            self.patience = self.patience.saturating_sub(1);
        }
        if inside < 0.0 {
            (self.from, self.to) = (before, Some(at));
        }
        if self.caught.is_none() && self.patience == 0 {
            self.caught = self.further_out(at).and_then(enclosed);
        }
        self.caught.is_some()
    }

    /// Where to start a larger swing, if it is time to try one.
    fn further_out(&mut self, at: Angle) -> Option<Angle> {
        self.recent.rotate_left(1);
        self.recent[4] = at;
        self.count += 1;
        if self.count < self.trial {
            return None;
        }
        let from = further_out(&self.recent)?;
        self.trial = 2 * self.count;
        Some(from)
    }

    pub fn is_caught(&self) -> bool {
        self.caught.is_some()
    }

    /// Why the run ends at this time (s), in words; `crank`: crank angle of the coordinate.
    pub fn why(&self, t: f64, crank: impl Fn(Angle) -> Angle) -> Option<String> {
        let [from, to] = self.caught?.map(|at| crank(at).radians());
        let turns = self.turns;
        if let Some(Furthest { since, .. }) = self.furthest {
            return Some(format!(
                "the crank swings to and fro and does not complete {turns} turns: in its last {since} turning points it came no further than theta = {from} rad and {to} rad; stopped at t = {t} s; loads in t may change that later: give a duration instead"
            ));
        }
        Some(format!(
            "the crank swings to and fro and does not complete {turns} turns: it stays between theta = {from} rad and {to} rad; stopped at t = {t} s; give a duration instead"
        ))
    }
}

/// The turning points that are furthest out, while loads depend on the time.
#[derive(Clone, Copy, Debug)]
struct Furthest {
    /// To both sides.
    reach: [Angle; 2],
    /// Turning points since one led further out, and before.
    since: u64,
    before: u64,
}

impl Furthest {
    fn new(start: Angle) -> Furthest {
        Furthest {
            reach: [start; 2],
            since: 0,
            before: 0,
        }
    }

    /// Takes a turning point; the reach, if it is taken as the last word.
    fn turns_at(&mut self, at: Angle) -> Option<[Angle; 2]> {
        let [low, high] = self.reach;
        let clearly = CLEARLY * high.minus(low);
        let (above, below) = (at.minus(high), low.minus(at));
        if above.max(below) > clearly {
            let side = usize::from(above > 0.0);
            self.reach[side] = at;
            self.before += self.since + 1;
            self.since = 0;
        } else {
            self.since += 1;
        }
        (self.since >= ENOUGH.max(self.before)).then_some(self.reach)
    }
}
