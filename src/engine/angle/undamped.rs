//! Motion on a panel without damping and state loads in closed form: K' = b K + F with the integrating factor exp ∫ b.

use super::Dynamics;
use super::panel::PanelTable;
use crate::numeric::chebyshev::{MAX_DEGREE, Values};
use crate::numeric::exponential;

impl<P: Copy> PanelTable<P> {
    /// Tabulates the motion under forces of the position alone and of the switch: K = growth·(K₀ + work).
    pub(super) fn fill_work(&mut self) {
        let (half, count) = (self.half(), self.rule.degree() + 1);
        let mut force = self.force_of_position();
        if let Some(switch) = &self.table.switch {
            let mut rates = [0.0; MAX_DEGREE + 1];
            let forces = switch.force.iter().zip(&self.mobility);
            for (rate, (force, mobility)) in rates.iter_mut().zip(forces).take(count) {
                *rate = force * mobility;
            }
            let mut growth = self.growth.take().unwrap_or_else(|| Box::new(rates));
            *growth = exponential::of(&self.rule.integrals(&rates).map(|rate| half * rate));
            for (growth, force) in growth[..count].iter().zip(&mut force) {
                *force /= growth;
            }
            self.growth = Some(growth);
        }
        self.work = self.rule.integrals(&force);
        for work in &mut self.work[..count] {
            *work *= half;
        }
    }

    /// True if the panel has neither damping nor state loads: its motion is known in closed form.
    pub fn is_in_closed_form(&self, dynamics: &impl Dynamics) -> bool {
        !self.damped && !dynamics.has_state_loads()
    }

    /// Returns the kinetic energy at the points, J, without damping and state loads, from that at the start, J.
    pub fn undamped(&self, start: f64) -> Values {
        let mut kinetic = self.work.map(|work| start + work);
        if let Some(growth) = &self.growth {
            for (kinetic, factor) in kinetic.iter_mut().zip(growth.iter()) {
                *kinetic *= factor;
            }
        }
        kinetic
    }

    /// Guesses the kinetic energy at the points, J, from that at the start: by the profiles of the last turns, or as
    /// the motion without damping. Where loads read time, turns of equal energy differ, and few profiles serve.
    pub fn guess(&self, start: f64, reads_time: bool, kinetic: &mut Values) {
        let most = if reads_time { 2 } else { usize::MAX };
        if self.past.carry_on(start, most, kinetic).is_some() {
            return;
        }
        *kinetic = self.undamped(start);
        let points = &kinetic[..=self.rule.degree()];
        if self.damped || points.iter().any(|kinetic| *kinetic <= 0.0) {
            // Constant speed: damping tends to maintain it.
            let inertia = &self.table.inertia;
            *kinetic = inertia.map(|here| start * (here / inertia[0]));
        }
    }
}
