//! Energies along a motion, and the energy balance of a run: residual of energy and work, and the scale of it.

use super::row::Row;
use super::run_setup::RunSetup;
use crate::engine::time::MotionState;
use crate::mechanism::{Class, Equation};
use crate::numeric::angle::Angle;
use crate::scene::Scene;

/// Residual of the energy balance: energy at the end minus energy at the start minus work of the loads.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyBalance {
    /// Residual, J.
    pub residual: f64,
    /// Largest absolute value of the energies that occur, J.
    pub largest: f64,
}

impl EnergyBalance {
    /// Makes a balance from a residual, J, and the energies that occur, J.
    pub fn new(residual: f64, energies: &[f64]) -> EnergyBalance {
        let largest = |largest: f64, energy: &f64| largest.max(energy.abs());
        EnergyBalance {
            residual,
            largest: energies.iter().fold(0.0, largest),
        }
    }

    /// Computes the balance of a crank motion to `at`: work of the loads without potential, largest kinetic energy, J.
    pub fn of_crank(
        task: &RunSetup<'_>,
        at: &MotionState,
        work: f64,
        largest_kinetic: f64,
    ) -> EnergyBalance {
        let equation = task.equation();
        let start = task.start();
        let turned = Angle::new(at.angle.turns - start.turns, at.angle.rest);
        let begin =
            equation.kinetic_energy(start.rest, task.speed) + equation.potential_energy(start.rest);
        let last =
            equation.kinetic_energy(at.angle.rest, at.speed) + equation.potential_energy(turned);
        EnergyBalance::new(last - begin - work, &[largest_kinetic, begin, last, work])
    }
}

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
