//! Generalized forces at the points of a panel, from the kinetic energy there.

use super::Dynamics;
use super::panel::{PanelStart, PanelTable};
use crate::numeric::LANES;
use crate::numeric::chebyshev::{MAX_DEGREE, Values};
use crate::numeric::enclosure::Interval;

/// Generalized forces at the points of a panel, N m.
pub(super) struct Forces {
    pub total: Values,
    /// Non-conservative forces.
    pub non_conservative: Values,
    /// Speeds, rad/s.
    pub speeds: Values,
    /// Times after the start of the panel, s.
    times: Values,
}

impl Forces {
    pub fn new() -> Forces {
        let zero = [0.0; MAX_DEGREE + 1];
        Forces {
            total: zero,
            non_conservative: zero,
            speeds: zero,
            times: zero,
        }
    }

    /// Evaluates the forces from the kinetic energy at the points, J. None where they are not finite.
    pub fn evaluate<D: Dynamics>(
        &mut self,
        dynamics: &D,
        panel: &PanelTable<D::Place>,
        start: PanelStart,
        kinetic: &Values,
    ) -> Option<()> {
        let count = panel.rule.degree() + 1;
        for values in [
            &mut self.total,
            &mut self.non_conservative,
            &mut self.speeds,
        ] {
            values[count..].fill(0.0);
        }
        self.take_speeds(panel, start, kinetic);
        let (push, damping) = (&panel.table.push[..count], &panel.table.damping[..count]);
        let (speeds, non_conservative) =
            (&self.speeds[..count], &mut self.non_conservative[..count]);
        for j in 0..count {
            non_conservative[j] = push[j] - damping[j] * speeds[j];
        }
        if let Some(switch) = &panel.table.switch {
            for j in 0..count {
                non_conservative[j] += switch.force[j] * (speeds[j] * speeds[j]);
            }
        }
        if dynamics.has_state_loads() {
            if dynamics.reads_time() {
                let mut slopes = [0.0; MAX_DEGREE + 1];
                self.fill_slopes(panel, &mut slopes)?;
                self.times = panel.rule.integrals(&slopes);
            }
            let whole = count - count % LANES;
            for j in (0..whole).step_by(LANES) {
                self.add_state_loads::<D, LANES>(dynamics, panel, start, j);
            }
            for j in whole..count {
                self.add_state_loads::<D, 1>(dynamics, panel, start, j);
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

    /// Adds the state loads at N points.
    fn add_state_loads<D: Dynamics, const N: usize>(
        &mut self,
        dynamics: &D,
        panel: &PanelTable<D::Place>,
        start: PanelStart,
        first: usize,
    ) {
        let state = |j| panel.state(start.turns, j, start.t + self.times[j], self.speeds[j]);
        let forces = dynamics.state_loads(&std::array::from_fn::<_, N, _>(|i| state(first + i)));
        for (non_conservative, force) in self.non_conservative[first..].iter_mut().zip(forces) {
            *non_conservative += force;
        }
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
    pub fn rates<D: Dynamics>(
        &self,
        dynamics: &D,
        panel: &PanelTable<D::Place>,
        start: PanelStart,
    ) -> Values {
        let mut rates = self.rates_of_table(panel);
        if !dynamics.has_state_loads() {
            return rates;
        }
        // Relative step of least error for a central difference.
        let step = f64::EPSILON.cbrt();
        let count = panel.rule.degree() + 1;
        for (j, rate) in rates.iter_mut().enumerate().take(count) {
            let (speed, t) = (self.speeds[j], start.t + self.times[j]);
            let speeds = [speed * (1.0 - step), speed * (1.0 + step)];
            let at = speeds.map(|speed| panel.state(start.turns, j, t, speed));
            let [less, more] = dynamics.state_loads(&at);
            let slope = (more - less) / (speeds[1] - speeds[0]);
            *rate += slope / (panel.table.inertia[j] * speed);
        }
        rates
    }
}

/// True if all values are finite: otherwise their sum is not.
fn is_finite(values: &[f64]) -> bool {
    values.iter().sum::<f64>().is_finite()
}
