//! Construction of a segment: panels in sequence until the motion turns back, repeats or is long enough.

use std::cell::OnceCell;
use std::f64::consts::TAU;

use super::panel::{Attempt, KnownEnergy, Panel};
use super::piece::{
    HALF_TURN, KineticState, Piece, SAME_ANGLE, Turning, longest_analytic, next_end, turn_remainder,
};
use super::profile::{NotApplicable, Profile};
use super::segment::{After, MOST_PANELS, Segment};
use super::turn_end::TurnEnd;

/// Turning point ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TurningPoint {
    /// Signed distance to the turning point, rad.
    way: f64,
    /// True if the turning point was located from the end of the turn.
    from_turn_end: bool,
    /// Residual of the energy balance on the last panel that ended at the turning point, J.
    residual: f64,
}

/// Improvement to make on a panel.
enum Improvement {
    None,
    /// Replacement by a panel that ends at this turning point.
    Turning(TurningPoint),
    Shorter,
}

/// Segment under construction.
struct Builder<'a> {
    profile: &'a dyn Profile,
    begin: KineticState,
    /// Angle one turn after the start, rad.
    whole_turn: f64,
    /// Kinetic energy gained per turn, if it is equal for all turns, and its error bound, J.
    gain: Option<f64>,
    gain_error: f64,
    turn_end: Option<TurnEnd<'a>>,
    segment: Segment,
    /// State in which the next panel begins.
    now: KineticState,
    /// Largest kinetic energy so far, J.
    largest: f64,
    /// Largest length of the next panel, rad.
    length: f64,
    /// True if a panel longer than the branch points allow has failed.
    is_cut: bool,
    ahead: Option<TurningPoint>,
    turns: f64,
    branch_points: OnceCell<Vec<[f64; 2]>>,
}

impl Segment {
    /// Builds panels until the time `until` (s) is passed, or a turn is complete and more than `most_turns` turns with
    /// equal forces are to be expected in all; the tails of their series are below `tolerance`.
    pub fn build(
        profile: &dyn Profile,
        begin: KineticState,
        until: f64,
        tolerance: f64,
        most_turns: f64,
    ) -> Result<Segment, NotApplicable> {
        let whole_turn = begin.angle + begin.direction * TAU;
        let work = profile.work_of_turn();
        let mut builder = Builder {
            profile,
            begin,
            whole_turn,
            gain: work.map(|(work, _)| begin.direction * work),
            gain_error: work.map_or(0.0, |(_, error)| error),
            turn_end: TurnEnd::new(profile, whole_turn, begin.kinetic),
            segment: Segment::open(),
            now: begin,
            largest: begin.kinetic,
            length: HALF_TURN,
            is_cut: false,
            ahead: None,
            turns: 0.0,
            branch_points: OnceCell::new(),
        };
        let mut attempts = 0;
        while builder.segment.after == After::Ends
            && (builder.segment.panels.is_empty() || builder.segment.duration.0 <= until)
        {
            attempts += 1;
            if attempts > MOST_PANELS {
                return Err(NotApplicable::TooLong);
            }
            if !builder.segment.panels.is_empty() && profile.is_spent() {
                break;
            }
            builder.panel(tolerance)?;
            if builder.is_turn_complete() {
                builder.turn(until, most_turns);
            }
        }
        Ok(builder.segment)
    }
}

