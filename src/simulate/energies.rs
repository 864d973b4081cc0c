//! Kinetic and potential energy along a motion.

use super::row::Row;
use crate::mechanism::{Class, Equation};
use crate::scene::Scene;

/// Energies of a mechanism with ideal joints and a crank that turns fully: elsewhere the crank angle does not fix them.
#[derive(Clone, Debug)]
pub struct Energies(Equation);

impl Energies {
    /// Makes the energies of the mechanism of a scene; none with clearance or if the crank does not turn fully.
    pub fn of(scene: &Scene) -> Option<Energies> {
        let equation = Equation::new(scene);
        let tells = Class::of(equation.linkage()) == Class::RotatingCrank;
        (tells && scene.clearance.is_none()).then_some(Energies(equation))
    }

    /// Returns the kinetic energy, and the potential energy of gravity and of the loads that have one, J, at a row.
    pub fn at(&self, row: &Row) -> [f64; 2] {
        let kinetic = self.0.kinetic_energy(row.theta, row.omega);
        [kinetic, self.0.potential_energy(row.theta)]
    }
}
