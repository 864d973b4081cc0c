//! Rounding error of the forces: near a balance they are small differences of large terms.

use super::Equation;
use crate::numeric::angle::Angle;
use crate::scene::Instant;

impl Equation {
    /// Returns the size of the terms whose sum is M θ̈, N m, at time t (s), crank angle and speed (rad/s): rounding may
    /// change the sum by half a unit in the last place of it. A load F counts with |F| + |dF/dx| (|x| + r), and its
    /// lever x' = −r (sin θ + cos θ tan φ) with both parts.
    pub fn size_of_terms(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> f64 {
        let theta = theta.into();
        let terms = self.terms(theta.rest);
        let pose = &terms.pose;
        let now = pose.instant(t, theta, omega);
        let change = f64::EPSILON.cbrt();
        let place = pose.x.abs() + self.linkage().r;
        let moved = Instant {
            x: pose.x + change * place,
            ..now
        };
        let [here, there] = [now, moved].map(|now| self.loads().at(&now));
        let changed = |here: f64, there: f64| here.abs() + (there - here).abs() / change;
        let lever = pose.dx.abs();
        let parts = self.linkage().r * (pose.cos * pose.sin_phi / pose.cos_phi).abs();
        let force = changed(here.force, there.force) * lever + here.force.abs() * parts;
        let inertia = (terms.inertia.half_dm * omega * omega).abs();
        force + changed(here.torque, there.torque) + terms.dv.abs() + inertia
    }
}
