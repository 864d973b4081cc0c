//! Rest at a coordinate: forces of dry loads and guide friction that hold the mechanism, and their margin.

use super::friction::Free;
use super::nonlinear_loads::sign;
use super::{CurveEquation, CurveTerms, LoadValue, UnitLoadEffects};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Interval, MotionPiece};
use crate::numeric::exact::SUM_ROUNDING;

/// Mechanism at rest at a coordinate q.
pub struct AtRest<'a> {
    /// Equation on the curve.
    pub equation: &'a CurveEquation,
    terms: CurveTerms,
    q: Angle,
}

impl CurveEquation {
    /// Returns the mechanism at rest at a coordinate.
    pub fn at_rest(&self, q: Angle) -> AtRest<'_> {
        AtRest {
            equation: self,
            terms: self.terms(q.rest),
            q,
        }
    }
}

/// Forces on the mechanism at rest, with the values at which the dry loads hold it.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// Generalized force left for the guide to hold, or to move the mechanism.
    pub free: Free,
    /// Values at which the dry loads hold; several loads each take the same part of their magnitude.
    pub dry: LoadValue,
    /// Reserve of the dry loads, N m: band less pull; negative: they cannot hold.
    spare: f64,
}

impl AtRest<'_> {
    /// Returns the margin at a time (s) of all that holds, zero where it gives way: static friction at the guide in N,
    /// or N m with dry loads. The dry loads hold first, the guide holds the rest.
    pub fn margin(&self, t: f64, mu_static: f64) -> f64 {
        let Held { free, spare, .. } = self.held(t);
        if !self.equation.loads().are_dry() {
            return free.band(mu_static);
        }
        let arm = free.dx.abs();
        let pressed = |normal: f64| mu_static * normal.abs() * arm;
        match (spare >= 0.0, free.holding()) {
            (true, _) => spare + pressed(free.normal_at_rest),
            (false, Some(touch)) => pressed(touch.normal) - free.pull.abs(),
            (false, None) => spare,
        }
    }

    /// Bounds the change of [`AtRest::margin`] between two times (s), N or N m, from enclosures of the loads.
    pub fn margin_change(&self, mu_static: f64, [from, to]: [f64; 2]) -> f64 {
        let loads = self.equation.loads();
        if !loads.vary_between_nodes() {
            return 0.0;
        }
        let piece = MotionPiece {
            t: Interval::new(from, to),
            angle: Interval::point(self.q.radians()),
            speed: Interval::point(0.0),
        };
        let state = self
            .equation
            .curve()
            .enclosed_state(&piece, loads.slider_use());
        let terms = &self.terms;
        let effects = UnitLoadEffects {
            torque: terms.pose.dtheta,
            force: terms.pose.dx,
        };
        // Only the range of a load on the interval is used: any size of the ellipse serves.
        let variation = loads.variation(&state, effects, 2.0);
        let (arm, x_n) = (terms.pose.dx.abs(), terms.x_n.abs());
        // A change of Q by one changes the torque by one at most and the force by 1/x'.
        let most = 1.0 + mu_static * (arm * terms.theta_n.abs() + 2.0 * x_n);
        let change = (variation.change - self.rounding(from)).max(0.0) * most;
        match loads.are_dry() {
            true => change,
            false if arm > 0.0 => change / arm,
            false => 0.0,
        }
    }

    /// Returns the rounding error of the generalized force of the loads at rest, N m.
    fn rounding(&self, t: f64) -> f64 {
        let pose = &self.terms.pose;
        let LoadValue { torque, force } = self.equation.load(pose, t, self.q, 0.0);
        let most = self.dry_magnitude(t);
        let size = torque.abs() + most.torque + (force.abs() + most.force) * pose.dx.abs();
        SUM_ROUNDING * size
    }

    /// Returns the magnitudes with which the dry loads oppose motion, N m and N.
    fn dry_magnitude(&self, t: f64) -> LoadValue {
        let now = self.equation.instant(&self.terms.pose, t, self.q, 0.0);
        self.equation.loads().dry_magnitude(&now)
    }

    /// Returns the forces that hold the mechanism at a time, s.
    pub fn held(&self, t: f64) -> Held {
        let terms = &self.terms;
        let now = self.equation.instant(&terms.pose, t, self.q, 0.0);
        let mut free = self.equation.without_dry(terms, &now, 0.0);
        if !self.equation.loads().are_dry() {
            return Held {
                free,
                dry: LoadValue::default(),
                spare: -free.pull.abs(),
            };
        }
        let pose = &terms.pose;
        let most = self.dry_magnitude(t);
        let band = most.torque * pose.dtheta.abs() + most.force * pose.dx.abs();
        let spare = band - free.pull.abs();
        let part = match spare >= 0.0 {
            true if band > 0.0 => -free.pull / band,
            true => 0.0,
            false => -sign(free.pull),
        };
        let dry = LoadValue {
            torque: part * most.torque * sign(pose.dtheta),
            force: part * most.force * sign(pose.dx),
        };
        free.push(terms, dry, 0.0);
        if spare >= 0.0 {
            // Equilibrium: no pull is left, not even rounding.
            free.pull = 0.0;
        }
        Held { free, dry, spare }
    }
}