impl Builder<'_> {
    /// Tries the next panel: accepts it, shortens it, or ends it at a turning point.
    fn panel(&mut self, tolerance: f64) -> Result<(), NotApplicable> {
        let piece = self.piece();
        let known = self.known_energy(piece.turning);
        let at = piece.from;
        // A panel of this length, rad, is accepted unresolved: it holds a corner that the profile does not announce.
        let shortest = 1e-13 * at.abs().max(1.0);
        let short = piece.span.abs() <= shortest;
        if short && self.profile.has_pole(piece.to) {
            return Err(NotApplicable::NotFinite);
        }
        let accepted = if short { f64::INFINITY } else { tolerance };
        match Panel::attempt(self.profile, piece, self.now.kinetic, accepted, known)? {
            Attempt::Done(panel, energy_error) => match self.improvement(&panel, known) {
                Improvement::None => self.take(*panel, energy_error),
                Improvement::Turning(ahead) => self.ahead = Some(ahead),
                Improvement::Shorter if self.length <= shortest => {
                    return Err(NotApplicable::NotFinite);
                }
                Improvement::Shorter => {
                    // The turning point may be an artefact of rounding on the panel on which it was found.
                    self.ahead = None;
                    self.length *= 0.5;
                }
            },
            Attempt::TurnsAfter(way) if way != 0.0 => {
                let turn_end = self.turn_end.as_ref();
                let exact = turn_end.and_then(|turn_end| turn_end.turning_point(at, at + way));
                self.ahead = Some(TurningPoint {
                    way: exact.map_or(way, |end| end - at),
                    from_turn_end: exact.is_some(),
                    residual: f64::INFINITY,
                });
            }
            _ if short => return Err(NotApplicable::NotFinite),
            _ => self.shorten(piece.span.abs()),
        }
        Ok(())
    }

    /// Shortens the next panel after an unresolved one of length `span` (rad): to what the branch points allow, or by half.
    fn shorten(&mut self, span: f64) {
        if std::mem::replace(&mut self.is_cut, true) || self.analytic() >= span {
            self.length = 0.5 * span;
        }
    }

    /// Returns the largest length of the next panel, rad, that the branch points allow.
    fn analytic(&self) -> f64 {
        let branch_points = || self.profile.branch_points();
        let branch_points = self.branch_points.get_or_init(branch_points);
        longest_analytic(self.now.angle, self.now.direction, branch_points)
    }

    /// Returns the end of a panel, rad: after `length` (rad), or at a corner or the end of the turn before.
    fn end(&self, length: f64) -> f64 {
        let KineticState {
            angle, direction, ..
        } = self.now;
        let end = next_end(self.profile.corners(), angle, direction, length);
        let end = self.profile.corner_between(angle, end).unwrap_or(end);
        match self.gain.is_some() && direction * (end - self.whole_turn) > -SAME_ANGLE {
            true => self.whole_turn,
            false => end,
        }
    }

    fn piece(&self) -> Piece {
        let KineticState {
            angle: at,
            direction,
            ..
        } = self.now;
        // The bound leaves constants out: where it is nearly as long, the whole length is tried.
        let (allowed, nearly) = (self.analytic(), if self.is_cut { 1.0 } else { 0.85 });
        let mut to = self.end(self.length);
        if direction * (to - at) * nearly > allowed {
            to = self.end(self.length.min(allowed));
        }
        let at_rest = self.now.kinetic == 0.0;
        let turns = self.ahead.map(|ahead| ahead.way);
        match turns.filter(|way| direction * (to - at - way) >= 0.0) {
            // A panel cannot have turning points at both ends: the first half ends in the middle.
            Some(way) if at_rest => to = at + 0.5 * way,
            Some(way) => return Piece::until_turning(at, way),
            None => {}
        }
        let turning = if at_rest {
            Turning::AtStart
        } else {
            Turning::Nowhere
        };
        Piece::between(at, to, turning)
    }

    /// Returns the error bound of the energy on the next panel, J; near rest by the integral to the end of the turn.
    fn known_energy(&mut self, turning: Turning) -> KnownEnergy {
        if let Some(turn_end) = &self.turn_end
            && turning == Turning::AtEnd
            && self.ahead.is_some_and(|ahead| ahead.from_turn_end)
        {
            return KnownEnergy::AtTurn(turn_end.rounding());
        }
        // The sum of smaller energies over panels has lost digits.
        let near_rest = 1e-3 * self.largest;
        if let Some(turn_end) = &self.turn_end
            && self.now.kinetic < near_rest
            && let Some(exact) = turn_end.kinetic(self.now.angle)
        {
            self.now.kinetic = exact;
            let at = self.now.angle;
            let to_go = (self.whole_turn - at).abs();
            let size = exact.max(self.begin.kinetic);
            return KnownEnergy::AtStart(f64::EPSILON * size * (1.0 + at.abs() / to_go));
        }
        KnownEnergy::AtStart(self.now.energy_error + f64::EPSILON * self.largest)
    }

    /// Returns the improvement to make on a panel. A turning point found on a longer panel is accurate to the rounding
    /// of that panel; the residual of the energy balance on the last panel is its correction (Newton), as long as the
    /// force hardly changes over the correction. Otherwise the last panel has to begin nearer.
    fn improvement(&self, panel: &Panel, known: KnownEnergy) -> Improvement {
        let (Some(ahead), KnownEnergy::AtStart(energy_error)) = (self.ahead, known) else {
            return Improvement::None;
        };
        let residual = panel.residual.abs();
        let Piece {
            from, to, turning, ..
        } = panel.piece;
        // Two roundings of the energy at the start: as a sum, and as the work back to it.
        let rounding = 2.0 * f64::EPSILON * self.now.kinetic;
        if turning != Turning::AtEnd || residual <= rounding || residual > 0.5 * ahead.residual {
            return Improvement::None;
        }
        let [first, last] = [from, to].map(|theta| self.profile.inertia_and_force(theta).1);
        let more = -panel.residual / last;
        let slope = (last - first) / panel.piece.span;
        if (more * slope).abs() < 0.5 * last.abs() && last * self.now.direction < 0.0 {
            Improvement::Turning(TurningPoint {
                way: ahead.way + more,
                residual,
                ..ahead
            })
        } else if residual > energy_error {
            Improvement::Shorter
        } else {
            Improvement::None
        }
    }

    fn take(&mut self, mut panel: Panel, energy_error: f64) {
        self.now.energy_error = self.now.energy_error.hypot(energy_error);
        let piece = panel.piece;
        self.now.angle = piece.to;
        if let Some(ahead) = &mut self.ahead {
            ahead.way -= piece.span;
        }
        panel.turns = self.now.direction * self.turns;
        self.now.kinetic = panel.kinetic_at_end;
        self.largest = self.largest.max(self.now.kinetic);
        // A corner may have cut this panel short.
        self.length = self.length.max(2.0 * piece.span.abs());
        self.segment.push(panel);
        if piece.turning == Turning::AtEnd {
            self.segment.after = After::TurnsBack;
        }
    }

    /// True if a turn is complete that is followed by a turn with the same forces.
    fn is_turn_complete(&self) -> bool {
        self.gain.is_some()
            && self.now.angle == self.whole_turn
            && self.segment.after == After::Ends
    }

    fn turn(&mut self, until: f64, most_turns: f64) {
        let begin = self.begin;
        self.segment
            .complete(turn_remainder(begin.angle, begin.direction));
        self.turns += 1.0;
        if self.profile.repeats() {
            self.segment.after = After::Repeats;
        } else if self.turns * until > most_turns * self.segment.duration.0 {
            self.segment.after = After::GoesOn;
        } else {
            let gain = self.gain.unwrap_or_default();
            self.now = KineticState {
                kinetic: gain.mul_add(self.turns, begin.kinetic),
                energy_error: self.turns.mul_add(self.gain_error, begin.energy_error),
                ..begin
            };
        }
    }
}
