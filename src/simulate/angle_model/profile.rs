//! Inertia and force of loads of the position alone, for motions from their energy.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::super::guide_friction::NEARBY_ANGLE;
use super::AngleModel;
use crate::engine::energy::Profile;
use crate::numeric::chebyshev::Values;

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
