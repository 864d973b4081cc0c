//! Error bounds of a motion, from the tails of its series and the rounding of energies and angles.

use super::Orbit;
use super::panel::Panel;
use super::piece::Turning;

impl Orbit {
    /// Returns the error bound of a time, s, from the tails of the series and the rounding of energies.
    pub fn time_error(&self, until: f64) -> f64 {
        let (back, later) = (self.backward.as_ref(), self.later.as_ref());
        let error = self.forward.error
            + back.map_or(0.0, |segment| segment.error)
            + later.map_or(0.0, |later| later.error);
        let duration = later.map_or(self.forward.duration.0, |later| later.end())
            + back.map_or(0.0, |segment| segment.duration.0);
        let truncation_error = match self.panel_at(until) {
            Some((panel, _)) => panel.truncation_error(),
            None => self.forward.truncation_error,
        };
        error / duration * until + truncation_error
    }

    /// Returns the rounding error of the crank angle at a time (s), rad, as the sum of a distance on a panel and an
    /// angle. None after the first of many turns.
    pub fn rounding(&self, t: f64) -> Option<f64> {
        let piece = &self.panel_at(t)?.0.piece;
        let most = piece.from.abs().max(piece.to.abs());
        Some(0.5 * f64::EPSILON * (piece.span.abs() + most))
    }

    /// Returns the truncation error of the speed at a time (s), relative to the speed.
    pub fn speed_error(&self, t: f64) -> f64 {
        self.panel_at(t)
            .map_or(self.forward.tail, |(panel, after)| {
                panel.speed_truncation_error(after)
            })
    }

    /// Returns the error bound of the kinetic energy (J) at a time (s), J.
    pub fn energy_error(&self, t: f64, kinetic: f64) -> f64 {
        self.panel_at(t).map_or(self.energy_error, |(panel, _)| {
            panel.energy_error
                * match panel.piece.turning {
                    Turning::Nowhere => 1.0,
                    _ => kinetic,
                }
        })
    }

    /// Returns the error bound of the turning point next to the state at a time (s), rad; zero on a panel without
    /// turning point. Where the crank is slow, its angle has this error, however exact the time.
    pub fn turning_point_error(&self, t: f64) -> f64 {
        let there = self.panel_at(t).filter(|_| self.turns_back());
        there.map_or(0.0, |(panel, _)| panel.turning_point_error)
    }

    /// Returns the panel at a time (s) and the time since its start, s; none after the first of many turns.
    fn panel_at(&self, t: f64) -> Option<(&Panel, f64)> {
        if self.later.is_some() && t > self.forward.duration.0 {
            return None;
        }
        let (segment, at, _) = self.located(self.split(t).1);
        segment.panel_at(at)
    }
}
