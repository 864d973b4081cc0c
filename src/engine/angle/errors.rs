//! Propagation of errors of time and kinetic energy through a run over the angle.
//!
//! At an angle, δt' = −δK/(2K|ω|) and δK' = ∂F/∂K δK + ∂F/∂t δt: an error of the energy shifts the time, the more the
//! slower the motion, and under loads in time a shifted time changes the energy.

use super::super::energy::panel::Panel;
use super::Dynamics;
use super::panel::Problem;
use super::solution::PanelSolution;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Values};
use crate::numeric::covariance_factor::{CovarianceFactor, Transition};
use crate::numeric::median::range;

/// Errors of the time (s) and of the kinetic energy (J) at an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Rounding errors, over machine epsilon.
    pub rounding: CovarianceFactor,
    /// Transition of errors at the start of the run to those at its end.
    pub transition: Transition,
}

impl Errors {
    /// Returns the errors at the start for a kinetic energy, J, with an error `off` beyond its rounding, J.
    pub(super) fn at(kinetic: f64, off: f64) -> Errors {
        let energy = (off / f64::EPSILON).hypot(0.5 * kinetic);
        Errors {
            rounding: CovarianceFactor::default().plus_error([0.0, energy]),
            transition: Transition::identity(),
        }
    }

    /// Propagates the errors over a panel.
    pub(super) fn pass(&mut self, panel: &PanelErrors) {
        self.transition = panel.transition * self.transition;
        let carried = self.rounding.propagated(&panel.transition);
        self.rounding = carried.plus_error(panel.rounding);
    }

    /// Returns the errors of a run that goes on like this one for `ratio` times its time.
    pub(super) fn over(self, ratio: f64) -> Errors {
        let mut transition = self.transition;
        transition[(0, 1)] *= ratio;
        Errors {
            rounding: self.rounding.scaled([ratio, 1.0]),
            transition,
        }
    }
}

/// Errors of the time (s) and of the kinetic energy (J) over a panel.
pub(super) struct PanelErrors {
    transition: Transition,
    /// Rounding error on the panel, over machine epsilon.
    rounding: [f64; 2],
}

impl PanelErrors {
    /// Computes the errors over a panel and the motion on it; counts the evaluations for them.
    pub fn of(
        problem: &Problem<'_, impl Dynamics>,
        solved: &Panel,
        solution: &mut PanelSolution,
    ) -> PanelErrors {
        let (dynamics, panel) = (problem.dynamics, problem.panel);
        let count = panel.rule.degree() + 1;
        let by_time = dynamics.reads_time().then(|| {
            solution.evaluations += count as u64;
            solution.forces.slopes_by_time(problem)
        });
        let late = |by_time| solution.forces.uncertain_by_time(problem, by_time);
        let mistimed = by_time.as_ref().map_or(0.0, late);
        // Error of the work due to rounded angles, J.
        let misplaced = [&panel.table.force, &panel.table.push].map(|forces| {
            let (low, high) = range(&forces[..count]);
            0.5 * solved.piece.from.abs().max(solved.piece.to.abs()) * (high - low)
        });
        let noise = solution.gain.abs() + misplaced[0] + misplaced[1] + mistimed;
        // The noise arises mainly where the energy is large.
        let largest = solution.kinetic[0].max(solution.kinetic[count - 1]);
        let lead_of_noise = 0.5 * solved.duration.0 / largest;
        PanelErrors {
            transition: solution.transition(problem, by_time.as_ref()),
            rounding: [-lead_of_noise * noise, noise],
        }
    }
}

impl PanelSolution {
    /// Computes the transition of errors of time (s) and kinetic energy (J) over a panel, from the slopes of the forces by
    /// the time at the points (N m/s), if there are any; counts the evaluations for it.
    fn transition(
        &mut self,
        problem: &Problem<'_, impl Dynamics>,
        by_time: Option<&Values>,
    ) -> Transition {
        let (panel, rule) = (problem.panel, problem.panel.rule);
        let (forces, half) = (&self.forces, self.share * panel.half());
        // Losses are spread evenly over the panel.
        let exponent = 2.0 * half * forces.mean_rate(problem, &mut self.evaluations);
        let retained = exponent.exp();
        let mut lead: Values = std::array::from_fn(|j| 0.5 * self.slopes[j] / self.kinetic[j]);
        let Some(by_time) = by_time else {
            let mean = if exponent == 0.0 {
                1.0
            } else {
                exponent.exp_m1() / exponent
            };
            return Transition::new(1.0, -rule.rounded_integral(&lead) * mean, 0.0, retained);
        };
        // Of an energy error over the part of it that remains, the equations have no trace.
        let mut push = [0.0; MAX_DEGREE + 1];
        for (j, x) in rule.points().iter().enumerate() {
            let remains = (0.5 * (1.0 + x) * exponent).exp();
            lead[j] *= remains;
            push[j] = half * by_time[j] / remains;
        }
        let late = coupled(rule, [&lead.map(|lead| -lead), &push]);
        let fast = coupled(rule, [&push, &lead.map(|lead| -lead)]);
        let coupled = Transition::new(late[0], fast[1], late[1], fast[0]);
        // The determinant is exact, so that motions locked to a load do not part by what the sweeps leave.
        let exact = coupled / coupled.determinant().sqrt();
        let transition = Transition::new(1.0, 0.0, 0.0, retained) * exact;
        let finite = transition.iter().all(|entry| entry.is_finite());
        let uncoupled = Transition::new(1.0, -rule.rounded_integral(&lead), 0.0, retained);
        if finite { transition } else { uncoupled }
    }
}

/// Solves y' = p z, z' = q y from y = 1, z = 0 over a panel by Picard sweeps; returns both at its end. `rates`: p and q at
/// the points of the rule.
fn coupled(rule: &Rule, [p, q]: [&Values; 2]) -> [f64; 2] {
    let end = rule.degree();
    let product = |rates: &Values, values: &Values| std::array::from_fn(|j| rates[j] * values[j]);
    let (mut y, mut z) = ([1.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
    // Sweeps converge as the exponential series does.
    let most_sweeps = 30;
    for _ in 0..most_sweeps {
        z = rule.integrals(&product(q, &y));
        let before = y[end];
        y = rule
            .integrals(&product(p, &z))
            .map(|integral| 1.0 + integral);
        if (y[end] - before).abs() <= f64::EPSILON.sqrt() {
            break;
        }
    }
    [y[end], z[end]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coupled_errors_of_an_oscillator_are_sine_and_cosine() {
        let rate = |size: f64| [size; MAX_DEGREE + 1];
        let [cos, sin] = coupled(Rule::of(24), [&rate(-1.5), &rate(1.5)]);
        // Sweeps end where they change no more than the first half of the digits.
        let off = (cos - 3f64.cos()).hypot(sin - 3f64.sin());
        assert!(off < 1e-7, "{off}");
    }
}
