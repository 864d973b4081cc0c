//! The mechanism as the energy engine sees it: inertia, potential and force over the crank angle.

use std::cell::Cell;

use crate::engine::energy::Profile;
use crate::mechanism::{DeadCentre, Equation, Limits};
use crate::numeric::gauss;

/// Inertia, potential and force of an equation whose loads depend on the position alone.
pub(super) struct Position<'a> {
    equation: &'a Equation,
    corners: Vec<f64>,
    repeats: bool,
    evaluations: Cell<u64>,
}

impl<'a> Position<'a> {
    /// Panels end at the dead centres, where the inertia of a mechanism without crank inertia has a corner.
    pub fn new(equation: &'a Equation, limits: &Limits) -> Position<'a> {
        let dead_centres = limits.dead_centres.iter();
        let corners = dead_centres
            .map(|DeadCentre { theta, .. }| *theta)
            .collect();
        let loads = equation.loads();
        Position {
            equation,
            corners,
            repeats: loads.have_potential() && !loads.turn_the_crank(),
            evaluations: Cell::new(0),
        }
    }

    /// Positions at which inertia and force were computed so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Work (J) of the loads without potential between two angles, by a quadrature of its own.
    pub fn work(&self, from: f64, to: f64) -> f64 {
        let loads = self.equation.loads();
        if loads.have_potential() {
            return 0.0;
        }
        let panels = ((to - from).abs() * 200.0).clamp(64.0, 1e6) as u32;
        let force = |theta: f64| {
            let pose = self.equation.linkage().pose(theta);
            loads
                .without_potential(0.0, theta, 0.0, &pose)
                .generalized(&pose)
        };
        gauss::composite(force, from, to, panels)
    }
}

impl Profile for Position<'_> {
    fn inertia_and_force(&self, theta: f64) -> (f64, f64) {
        self.evaluations.set(self.evaluations.get() + 1);
        let terms = self.equation.terms(theta);
        let load = self.equation.loads().value(0.0, theta, 0.0, &terms.pose);
        (terms.inertia.m, load.generalized(&terms.pose) - terms.dv)
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }

    fn repeats(&self) -> bool {
        self.repeats
    }
}
