//! Generalized forces at the points of a panel, from the kinetic energy there.

use std::array::from_fn;

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
    /// J: a late load acts at another angle. A load that does not change in time is not late.
    pub fn uncertain_by_time(&self, problem: &Problem<'_, impl Dynamics>) -> f64 {
        let count = problem.panel.rule.degree() + 1;
        let changes = self.changes_in_time(problem).map(|change| change.powi(2));
        let change = changes.sum::<f64>().sqrt();
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
        let of_all = self.non_conservative[..count].windows(2);
        // Needs no evaluation, and tells most terms that do not decay apart.
        if terms > self.last_terms_by_time(problem.start.t, of_all.map(|pair| pair[1] - pair[0])) {
            return false;
        }
        *evaluations += count as u64;
        terms <= self.last_terms_by_time(problem.start.t, self.changes_in_time(problem))
    }

    /// Bounds the last two terms that times rounded near t leave of forces with these changes from point to point, N m:
    /// each is at most twice the largest error at a point.
    fn last_terms_by_time(&self, t: f64, changes: impl Iterator<Item = f64>) -> f64 {
        let lasts = self.times.windows(2).map(|pair| pair[1] - pair[0]);
        let slopes = changes.zip(lasts).filter(|(_, last)| *last > 0.0);
        let steepest = slopes.fold(0.0, |most: f64, (change, last)| {
            most.max((change / last).abs())
        });
        4.0 * f64::EPSILON * t.abs() * steepest
    }

    /// Returns the changes of the forces from point to point by the time alone, N m.
    fn changes_in_time(&self, problem: &Problem<'_, impl Dynamics>) -> impl Iterator<Item = f64> {
        let panel = problem.panel;
        let [mut frozen, zero] = [[0.0; MAX_DEGREE + 1]; 2];
        tabulated(panel, &self.speeds, &mut frozen);
        add_state_loads(problem, [&self.speeds, &zero], &mut frozen);
        let due_to_time = move |j: usize| self.non_conservative[j] - frozen[j];
        (1..=panel.rule.degree()).map(move |j| due_to_time(j) - due_to_time(j - 1))
    }

    /// Returns the derivatives of the tabulated forces with respect to the kinetic energy at the points, 1/rad.
    pub fn rates_of_table<P: Copy>(&self, panel: &PanelTable<P>) -> Values {
        let count = panel.rule.degree() + 1;
        let (table, speeds) = (&panel.table, &self.speeds[..count]);
        let mut rates = [0.0; MAX_DEGREE + 1];
        for j in 0..count {
            rates[j] = -table.damping[j] / (table.inertia[j] * speeds[j]);
        }
        if let Some(switch) = &table.switch {
            let forces = switch.force.iter().zip(&panel.mobility);
            for (rate, (force, mobility)) in rates.iter_mut().zip(forces).take(count) {
                *rate += force * mobility;
            }
        }
        rates
    }

    /// Returns the derivatives of all forces with respect to the kinetic energy at the points, 1/rad.
    pub fn rates(&self, problem: &Problem<'_, impl Dynamics>) -> Values {
        let (dynamics, panel) = (problem.dynamics, problem.panel);
        let mut rates = self.rates_of_table(panel);
        if !dynamics.has_state_loads() || dynamics.state_variable() == Some(StateVariable::Time) {
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
