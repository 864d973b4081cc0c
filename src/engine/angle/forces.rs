//! Generalized forces at the points of a panel, from the kinetic energy there.

use std::array::from_fn;

use super::Switch;
use super::dynamics::{Dynamics, StateVariable};
use super::panel::{PanelStart, PanelTable, Problem};
use crate::numeric::chebyshev::{MAX_DEGREE, Values, largest};
use crate::numeric::enclosure::Interval;
use crate::numeric::{LANES, ROUNDING_DEVIATION};

/// Generalized forces at the points of a panel, N m.
pub(super) struct Forces {
    pub total: Values,
    /// Non-conservative forces.
    pub non_conservative: Values,
    /// Speeds, rad/s.
    pub speeds: Values,
    /// Forces of the state loads.
    pub of_state: Values,
    /// Times after the rounded time at the start of the panel, s.
    pub times: Values,
}

impl Forces {
    pub fn new() -> Forces {
        let zero = [0.0; MAX_DEGREE + 1];
        Forces {
            total: zero,
            non_conservative: zero,
            speeds: zero,
            of_state: zero,
            times: zero,
        }
    }

    /// Evaluates the forces from the kinetic energy at the points, J. None where they are not finite.
    pub fn evaluate(
        &mut self,
        problem: &Problem<'_, impl Dynamics>,
        kinetic: &Values,
    ) -> Option<()> {
        let (dynamics, panel, start) = (problem.dynamics, problem.panel, problem.start);
        let count = panel.rule.degree() + 1;
        for values in [
            &mut self.total,
            &mut self.non_conservative,
            &mut self.speeds,
        ] {
            values[count..].fill(0.0);
        }
        self.take_speeds(panel, start, kinetic);
        tabulated(panel, &self.speeds, &mut self.non_conservative);
        if dynamics.has_state_loads() {
            if dynamics.reads_time() {
                let mut slopes = [0.0; MAX_DEGREE + 1];
                self.fill_slopes(panel, &mut slopes)?;
                self.times = panel.rule.integrals(&slopes);
                for time in &mut self.times[..count] {
                    *time += start.t_low;
                }
            }
            self.of_state = [0.0; MAX_DEGREE + 1];
            let at = [&self.speeds, &self.times];
            add_state_loads(problem, at, &mut self.of_state);
            for j in 0..count {
                self.non_conservative[j] += self.of_state[j];
            }
        }
        let (force, non_conservative) =
            (&panel.table.force[..count], &self.non_conservative[..count]);
        let total = &mut self.total[..count];
        for j in 0..count {
            total[j] = force[j] + non_conservative[j];
        }
        is_finite(total).then_some(())
    }

    /// Adds non-conservative forces at the first `count` points.
    pub fn add(&mut self, more: &Values, count: usize) {
        for (j, more) in more[..count].iter().enumerate() {
            self.total[j] += more;
            self.non_conservative[j] += more;
        }
    }

    /// Computes the speeds at the points from the kinetic energy there, J.
    pub fn take_speeds<P: Copy>(&mut self, panel: &PanelTable<P>, start: PanelStart, all: &Values) {
        let count = panel.rule.degree() + 1;
        let (kinetic, mobility) = (&all[..count], &panel.mobility[..count]);
        let speeds = &mut self.speeds[..count];
        for j in 0..count {
            speeds[j] = start.direction * (kinetic[j] * mobility[j]).sqrt();
        }
    }

    /// Returns the range of the speed at the first `count` points, rad/s.
    pub fn speed_range(&self, count: usize) -> Interval {
        let points = self.speeds[..count].iter().copied().map(Interval::point);
        points.reduce(Interval::hull).unwrap_or_default()
    }

    /// Computes |dt/dx| at the points, s; none if it is not finite.
    pub fn fill_slopes<P: Copy>(&self, panel: &PanelTable<P>, slopes: &mut Values) -> Option<()> {
        let half = panel.half();
        let (filled, rest) = slopes.split_at_mut(panel.rule.degree() + 1);
        rest.fill(0.0);
        for (slope, speed) in filled.iter_mut().zip(&self.speeds) {
            *slope = half / speed;
        }
        is_finite(filled).then_some(())
    }

