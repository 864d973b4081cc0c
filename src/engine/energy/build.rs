//! Panels, one after the other, until a motion turns back, repeats or is long enough.

use std::f64::consts::TAU;

use super::home::Return;
use super::leg::{After, Leg};
use super::panel::{DEGREE, Panel, Tried, Uncertain};
use super::piece::{LONGEST, Piece, Turning, missing, next_end};
use super::{Profile, Unserved};

/// Where a leg begins.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Begin {
    /// rad
    pub start: f64,
    /// +1 or −1
    pub direction: f64,
    /// J; without it the start is a turning point.
    pub kinetic: f64,
    /// How far it may be off beside its own rounding, J.
    pub off: f64,
}

/// Most panels that are tried for a leg.
const MOST_ATTEMPTS: usize = 200_000;
/// Panels no longer than this are taken as they are, rad: a corner that nobody announced.
const SHORTEST: f64 = 1e-13;
/// Below this part of the largest kinetic energy its sum over the panels has lost digits.
const NEAR_REST: f64 = 1e-3;

/// A turning point is off by less than this part of the last panel: linear in the force there.
const SLIGHT: f64 = 1e-3;

/// The energy that a panel uses up goes with the square of its first speed, a sum of so many additions, each rounded by
/// half a unit: it is seen to so many units.
const SEEN: f64 = DEGREE as f64;

/// How a turning point was found.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    /// On a panel from this angle on which the motion would turn before its end: to the rounding of that one.
    OnPanel(f64),
    /// By the energy that the last panel uses up.
    ByEnergy,
    /// By the short way to the end of the turn.
    FromHome,
}

/// A leg that is being built.
struct Builder<'a> {
    profile: &'a dyn Profile,
    begin: Begin,
    /// The start, a turn later, rad.
    whole_turn: f64,
    /// Kinetic energy that each turn gains, if it is the same in each, J.
    gain: Option<f64>,
    /// How far that may be off, J.
    gain_error: f64,
    home: Option<Return<'a>>,
    leg: Leg,
    /// Where the next panel begins, rad.
    at: f64,
    /// Kinetic energy there, and the largest so far, J.
    kinetic: f64,
    largest: f64,
    /// How far it may be off beside its own rounding, J.
    off: f64,
    /// Length of the next panel at most, rad.
    length: f64,
    turns_at: Option<f64>,
    /// How exact that angle is.
    known: Known,
    turns: f64,
}

impl Leg {
    /// Panels until the time `until` is passed or `most_turns` are complete, if the forces are the same in each;
    /// their series end where they have decayed to `tolerance`.
    pub fn build(
        profile: &dyn Profile,
        begin: Begin,
        until: f64,
        tolerance: f64,
        most_turns: f64,
    ) -> Result<Leg, Unserved> {
        let whole_turn = begin.start + begin.direction * TAU;
        let work = profile.work_of_turn();
        let mut builder = Builder {
            profile,
            begin,
            whole_turn,
            gain: work.map(|(work, _)| begin.direction * work),
            gain_error: work.map_or(0.0, |(_, error)| error),
            home: Return::new(profile, whole_turn, begin.kinetic),
            leg: Leg::open(),
            at: begin.start,
            kinetic: begin.kinetic,
            largest: begin.kinetic,
            off: begin.off,
            length: LONGEST,
            turns_at: None,
            known: Known::OnPanel(begin.start),
            turns: 0.0,
        };
        let mut attempts = 0;
        while builder.leg.after == After::Ends
            && (builder.leg.len() == 0 || builder.leg.duration.0 <= until)
        {
            attempts += 1;
            if attempts > MOST_ATTEMPTS {
                return Err(Unserved::TooLong);
            }
            if builder.leg.len() > 0 && profile.is_spent() {
                break;
            }
            builder.panel(tolerance)?;
            if builder.is_home() {
                builder.turn(until, most_turns);
            }
        }
        Ok(builder.leg)
    }
}

