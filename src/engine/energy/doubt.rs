//! How far a motion may be off.

use super::Orbit;
use super::leg::Leg;

impl Orbit {
    /// How far a time may be off, s: by the tails of the series and the rounding of energies.
    pub fn time_error(&self, until: f64) -> f64 {
        let (back, later) = (self.backward.as_ref(), self.later.as_ref());
        let error = self.forward.error
            + back.map_or(0.0, |leg| leg.error)
            + later.map_or(0.0, |later| later.error());
        let duration = later.map_or(self.forward.duration.0, |later| later.end())
            + back.map_or(0.0, |leg| leg.duration.0);
        let left_out = back.map_or(0.0, |leg| leg.left_out);
        error / duration * until + self.forward.left_out.max(left_out)
    }

    /// What the series leave out of the speed, relative to it.
    pub fn speed_error(&self) -> f64 {
        let back = self.backward.as_ref().map_or(0.0, |leg| leg.tail);
        self.forward.tail.max(back)
    }

    /// How far the turning point next to the state at a time (s) may be off, rad, if the state is on a panel that ends
    /// there: where the crank is slow, its place is off by that, however exact the time.
    pub fn misplaced(&self, t: f64) -> f64 {
        if !self.turns_back() {
            return 0.0;
        }
        let there = 2.0 * self.forward.duration.0;
        let (_, after) = self.split(t);
        let to_and_fro = |leg: &Leg, since: f64| {
            let since = since.min(2.0 * leg.duration.0 - since);
            leg.panel_at(since)
                .map_or(0.0, |(panel, _)| panel.misplaced)
        };
        match &self.backward {
            Some(back) if after > there => to_and_fro(back, after - there),
            _ => to_and_fro(&self.forward, after % there),
        }
    }
}
