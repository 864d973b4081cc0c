//! Loads that oppose motion: of known magnitude while there is motion, at rest whatever holds, up to the magnitude.
//!
//! With the magnitudes T of torques on the crank and D of forces on the slider, rest lasts while |Q − V'| ≤ T|θ'| + D|x'|,
//! and beyond that motion begins in the direction of Q − V' (Filippov's solution of the equation with their signs).

use super::friction::Free;
use super::{CurveEquation, CurveTerms, LoadValue, Loads, Place};
use crate::numeric::angle::Angle;
use crate::scene::Instant;

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
pub(super) fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

impl Loads {
    /// Torque and force of the dry loads against this speed, at slider position x (m) and x' (m/rad).
    pub(super) fn dry_of_speed(
        &self,
        t: f64,
        theta: Angle,
        omega: f64,
        [x, dx]: [f64; 2],
    ) -> LoadValue {
        if self.dry.is_empty() {
            return LoadValue::default();
        }
        self.dry.value(&Instant {
            t,
            theta: theta.radians(),
            omega,
            x,
            v: dx * omega,
        })
    }

    /// Whether there are loads that oppose motion.
    pub fn are_dry(&self) -> bool {
        !self.dry.is_empty()
    }

    /// Whether such loads act on the crank, and on the slider.
    pub fn dry_on(&self) -> [bool; 2] {
        [&self.dry.torques, &self.dry.forces].map(|loads| !loads.is_empty())
    }

    /// What they oppose motion with at most, N m and N.
    pub fn dry_magnitude(&self, now: &Instant) -> LoadValue {
        self.dry.magnitude(now)
    }

    /// Torque and force of the dry loads against motion in these senses.
    pub fn dry(&self, now: &Instant, against: Sense) -> LoadValue {
        let most = self.dry_magnitude(now);
        LoadValue {
            torque: -against.crank * most.torque,
            force: -against.slider * most.force,
        }
    }
}

impl CurveEquation {
    /// Torque and force of the loads, without friction; dry ones against this speed.
    pub fn load(&self, place: &Place, t: f64, q: Angle, speed: f64) -> LoadValue {
        let sense = Sense::of(place.dtheta * speed, place.dx * speed);
        let dry = self.loads().dry(&self.instant(place, t, q, speed), sense);
        self.load_beside(dry, place, t, q, speed)
    }

    /// Value of the loads beside what is known of the dry ones.
    pub fn load_beside(
        &self,
        dry: LoadValue,
        place: &Place,
        t: f64,
        q: Angle,
        speed: f64,
    ) -> LoadValue {
        let spent = self.loads().spent(&self.instant(place, t, q, speed));
        let stored = self.loads().with_potential_at(place.x);
        LoadValue {
            torque: stored.torque + spent.torque + dry.torque,
            force: stored.force + spent.force + dry.force,
        }
    }

    /// [`Self::free`] of a motion that dry loads oppose in these senses, whatever the speed.
    pub fn free_against(&self, t: f64, q: Angle, speed: f64, sense: Sense) -> Free {
        self.against(&self.across(q.rest), t, q, speed, sense)
    }

    pub(super) fn against(
        &self,
        terms: &CurveTerms,
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
}

impl Free {
    /// Adds a load to a motion at a speed (rad/s) of the coordinate.
    pub(super) fn push(&mut self, terms: &CurveTerms, load: LoadValue, speed: f64) {
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
