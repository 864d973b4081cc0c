//! Time of many turns that gain the same energy each, by Euler-Maclaurin sums over cells of the kinetic energy.
//!
//! Where the forces depend on the angle alone and are the same in each turn, turn n begins with the kinetic energy K₀ +
//! nW. A million turns take a few dozen cells of the energy.

use super::euler_maclaurin::EulerMaclaurinCell;
use super::interpolated_turns::TurnStart;
use super::one_turn::OneTurn;
use super::piece::KineticState;
use super::profile::{NotApplicable, Profile};
use super::segment::{After, Segment};
use super::turns::{Map, RecentTurn, Turns};

/// Initial state of the turns, and the gain of each.
pub(super) struct EqualGains<'a> {
    pub profile: &'a dyn Profile,
    /// State before the first turn.
    pub begin: KineticState,
    /// Kinetic energy gained per turn, J.
    pub gain: f64,
    /// Error bound of the gain, J.
    pub gain_error: f64,
    /// Largest tail of a resolved series.
    pub tolerance: f64,
}

impl EqualGains<'_> {
    /// Estimates the time until the crank has lost a kinetic energy (J), s, under a constant torque, from the duration of
    /// a turn, s; infinite if it gains energy.
    pub fn time_to_rest(&self, kinetic: f64, duration: f64) -> f64 {
        match self.gain < 0.0 {
            true => 2.0 * kinetic / -self.gain * duration,
            false => f64::INFINITY,
        }
    }

    /// Returns the start of the turn after the first `turns`, at the time `t` (s, rounded value and remainder).
    fn mark(&self, turns: f64, t: (f64, f64)) -> TurnStart {
        TurnStart {
            turns,
            t,
            kinetic: turns.mul_add(self.gain, self.begin.kinetic),
            ..TurnStart::default()
        }
    }

    /// Returns the error bound of the kinetic energy after some turns, J.
    fn energy_error_after(&self, turns: f64) -> f64 {
        self.begin.energy_error + f64::EPSILON * self.begin.kinetic + turns * self.gain_error
    }

    /// Computes the turns from the first `done` turns, which end at the time `t` (s, rounded value and remainder), to
    /// the time `until`, s; none if the crank comes to rest or turns back before.
    pub fn turns(
        &self,
        done: f64,
        t: (f64, f64),
        until: f64,
    ) -> Result<Option<Turns>, NotApplicable> {
        let (mut cells, mut marks, mut error) = (Vec::new(), Vec::new(), 0.0);
        let mut mark = self.mark(done, t);
        let mut last = None;
        while last.is_none() && !self.profile.is_spent() {
            let Some(mut cell) = self.cell(mark, until) else {
                break;
            };
            marks.push(mark);
            let after = mark.until(until);
            let passed = cell.count.is_infinite() || cell.time(cell.count) > after;
            let mut whole = cell.count;
            if passed {
                cell.count = cell.turn_at(after);
                whole = cell.count + 1.0;
            }
            error += cell.error(whole, self.energy_error_after(mark.turns + whole));
            let end = cell.mark(cell.count);
            mark = if passed {
                last = Some(cell.turn.segment(end.kinetic));
                end
            } else {
                self.mark(end.turns, end.t)
            };
            cells.push(cell);
        }
        let last = match last {
            Some(segment) => segment,
            None if cells.is_empty() => return Ok(None),
            None => {
                let begin = KineticState {
                    kinetic: mark.kinetic,
                    energy_error: self.energy_error_after(mark.turns),
                    ..self.begin
                };
                let left = mark.until(until);
                // More turns after the last cell are not computed one by one.
                let most_turns = 256.0;
                let segment =
                    Segment::build(self.profile, begin, left, self.tolerance, most_turns)?;
                if segment.after != After::Ends {
                    return Ok(None);
                }
                error += segment.error;
                segment
            }
        };
        marks.push(mark);
        Ok(Some(Turns {
            map: Map::Gaining(cells),
            marks,
            last,
            recent: RecentTurn::default(),
            error,
        }))
    }

    fn one_turn(&self, kinetic: f64) -> Option<OneTurn> {
        let begin = KineticState {
            kinetic,
            energy_error: 0.0,
            ..self.begin
        };
        OneTurn::new(self.profile, begin)
    }

    /// Computes the cell that begins with a turn and goes no further than the time `until`, s; none too near rest.
    fn cell(&self, first: TurnStart, until: f64) -> Option<EulerMaclaurinCell> {
        let here = self.one_turn(first.kinetic)?;
        let least = Some(here.least(first.kinetic)).filter(|least| *least > 0.0)?;
        let (left, duration) = (first.until(until), here.duration(first.kinetic));
        if self.time_to_rest(least, duration) < left {
            return None;
        }
        // Turns to come at this speed; a constant torque makes the crank turn further by a quarter of their gain.
        let turns = left / duration;
        let further = (0.25 * turns * self.gain / first.kinetic).max(0.0);
        let needed = (turns * (1.0 + further) + 1.0) * self.gain.abs();
        // Largest width over the least kinetic energy in the first turn, and least width over the largest.
        let (widest, narrowest) = (EulerMaclaurinCell::widest_share(), 1e-3);
        // Of a crank that slows down, the width has the same ratio to the least energy at the other end of the cell.
        let widest = match self.gain >= 0.0 {
            true => widest * least,
            false => widest / (1.0 + widest) * least,
        };
        let cell = |share: f64| {
            let width = (share * widest).min(needed.max(narrowest * widest));
            let turn = match self.gain >= 0.0 {
                true => here.clone(),
                false => self.one_turn(first.kinetic - width)?,
            };
            EulerMaclaurinCell::new(first, least, width, self.gain, turn)
        };
        let shares = std::iter::successors(Some(1.0), |share| Some(0.5 * share));
        shares.take_while(|share| *share > narrowest).find_map(cell)
    }
}
