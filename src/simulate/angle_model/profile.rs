//! Inertia and force of loads of the position alone, for motions from their energy, and the work of these loads by
//! quadrature independent of the engines.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::super::guide_friction::NEARBY_ANGLE;
use super::AngleModel;
use crate::engine::energy::Profile;
use crate::numeric::angle::{self, Angle};
use crate::numeric::chebyshev::Values;
use crate::numeric::gauss;
use crate::scene::Load;

impl Profile for AngleModel<'_> {
    fn inertia_and_force(&self, theta: f64) -> (f64, f64) {
        self.count(1);
        let terms = self.equation.terms(theta);
        let angle = self.angle(theta);
        let load = self.equation.loads().value(0.0, angle, 0.0, &terms.pose);
        (terms.m, load.generalized(terms.pose.dx) - terms.dv)
    }

    fn tabulate(&self, angles: &Values) -> [Values; 2] {
        self.count(angles.len());
        let loads = self.equation.loads();
        let at = self.equation.term_arrays(angles);
        let mut forces = at.m;
        for (i, angle) in angles.iter().enumerate() {
            let load = loads
                .with_potential_at(at.x[i])
                .plus(loads.of_place(self.angle(*angle), at.x[i]));
            forces[i] = load.generalized(at.dx[i]) - at.dv[i];
        }
        [at.m, forces]
    }

    fn inertia_rounding(&self, theta: f64, is_rounded: bool) -> f64 {
        self.equation.inertia_rounding(theta, is_rounded)
    }

    fn rounding(&self, theta: f64) -> f64 {
        self.count(1);
        let angle = self.angle(theta);
        let mut size = self.equation.size_of_terms(0.0, angle, 0.0);
        if !self.equation.loads().have_potential() {
            // A formula of the angle is rounded with the angle.
            let change = self.push(theta + NEARBY_ANGLE) - self.push(theta - NEARBY_ANGLE);
            size += (0.5 * change / NEARBY_ANGLE * angle.radians()).abs();
        }
        0.5 * f64::EPSILON * size
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }

    fn branch_points(&self) -> Vec<[f64; 2]> {
        let inertia = |theta: f64| self.equation.terms(theta).m;
        // At dead centres x' vanishes. Where it is a sine around them, M does at this distance.
        let of_root = |theta: &f64| {
            let (least, largest) = (inertia(*theta), inertia(theta + FRAC_PI_2));
            [*theta, (least / (largest - least).max(0.0)).sqrt().asinh()]
        };
        let of_linkage = self.equation.branch_points();
        let of_inertia = self.dead_centres.iter().map(of_root);
        // A corner is no branch point beside the real axis.
        let beside = of_inertia.filter(|_| !self.inertia_vanishes);
        of_linkage.into_iter().chain(beside).collect()
    }

    fn corner_between(&self, from: f64, to: f64) -> Option<f64> {
        // The last corner itself, off by rounding, is not the next one.
        let apart = (to - from).signum() * 1e-12 * from.abs().max(1.0);
        let turns = self.turns * TAU;
        let loads = self.equation.loads();
        let corner = loads.corner_out_of_step(from + apart + turns, to + turns);
        let panel_end = self.panel_end(from + apart, to);
        let first = |a: f64, b: f64| if (a < b) == (from < to) { a } else { b };
        let corner = corner.map(|corner| corner - turns);
        corner.into_iter().chain(panel_end).reduce(first)
    }

    fn has_pole(&self, at: f64) -> bool {
        self.panel_ends.is_pole(at + self.turns * TAU)
    }

    fn is_spent(&self) -> bool {
        self.limit.is_reached(self.evaluations.get())
    }

    fn repeats(&self) -> bool {
        self.repeats
    }

    fn work_of_turn(&self) -> Option<(f64, f64)> {
        self.work_of_turn
    }
}

impl AngleModel<'_> {
    /// Returns the first panel end after `from` towards `to`, in either direction, rad, that is no corner of each turn.
    fn panel_end(&self, from: f64, to: f64) -> Option<f64> {
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
    fn push(&self, theta: f64) -> f64 {
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
