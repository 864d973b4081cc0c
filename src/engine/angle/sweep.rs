//! Collocation on one panel: K' = F(θ) + L(θ, ω, t), t' = 1/ω at its points, by Picard iteration and Newton's method.

use super::dynamics::{Dynamics, StateVariable};
use super::newton::{correction, keep_positive, quadratic};
use super::panel::{PanelStart, PanelTable, Problem, SLOW_FACTOR};
use super::secant::Secant;
use super::solution::PanelSolution;
use crate::numeric::chebyshev::{Values, largest};
use crate::numeric::exact::SUM_ROUNDING;

/// Reason why a panel is not solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unsolved {
    /// Panel too long for its degree.
    TooLong,
    /// Kinetic energy not positive: the crank seems to stop on the panel.
    Stops,
}

/// Solves a panel to a tail of its series, from the guess of the kinetic energy at its points in `solution`.
pub(super) fn sweep(
    problem: &Problem<'_, impl Dynamics>,
    tail: f64,
    solution: &mut PanelSolution,
) -> Result<(), Unsolved> {
    let (dynamics, panel, start) = (problem.dynamics, problem.panel, problem.start);
    solution.evaluations = 0;
    solution.share = 1.0;
    (solution.first_change, solution.last_change) = (0.0, f64::INFINITY);
    if panel.is_in_closed_form(dynamics) {
        return solution.take_undamped(problem, tail);
    }
    // Evaluations of state loads cost more than the sweeps that they spare.
    let has_state_loads = dynamics.has_state_loads();
    // Error that the sweeps may leave, as a fraction of the tail: it adds up over the turns. Tabulated forces alone are
    // evaluated once more, which is another sweep for the energy gain.
    let error_share = 1e-2;
    // Rounding of the kinetic energy, relative to it: as a sum and as the work in it.
    let energy_rounding = 2.0 * f64::EPSILON;
    let largest_error = (error_share * tail).max(energy_rounding);
    // Convergence factor that a sweep is assumed to have at least, however much the last one gained.
    let least_factor = 1e-3;
    // Sweeps that gain the factor SLOW_FACTOR each reach rounding after 30.
    let most_sweeps = 40;
    // A linearised sweep costs as much as three plain ones, but for state loads: without them it does not pay where
    // plain ones gain 1.5 digits each.
    let plain = 0.03;
    let mut newton = false;
    let mut contraction = None;
    let [mut before, mut earlier] = [f64::INFINITY; 2];
    let variable = dynamics.state_variable();
    let mut secant: Option<Secant> = None;
    for _ in 0..most_sweeps {
        solution.evaluate(problem)?;
        let mut change = solution.change(panel, start);
        let contraction = *contraction.get_or_insert_with(|| solution.contraction(panel));
        let linear = contraction > plain
            || has_state_loads && variable.is_none() && panel.varies_with_speed();
        let now = variable.map(|variable| Secant::of(solution, variable));
        let left_out = match (newton, &secant, &now) {
            (false, Some(before), Some(now)) => {
                solution.follow_state_loads(panel, [before, now], !linear, &mut change)
            }
            _ => 1.0,
        };
        secant = now;
        newton = newton || linear && !solution.linearise(panel, &mut change);
        if newton {
            let rates = solution.forces.rates(problem);
            correction(panel.rule, panel.half(), &rates, &mut change).ok_or(Unsolved::TooLong)?;
            keep_positive(&solution.kinetic, &mut change);
        }
        let largest = add(&mut solution.kinetic, &mut change, panel.rule.degree() + 1)?;
        solution.last_change = largest;
        if before.is_infinite() {
            solution.first_change = largest;
        }
        // The forces are as accurate as the motion: more sweeps would not resolve them.
        if solution.forces_are_left_out(problem, tail, largest) {
            return Err(Unsolved::TooLong);
        }
        // The remaining error is the last change times the convergence factor; Newton's method squares it, as far as
        // the forces depend on the square root of the kinetic energy or on the energy itself.
        let measured = before
            .is_finite()
            .then(|| (largest / before).max(least_factor));
        let factor = match measured {
            _ if !linear && !newton && !has_state_loads => contraction,
            _ if linear && !newton && !has_state_loads => largest * quadratic(contraction),
            // The error of secants is of the order of the product of the last two.
            Some(_) if earlier.is_finite() && left_out < 1.0 => left_out.max(largest / earlier),
            Some(measured) => measured,
            None => panel.factor.get(),
        };
        let gains = before.is_finite() && largest < SLOW_FACTOR * before;
        let at_rounding = largest < SUM_ROUNDING && !gains;
        if newton {
            if largest * factor.min(SLOW_FACTOR) <= tail || at_rounding {
                solution.evaluate(problem)?;
                return solution.finish(problem, tail);
            }
        } else if largest * factor <= largest_error || at_rounding {
            // A linearised sweep corrects the forces with the energy.
            if has_state_loads || linear {
                solution.forces.take_speeds(panel, start, &solution.kinetic);
            } else {
                solution.evaluate(problem)?;
            }
            solution.finish(problem, tail)?;
            // Value at the last point, rounded once more; under steep loads the gain would be less accurate.
            solution.end = start.kinetic + solution.gain;
            return Ok(());
        } else if let Some(measured) = measured {
            panel.factor.set(measured);
            // Newton's method is one for the energy: of a load of time secants know more.
            newton = measured > SLOW_FACTOR && variable != Some(StateVariable::Time);
        }
        (earlier, before) = (before, largest);
    }
    Err(Unsolved::TooLong)
}