impl Builder<'_> {
    /// Tries the next panel: takes it, or makes it shorter.
    fn panel(&mut self, tolerance: f64) -> Result<(), Unserved> {
        let piece = self.piece();
        let uncertain = self.uncertain(piece.turning);
        let (at, to) = (piece.from, piece.to);
        let short = (to - at).abs() <= SHORTEST * at.abs().max(1.0);
        let accepted = if short { f64::INFINITY } else { tolerance };
        match Panel::attempt(self.profile, piece, self.kinetic, accepted, uncertain)? {
            Tried::Done(panel, off) => match self.turns_rather_at(&panel) {
                Some(end) => self.turns_at = Some(end),
                None => self.take(*panel, off),
            },
            Tried::TurnsAt(end) if end != at => {
                let home = self.home.as_ref();
                let exact = home.and_then(|again| again.turning_point(at, end));
                self.known = exact.map_or(Known::OnPanel(at), |_| Known::FromHome);
                self.turns_at = Some(exact.unwrap_or(end));
            }
            _ if short => return Err(Unserved::NotFinite),
            _ => self.length = 0.5 * (to - at).abs(),
        }
        Ok(())
    }

    fn piece(&self) -> Piece {
        let direction = self.begin.direction;
        let mut to = next_end(self.profile.corners(), self.at, direction, self.length);
        to = self.profile.corner_between(self.at, to).unwrap_or(to);
        if self.gain.is_some() && direction * (to - self.whole_turn) > -1e-12 {
            to = self.whole_turn;
        }
        let mut turning = if self.kinetic == 0.0 {
            Turning::AtStart
        } else {
            Turning::Nowhere
        };
        if let Some(end) = self.turns_at.filter(|end| direction * (to - end) >= 0.0) {
            if turning == Turning::AtStart {
                // A panel cannot turn at both ends: the first half ends in the middle.
                to = 0.5 * (self.at + end);
            } else {
                to = end;
                turning = Turning::AtEnd;
            }
        }
        Piece {
            from: self.at,
            to,
            turning,
        }
    }

    /// How far the kinetic energy on the next panel may be off; near rest it is that of the way to the end of the turn,
    /// which keeps its digits.
    fn uncertain(&mut self, turning: Turning) -> Uncertain {
        if let Some(home) = &self.home
            && turning == Turning::AtEnd
            && self.known == Known::FromHome
        {
            return Uncertain::AtTurn(home.rounding());
        }
        if let Some(home) = &self.home
            && self.kinetic < NEAR_REST * self.largest
            && let Some(exact) = home.kinetic(self.at)
        {
            self.kinetic = exact;
            let to_go = (self.whole_turn - self.at).abs();
            let size = exact.max(self.begin.kinetic);
            return Uncertain::AtStart(f64::EPSILON * size * (1.0 + self.at.abs() / to_go));
        }
        Uncertain::AtStart(self.off + f64::EPSILON * self.largest)
    }

    /// Where a motion turns, if that is not where its last panel ends, rad: a turning point found on a longer panel is
    /// right to the rounding of that one, and the energy that the last one uses up says by how much it is off. Once:
    /// what is left then is the rounding of this energy.
    fn turns_rather_at(&mut self, panel: &Panel) -> Option<f64> {
        let Piece { from, to, turning } = panel.piece;
        // Later on the energy that is left has been rounded again.
        if turning != Turning::AtEnd || self.known != Known::OnPanel(from) {
            return None;
        }
        self.known = Known::ByEnergy;
        let used = 0.5 * self.profile.inertia_and_force(from).0 * panel.speed(-1.0).powi(2);
        let force = self.profile.inertia_and_force(to).1;
        let missed = (self.kinetic - used) / force.abs();
        let told = f64::EPSILON * to.abs() < missed.abs()
            && missed.abs() < SLIGHT * panel.piece.span().abs()
            && (self.kinetic - used).abs() > SEEN * f64::EPSILON * self.kinetic;
        told.then_some(to + self.begin.direction * missed)
    }

    fn take(&mut self, mut panel: Panel, off: f64) {
        self.off = self.off.hypot(off);
        let piece = panel.piece;
        self.at = piece.to;
        panel.turns = self.begin.direction * self.turns;
        self.kinetic = panel.kinetic_at_end;
        self.largest = self.largest.max(self.kinetic);
        self.length = 2.0 * piece.span().abs();
        self.leg.push(panel);
        if piece.turning == Turning::AtEnd {
            self.leg.after = After::TurnsBack;
        }
    }

    /// Whether a turn is complete after which the same forces follow.
    fn is_home(&self) -> bool {
        self.gain.is_some() && self.at == self.whole_turn && self.leg.after == After::Ends
    }

    fn turn(&mut self, until: f64, most_turns: f64) {
        let Begin {
            start, direction, ..
        } = self.begin;
        self.leg.complete(missing(start, direction));
        self.turns += 1.0;
        if self.profile.repeats() {
            self.leg.after = After::Repeats;
        } else if self.turns >= most_turns && self.leg.duration.0 <= until {
            self.leg.after = After::GoesOn;
        } else {
            self.at = start;
            self.off = self.turns.mul_add(self.gain_error, self.begin.off);
            let gain = self.gain.unwrap_or_default();
            self.kinetic = gain.mul_add(self.turns, self.begin.kinetic);
        }
    }
}
