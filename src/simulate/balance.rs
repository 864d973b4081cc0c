//! The energy balance of a run.

use super::run_setup::RunSetup;
use crate::engine::time::Start;
use crate::numeric::angle::Angle;

/// Energy at the end minus energy at the start minus work of the loads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    /// J
    pub residual: f64,
    /// Largest energy that occurs, J.
    pub largest: f64,
}

impl Balance {
    /// From the residual and the energies that occur, J.
    pub fn new(residual: f64, energies: &[f64]) -> Balance {
        let largest = |largest: f64, energy: &f64| largest.max(energy.abs());
        Balance {
            residual,
            largest: energies.iter().fold(0.0, largest),
        }
    }

    /// Of a run whose largest kinetic energy (J) is known; `work` of the loads without potential, J.
    pub fn of_crank(task: &RunSetup<'_>, at: &Start, work: f64, largest_kinetic: f64) -> Balance {
        let equation = task.equation();
        let start = task.start();
        let turned = Angle::new(at.angle.turns - start.turns, at.angle.rest);
        let begin =
            equation.kinetic_energy(start.rest, task.speed) + equation.potential_energy(start.rest);
        let last =
            equation.kinetic_energy(at.angle.rest, at.speed) + equation.potential_energy(turned);
        Balance::new(last - begin - work, &[largest_kinetic, begin, last, work])
    }
}
