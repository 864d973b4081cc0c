//! Work of the loads, by adaptive Gauss quadrature independent of the engines, and panel ends at narrow formulas.

use std::f64::consts::TAU;

use super::AngleModel;
use crate::numeric::angle::{self, Angle};
use crate::numeric::gauss;
use crate::scene::Load;

impl AngleModel<'_> {
    /// Returns the first panel end after `from` towards `to`, in either direction, rad, that is no corner of each turn.
    pub(super) fn panel_end(&self, from: f64, to: f64) -> Option<f64> {
        if self.panel_ends_are_corners {
            return None;
        }
        let before = self.turns * TAU;
        let end = self.panel_ends.next(from + before, to + before)?;
        Some(end - before)
    }

    /// Whether loads of the position have a pole in the cycle.
    pub fn has_pole_in_cycle(&self) -> bool {
        self.panel_ends.has_pole_in_cycle.get()
    }

    /// Computes the work of one turn and the error of it, J, for loads of the position alone that repeat each turn.
    pub(super) fn work_of_one_turn(&self) -> (f64, f64) {
        let torque = TAU * self.equation.loads().constant.torque;
        let (mut work, mut size) = (torque, torque.abs());
        if !self.equation.loads().have_potential() {
            work += self.work_between(0.0, TAU, 0.0);
            size += gauss::composite(|theta| self.push(theta).abs(), 0.0, TAU, 64);
        }
        (work, f64::EPSILON * size)
    }

    /// Computes the work (J) of the loads without potential between two angles, independently of the engine.
    pub fn work(&self, from: Angle, to: Angle) -> f64 {
        if self.equation.loads().have_potential() {
            return 0.0;
        }
        let turns = to.turns - from.turns;
        let Some((_, error)) = self.work_of_turn else {
            return self.work_between(from.rest, to.rest + turns * TAU, 0.0);
        };
        let whole = if turns == 0.0 {
            0.0
        } else {
            turns * self.work_between(0.0, TAU, 0.0)
        };
        // A part of a turn on which the loads are rounding, as a gas at ambient pressure, is not resolved.
        whole + self.work_between(from.rest, to.rest, error)
    }

    /// Returns the generalized force (N m) of the loads without potential at an angle, rad.
    pub(super) fn push(&self, theta: f64) -> f64 {
        let pose = self.equation.linkage().pose(theta);
        let loads = self.equation.loads();
        let load = loads.without_potential(&pose.instant(0.0, self.angle(theta), 0.0));
        load.generalized(pose.dx)
    }

    /// Integrates the force between two angles, rad; `tolerance`, J.
    fn work_between(&self, from: f64, to: f64, tolerance: f64) -> f64 {
        let force = |theta: f64| self.push(theta);
        let (low, high) = (from.min(to), from.max(to));
        let [first, last] = [low, high].map(|end| (end / TAU).floor() as i64);
        let corners = angle::in_turns(&self.corners, first..=last);
        let mut cuts = vec![low];
        cuts.extend(corners.filter(|corner| low < *corner && *corner < high));
        let before = self.turns * TAU;
        let loads = self.equation.loads().called();
        let loads = loads.filter_map(Load::out_of_step);
        let out_of_step = loads.flat_map(|load| load.corners_between(low + before, high + before));
        cuts.extend(out_of_step.map(|corner| corner - before));
        if !self.panel_ends_are_corners {
            let panel_ends = self.panel_ends.between(low + before, high + before);
            cuts.extend(panel_ends.iter().map(|panel_end| panel_end - before));
        }
        cuts.push(high);
        cuts.sort_by(f64::total_cmp);
        let work = gauss::adaptive(&force, &cuts, tolerance);
        if to < from { -work } else { work }
    }
}
