//! Loads that oppose motion: of known magnitude while there is motion, at rest whatever holds, up to the magnitude.
//!
//! With the magnitudes T of torques on the crank and D of forces on the slider, rest lasts while |Q − V'| ≤ T|θ'| + D|x'|,
//! and beyond that motion begins in the direction of Q − V' (Filippov's solution of the equation with their signs).

use super::friction::Free;
use super::{Across, Constrained, LoadValue};
use crate::numeric::angle::Angle;

/// Signs of the speeds of crank and slider that dry loads oppose; zero: they are at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sense {
    /// sgn(ω)
    pub crank: f64,
    /// sgn(v)
    pub slider: f64,
}

impl Sense {
    /// Of a speed of the crank (rad/s) and one of the slider (m/s).
    pub fn of(omega: f64, v: f64) -> Sense {
        Sense {
            crank: sign(omega),
            slider: sign(v),
        }
    }
}

/// sgn, zero at zero.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// The equation at rest, with what its dry loads hold.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// What is left for the guide to hold, or to move the mechanism.
    pub free: Free,
    /// What the dry loads hold with. Where several do, each does with the same part of its magnitude.
    pub dry: LoadValue,
    /// How much more they could hold, N m; negative: they cannot.
    spare: f64,
}

impl Held {
    /// What is left of all that holds, zero where it gives way: N of static friction at the guide, or N m with dry loads.
    /// These hold first, and the guide what they do not.
    pub fn margin(&self, mu_static: f64, dry: bool) -> f64 {
        if !dry {
            return self.free.band(mu_static);
        }
        let arm = self.free.dx.abs();
        let pressed = |normal: f64| mu_static * normal.abs() * arm;
        match (self.spare >= 0.0, self.free.holding()) {
            (true, _) => self.spare + pressed(self.free.held),
            (false, Some(touch)) => pressed(touch.normal) - self.free.pull.abs(),
            (false, None) => self.spare,
        }
    }
}

impl Constrained {
    /// [`Self::free`] of a motion that dry loads oppose in these senses, whatever the speed.
    pub fn free_against(&self, t: f64, q: Angle, speed: f64, sense: Sense) -> Free {
        self.against(&self.across(q.rest), t, q, speed, sense)
    }

    pub(super) fn against(
        &self,
        terms: &Across,
        t: f64,
        q: Angle,
        speed: f64,
        sense: Sense,
    ) -> Free {
        let mut free = self.without_dry(terms, t, q, speed);
        if self.loads().are_dry() {
            let now = self.instant(&terms.place, t, q, speed);
            free.push(terms, self.loads().dry(&now, sense), speed);
        }
        free
    }

    /// The mechanism at rest.
    pub fn held(&self, t: f64, q: Angle) -> Held {
        let terms = self.across(q.rest);
        let mut free = self.without_dry(&terms, t, q, 0.0);
        if !self.loads().are_dry() {
            return Held {
                free,
                dry: LoadValue::default(),
                spare: -free.pull.abs(),
            };
        }
        let place = &terms.place;
        let most = self.loads().dry_magnitude(&self.instant(place, t, q, 0.0));
        let band = most.torque * place.dtheta.abs() + most.force * place.dx.abs();
        let spare = band - free.pull.abs();
        let part = match spare >= 0.0 {
            true if band > 0.0 => -free.pull / band,
            true => 0.0,
            false => -sign(free.pull),
        };
        let dry = LoadValue {
            torque: part * most.torque * sign(place.dtheta),
            force: part * most.force * sign(place.dx),
        };
        free.push(&terms, dry, 0.0);
        if spare >= 0.0 {
            // What is held leaves nothing, not even rounding.
            free.pull = 0.0;
        }
        Held { free, dry, spare }
    }
}

impl Free {
    /// Adds a load to a motion at a speed (rad/s) of the coordinate.
    fn push(&mut self, terms: &Across, load: LoadValue, speed: f64) {
        let place = &terms.place;
        let along = load.torque * place.dtheta + load.force * place.dx;
        let aside = load.torque * terms.theta_n + load.force * terms.x_n;
        self.pull += along;
        self.acceleration += along / terms.m;
        self.held -= aside;
        self.normal += terms.a * along / terms.m - aside;
        self.power += along * speed;
    }
}