/// Adds a change (J) at the first `count` points; returns the largest relative change.
fn add(kinetic: &mut Values, change: &mut Values, count: usize) -> Result<f64, Unsolved> {
    let (kinetic, change) = (&mut kinetic[..count], &mut change[..count]);
    let mut positive = true;
    for j in 0..count {
        kinetic[j] += change[j];
        change[j] /= kinetic[j];
        positive &= kinetic[j] > 0.0;
    }
    if positive {
        Ok(largest(change))
    } else if kinetic.iter().any(|kinetic| kinetic.is_nan()) {
        Err(Unsolved::TooLong)
    } else {
        Err(Unsolved::Stops)
    }
}

impl PanelSolution {
    /// Evaluates the forces at the present kinetic energy.
    fn evaluate(&mut self, problem: &Problem<'_, impl Dynamics>) -> Result<(), Unsolved> {
        self.evaluations += problem.panel.rule.degree() as u64 + 1;
        let known = self.forces.evaluate(problem, &self.kinetic);
        known.ok_or(Unsolved::TooLong)
    }

    /// Computes the motion in closed form.
    fn take_undamped(
        &mut self,
        problem: &Problem<'_, impl Dynamics>,
        tail: f64,
    ) -> Result<(), Unsolved> {
        let (panel, start) = (problem.panel, problem.start);
        self.kinetic = panel.undamped(start.kinetic);
        let points = &self.kinetic[..=panel.rule.degree()];
        if points.iter().any(|kinetic| *kinetic <= 0.0) {
            return Err(Unsolved::Stops);
        }
        self.evaluate(problem)?;
        self.finish(problem, tail)
    }

    /// Returns the change that a sweep makes, J.
    fn change<P: Copy>(&self, panel: &PanelTable<P>, start: PanelStart) -> Values {
        let half = panel.half();
        let mut change = panel.rule.integrals(&self.forces.total);
        for (change, kinetic) in change.iter_mut().zip(&self.kinetic) {
            *change = start.kinetic + half * *change - kinetic;
        }
        change
    }

    /// Returns a bound of the contraction factor of plain sweeps for the tabulated forces: ∫ |∂F/∂K| over the panel.
    fn contraction<P: Copy>(&self, panel: &PanelTable<P>) -> f64 {
        if !panel.varies_with_speed() {
            return 0.0;
        }
        let rates = self.forces.rates_of_table(panel);
        2.0 * panel.half().abs() * largest(&rates[..=panel.rule.degree()])
    }

    /// Checks that the series are resolved, at the speeds of the last evaluation.
    fn finish(&mut self, problem: &Problem<'_, impl Dynamics>, tail: f64) -> Result<(), Unsolved> {
        let panel = problem.panel;
        let (rule, half) = (panel.rule, panel.half());
        let known = self.forces.fill_slopes(panel, &mut self.slopes);
        known.ok_or(Unsolved::TooLong)?;
        self.slope = rule.series(&self.slopes);
        let noise = noise_of_angle(panel);
        // Ratio of the last terms of a slowly decaying series of speeds to its truncation error.
        let terms_per_error = 0.25;
        let wanted = (terms_per_error * tail).max(tail.min(SUM_ROUNDING));
        if self.slope.tail() > wanted.max(noise) {
            return Err(Unsolved::TooLong);
        }
        if self.forces_are_left_out(problem, tail, 0.0) {
            return Err(Unsolved::TooLong);
        }
        self.end = self.kinetic[rule.degree()];
        self.gain = half * rule.rounded_integral(&self.forces.total);
        Ok(())
    }

    /// True if the last terms of the forces, with relative error `uncertain`, are too large for their series to end.
    fn forces_are_left_out(
        &mut self,
        problem: &Problem<'_, impl Dynamics>,
        tail: f64,
        uncertain: f64,
    ) -> bool {
        let panel = problem.panel;
        let (rule, half) = (panel.rule, panel.half());
        let last = (1.0 - uncertain) * rule.last_terms(&self.forces.total);
        let largest = largest(&self.forces.total[..=rule.degree()]);
        let energy = half.abs() / problem.start.kinetic;
        // Large forces in equilibrium leave their rounding.
        let allowed = tail + SUM_ROUNDING * panel.largest_force * energy;
        let of_angle = tail.max(noise_of_angle(panel));
        let is_large =
            last * energy > allowed && last > of_angle * largest && last / largest > allowed;
        if !is_large || !problem.dynamics.reads_time() {
            return is_large;
        }
        let (forces, evaluations) = (&self.forces, &mut self.evaluations);
        !forces.may_be_rounded_times(problem, last, evaluations)
    }
}

/// Returns the rounding floor of the series on a panel due to its rounded angles, relative to their size.
fn noise_of_angle<P: Copy>(panel: &PanelTable<P>) -> f64 {
    8.0 * f64::EPSILON * (1.0 + panel.piece.from.abs() / panel.half().abs())
}