    /// Returns the error of the work on a panel due to times rounded at the points, independently, over machine epsilon,
    /// J, from the slopes of the forces by the time at the points, N m/s: a late load acts at another angle.
    pub fn uncertain_by_time(&self, problem: &Problem<'_, impl Dynamics>, by_time: &Values) -> f64 {
        let count = problem.panel.rule.degree() + 1;
        let lasts = self.times[..count].windows(2);
        let changes = lasts
            .zip(by_time)
            .map(|(pair, slope)| slope * (pair[1] - pair[0]));
        let change = changes.map(|change| change.powi(2)).sum::<f64>().sqrt();
        // Two deviations of two roundings: of the time, and of what a load makes of it.
        let roundings = 2.0 * ROUNDING_DEVIATION * std::f64::consts::SQRT_2;
        roundings * (problem.start.t * largest(&self.speeds[..count])).abs() * change
    }

    /// Whether the last two terms of the forces, N m, may be what rounded times at the points leave of them, which no
    /// shorter panel reduces; counts the evaluations for it.
    pub fn may_be_rounded_times(
        &self,
        problem: &Problem<'_, impl Dynamics>,
        terms: f64,
        evaluations: &mut u64,
    ) -> bool {
        let count = problem.panel.rule.degree() + 1;
        let pairs = self.non_conservative[..count]
            .windows(2)
            .zip(self.times.windows(2));
        let slopes = pairs.map(|(force, time)| (force[1] - force[0]) / (time[1] - time[0]));
        // Each error at a point leaves at most twice itself in the last two terms.
        let left_by = |slope: f64| 4.0 * f64::EPSILON * problem.start.t.abs() * slope;
        // Needs no evaluation, and tells most terms that do not decay apart.
        let steepest = slopes.fold(0.0, |most: f64, slope| most.max(slope.abs()));
        if terms > left_by(steepest) {
            return false;
        }
        *evaluations += count as u64;
        terms <= left_by(largest(&self.slopes_by_time(problem)[..count]))
    }

    /// Returns the derivatives of the forces with respect to the time at the points, N m/s; one evaluation.
    pub fn slopes_by_time(&self, problem: &Problem<'_, impl Dynamics>) -> Values {
        let later = towards_middle(problem, &self.times);
        let at = [&self.speeds, &from_fn(|j| self.times[j] + later[j])];
        let mut slopes = [0.0; MAX_DEGREE + 1];
        add_state_loads(problem, at, &mut slopes);
        for j in 0..=problem.panel.rule.degree() {
            slopes[j] = (slopes[j] - self.of_state[j]) / later[j];
        }
        slopes
    }

    /// Returns the mean derivative of the forces with respect to the kinetic energy over a panel, 1/rad, by Simpson's rule;
    /// counts the evaluations for it.
    pub fn mean_rate(&self, problem: &Problem<'_, impl Dynamics>, evaluations: &mut u64) -> f64 {
        let (dynamics, panel) = (problem.dynamics, problem.panel);
        let weights = [1.0, 4.0, 1.0].map(|weight| weight / 6.0);
        let points: [usize; 3] = from_fn(|k| k * panel.rule.degree() / 2);
        let mut rates = points.map(|j| self.rate_of_table(panel, j));
        if depend_on_energy(dynamics) {
            *evaluations += points.len() as u64;
            let faster = towards_middle(problem, &self.speeds);
            let time = |j: usize| problem.start.t + self.times[j];
            let states = points.map(|j| problem.state(j, time(j), self.speeds[j] + faster[j]));
            let changed = dynamics.state_loads(&states);
            for (k, j) in points.into_iter().enumerate() {
                let by_speed = (changed[k] - self.of_state[j]) / faster[j];
                rates[k] += by_speed / (panel.table.inertia[j] * self.speeds[j]);
            }
        }
        rates
            .iter()
            .zip(weights)
            .map(|(rate, weight)| rate * weight)
            .sum()
    }

    /// Returns the derivative of the tabulated forces with respect to the kinetic energy at point j, 1/rad.
    #[inline(always)]
    fn rate_of_table<P: Copy>(&self, panel: &PanelTable<P>, j: usize) -> f64 {
        let table = &panel.table;
        let by_damping = -table.damping[j] / (table.inertia[j] * self.speeds[j]);
        let by_switch = |switch: &Switch| switch.force[j] * panel.mobility[j];
        by_damping + table.switch.as_deref().map_or(0.0, by_switch)
    }

