//! How far a motion may be off.

use super::Orbit;
use super::panel::Panel;
use super::piece::Turning;
use super::segment::Segment;

/// How far the kinetic energy (J) of a start may be off because its angle (rad) is rounded, J: next to a limit that is
/// nearly reached the inertia is steep. `inertias`: there, and at an angle `beside` from it, rad.
pub(in crate::engine) fn off_by_place(
    theta: f64,
    kinetic: f64,
    inertias: [f64; 2],
    beside: f64,
) -> f64 {
    let slope = (inertias[1] - inertias[0]) / (beside * inertias[0]);
    let off = (0.5 * f64::EPSILON * theta * slope * kinetic).abs();
    if off.is_finite() { off } else { 0.0 }
}

impl Orbit {
    /// How far a time may be off, s: by the tails of the series and the rounding of energies.
    pub fn time_error(&self, until: f64) -> f64 {
        let (back, later) = (self.backward.as_ref(), self.later.as_ref());
        let error = self.forward.error
            + back.map_or(0.0, |segment| segment.error)
            + later.map_or(0.0, |later| later.error);
        let duration = later.map_or(self.forward.duration.0, |later| later.end())
            + back.map_or(0.0, |segment| segment.duration.0);
        let left_out = match self.panel_at(until) {
            Some((panel, _)) => panel.left_out(),
            None => self.forward.left_out,
        };
        error / duration * until + left_out
    }

    /// How far the place of the state at a time (s) is rounded, rad: it is a way on a panel, and an angle. None after the
    /// first turns of many.
    pub fn rounding(&self, t: f64) -> Option<f64> {
        let piece = &self.panel_at(t)?.0.piece;
        let most = piece.from.abs().max(piece.to.abs());
        Some(0.5 * f64::EPSILON * (piece.span().abs() + most))
    }

    /// What the series leave out of the speed at a time (s), relative to it.
    pub fn speed_error(&self, t: f64) -> f64 {
        self.panel_at(t)
            .map_or(self.forward.tail, |(panel, after)| {
                panel.left_out_of_speed(after)
            })
    }

    /// How far the kinetic energy (J) of the state at a time (s) may be off, J.
    pub fn energy_error(&self, t: f64, kinetic: f64) -> f64 {
        self.panel_at(t).map_or(self.off, |(panel, _)| {
            panel.off
                * match panel.piece.turning {
                    Turning::Nowhere => 1.0,
                    _ => kinetic,
                }
        })
    }

    /// How far the turning point next to the state at a time (s) may be off, rad, if the state is on a panel that ends
    /// there: where the crank is slow, its place is off by that, however exact the time.
    pub fn misplaced(&self, t: f64) -> f64 {
        let there = self.panel_at(t).filter(|_| self.turns_back());
        there.map_or(0.0, |(panel, _)| panel.misplaced)
    }

    /// The panel on which the state at a time (s) lies, and the time since its begin, s; none after the first turns of many.
    fn panel_at(&self, t: f64) -> Option<(&Panel, f64)> {
        if self.later.is_some() && t > self.forward.duration.0 {
            return None;
        }
        let (_, after) = self.split(t);
        if !self.turns_back() {
            return self.forward.panel_at(after);
        }
        let there = 2.0 * self.forward.duration.0;
        match &self.backward {
            Some(back) if after > there => to_and_fro(back, after - there),
            _ => to_and_fro(&self.forward, after % there),
        }
    }
}

/// The panel of a leg that is run through to and fro, and the time since its begin, s.
fn to_and_fro(segment: &Segment, since: f64) -> Option<(&Panel, f64)> {
    segment.panel_at(since.min(2.0 * segment.duration.0 - since))
}
