//! Secant linearisation of state loads between sweeps. At a point of a panel they vary with one number alone, the time
//! or the kinetic energy: its last two values give the derivative. Inexact Newton method (Dembo, Eisenstat and Steihaug,
//! SIAM J. Numer. Anal. 19, 1982).

use super::dynamics::StateVariable;
use super::panel::PanelTable;
use super::solution::PanelSolution;
use crate::numeric::chebyshev::{MAX_DEGREE, Values, largest};

/// Forces of the state loads at the points in the last sweep.
#[derive(Clone, Copy)]
pub(super) struct Secant {
    variable: StateVariable,
    forces: Values,
    at: Values,
}

impl Secant {
    /// Takes the forces of the last evaluation.
    pub fn of(solution: &PanelSolution, variable: StateVariable) -> Secant {
        let at = match variable {
            StateVariable::Time => solution.forces.times,
            StateVariable::Energy => solution.kinetic,
        };
        let forces = solution.forces.of_state;
        Secant {
            variable,
            forces,
            at,
        }
    }

    /// Returns the derivatives of the forces at the first `count` points, from these and later forces.
    fn slopes(&self, later: &Secant, count: usize) -> Values {
        let mut slopes = [0.0; MAX_DEGREE + 1];
        for (j, slope) in slopes[..count].iter_mut().enumerate() {
            let secant = (later.forces[j] - self.forces[j]) / (later.at[j] - self.at[j]);
            *slope = if secant.is_finite() { secant } else { 0.0 };
        }
        slopes
    }
}

impl PanelSolution {
    /// Converts the change of the kinetic energy by a sweep, J, to that of linearised state loads, and their forces with
    /// it; with those of the table, if `of_table`. `before` and `now` are those of the last two sweeps. Returns the error
    /// that it leaves, as a part of the change: 1 for a plain sweep, where the iteration diverges.
    pub(super) fn follow_state_loads<P: Copy>(
        &mut self,
        panel: &PanelTable<P>,
        [before, now]: [&Secant; 2],
        of_table: bool,
        change: &mut Values,
    ) -> f64 {
        let (count, half) = (panel.rule.degree() + 1, panel.half());
        let slopes = before.slopes(now, count);
        let rates = if of_table {
            self.forces.rates_of_table(panel)
        } else {
            [0.0; MAX_DEGREE + 1]
        };
        let sweep = *change;
        let mut more = [0.0; MAX_DEGREE + 1];
        let first = largest(&sweep[..count]);
        let (mut last, mut ratio) = (first, 1.0);
        // Forcing term.
        let enough = 0.01;
        for _ in 0..3 {
            if last <= enough * first {
                break;
            }
            let by = match now.variable {
                StateVariable::Energy => *change,
                StateVariable::Time => self.delay(panel, change),
            };
            for j in 0..count {
                more[j] = slopes[j] * by[j] + rates[j] * change[j];
            }
            let work = panel.rule.integrals(&more);
            let mut moved = [0.0; MAX_DEGREE + 1];
            for j in 0..count {
                let next = sweep[j] + half * work[j];
                moved[j] = next - change[j];
                change[j] = next;
            }
            let moved = largest(&moved[..count]);
            (last, ratio) = (moved, moved / last);
        }
        if first == 0.0 {
            return 0.0;
        }
        if ratio >= 1.0 {
            *change = sweep;
            return 1.0;
        }
        self.forces.add(&more, count);
        ratio * last / first
    }

    /// Returns the delay at the points, s, due to a change of the kinetic energy, J.
    fn delay<P: Copy>(&self, panel: &PanelTable<P>, change: &Values) -> Values {
        let (count, half) = (panel.rule.degree() + 1, panel.half());
        let mut slopes = [0.0; MAX_DEGREE + 1];
        for j in 0..count {
            slopes[j] = -0.5 * half * change[j] / (self.forces.speeds[j] * self.kinetic[j]);
        }
        panel.rule.integrals(&slopes)
    }
}