    /// Returns the derivatives of the tabulated forces with respect to the kinetic energy at the points, 1/rad.
    pub fn rates_of_table<P: Copy>(&self, panel: &PanelTable<P>) -> Values {
        let mut rates = [0.0; MAX_DEGREE + 1];
        for (j, rate) in rates.iter_mut().enumerate().take(panel.rule.degree() + 1) {
            *rate = self.rate_of_table(panel, j);
        }
        rates
    }

    /// Returns the derivatives of all forces with respect to the kinetic energy at the points, 1/rad.
    pub fn rates(&self, problem: &Problem<'_, impl Dynamics>) -> Values {
        let (dynamics, panel) = (problem.dynamics, problem.panel);
        let mut rates = self.rates_of_table(panel);
        if !depend_on_energy(dynamics) {
            return rates;
        }
        // Relative step of least error for a central difference.
        let step = f64::EPSILON.cbrt();
        let count = panel.rule.degree() + 1;
        for (j, rate) in rates.iter_mut().enumerate().take(count) {
            let (speed, t) = (self.speeds[j], problem.start.t + self.times[j]);
            let speeds = [speed * (1.0 - step), speed * (1.0 + step)];
            let at = speeds.map(|speed| problem.state(j, t, speed));
            let [less, more] = dynamics.state_loads(&at);
            let slope = (more - less) / (speeds[1] - speeds[0]);
            *rate += slope / (panel.table.inertia[j] * speed);
        }
        rates
    }
}

/// Returns small differences towards the value in the middle of the panel: loads may jump at its ends.
fn towards_middle(problem: &Problem<'_, impl Dynamics>, values: &Values) -> Values {
    let degree = problem.panel.rule.degree();
    // Larger than the square root of a rounding, as times are rounded more the later they are.
    let size = 1e-5 * largest(&values[..=degree]);
    let middle = values[degree / 2];
    values.map(|value| size.copysign(middle - value))
}

/// True if there are state loads that depend on the speed.
fn depend_on_energy(dynamics: &impl Dynamics) -> bool {
    dynamics.has_state_loads() && dynamics.state_variable() != Some(StateVariable::Time)
}

/// Computes the tabulated forces without potential at the points, at these speeds, rad/s.
fn tabulated<P: Copy>(panel: &PanelTable<P>, speeds: &Values, to: &mut Values) {
    let count = panel.rule.degree() + 1;
    let (push, damping) = (&panel.table.push[..count], &panel.table.damping[..count]);
    let (speeds, to) = (&speeds[..count], &mut to[..count]);
    for j in 0..count {
        to[j] = push[j] - damping[j] * speeds[j];
    }
    if let Some(switch) = &panel.table.switch {
        for j in 0..count {
            to[j] += switch.force[j] * (speeds[j] * speeds[j]);
        }
    }
}

/// Points at which state loads are evaluated together.
const BATCH: usize = 2 * LANES;

/// Adds the state loads at the points, at these speeds, rad/s, and times after the rounded start of the panel, s.
fn add_state_loads(
    problem: &Problem<'_, impl Dynamics>,
    [speeds, times]: [&Values; 2],
    to: &mut Values,
) {
    let (dynamics, count) = (problem.dynamics, problem.panel.rule.degree() + 1);
    let state = |j: usize| problem.state(j, problem.start.t + times[j], speeds[j]);
    let whole = count - count % BATCH;
    for j in (0..whole).step_by(BATCH) {
        let forces = dynamics.state_loads(&from_fn::<_, BATCH, _>(|i| state(j + i)));
        for (to, force) in to[j..].iter_mut().zip(forces) {
            *to += force;
        }
    }
    for (j, to) in to.iter_mut().enumerate().take(count).skip(whole) {
        let [force] = dynamics.state_loads(&[state(j)]);
        *to += force;
    }
}

/// True if all values are finite: otherwise their sum is not.
fn is_finite(values: &[f64]) -> bool {
    values.iter().sum::<f64>().is_finite()
}
