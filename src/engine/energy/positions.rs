//! Positions along a motion over the crank angle, for states without a search by time.

use std::f64::consts::PI;

use super::Orbit;
use super::panel::Panel;
use crate::numeric::angle::Angle;

impl Orbit {
    /// Returns the positions that resolve the motion up to a time, s: the points of the series, each as the index of
    /// the panel plus the fraction of its variable. A turn that repeats has one more before it and one after it. None
    /// if the states do not all lie on one segment.
    pub fn positions(&self, until: f64) -> Option<Vec<f64>> {
        let segment = &self.forward;
        let covers = until <= segment.duration.0 || self.rotates() || self.turns_back();
        if !covers || self.backward.is_some() || self.later.is_some() {
            return None;
        }
        let whole = self.rotates() && until >= segment.duration.0;
        let last = match segment.panel_at(until) {
            Some((panel, after)) if !whole && after < panel.duration.0 => {
                segment.index_at(until) as f64 + 0.5 * (1.0 + panel.position(after))
            }
            _ => segment.panels.len() as f64,
        };
        let of_panel = |index: usize| {
            let panel = segment.panels.get(index);
            let count = panel.map_or(0, |panel| panel.rule.degree());
            let x = move |j: usize| -(PI * j as f64 / count as f64).cos();
            (0..count).map(move |j| index as f64 + 0.5 * (1.0 + x(j)))
        };
        let inside = (0..segment.panels.len()).flat_map(of_panel);
        let mut positions: Vec<f64> = inside.take_while(|at| *at < last).chain([last]).collect();
        if let (true, &[_, second, .., before, last]) = (whole, &positions[..]) {
            positions.insert(0, before - last);
            positions.push(second + last);
        }
        Some(positions)
    }

    /// Returns angle and speed (rad/s) at a position.
    pub fn state_at_position(&self, at: f64) -> Option<(Angle, f64)> {
        let (panel, x) = self.at_position(at)?;
        let angle = Angle::new(self.start.turns + panel.turns, panel.piece.angle(x));
        Some((angle, panel.speed(x)))
    }

    /// Returns the time of a position, s.
    pub fn time_of_position(&self, at: f64) -> Option<f64> {
        let (panel, x) = self.at_position(at)?;
        Some(panel.begin + panel.time(x))
    }

    /// Returns the panel of a position and its variable x.
    fn at_position(&self, at: f64) -> Option<(&Panel, f64)> {
        let count = self.forward.panels.len();
        let at = match self.rotates() {
            true => at.rem_euclid(count as f64),
            false => at,
        };
        let index = (at as usize).min(count.saturating_sub(1));
        let x = (2.0 * (at - index as f64) - 1.0).clamp(-1.0, 1.0);
        Some((self.forward.panels.get(index)?, x))
    }
}
