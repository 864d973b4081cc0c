//! Loads that oppose motion: of known magnitude while there is motion, at rest whatever holds, up to the magnitude.
//!
//! With the magnitudes T of torques on the crank and D of forces on the slider, rest lasts while |Q − V'| ≤ T|θ'| + D|x'|,
//! and beyond that motion begins in the direction of Q − V' (Filippov's solution of the equation with their signs).

use super::friction::Free;
use super::{Arms, CurveEquation, CurveTerms, LoadValue, Loads, Place};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Interval, Reach};
use crate::scene::Instant;

/// Operations that round the value of a load.
const ROUNDINGS: f64 = 64.0;

/// Of the range of a load no ellipse around it is asked for.
const SOME_ELLIPSE: f64 = 2.0;

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

    /// How much [`Held::margin`] changes at most between two times (s), as far as the loads are enclosed.
    pub fn margin_change(&self, q: Angle, mu_static: f64, [from, to]: [f64; 2]) -> f64 {
        if !self.loads().have_detail() {
            return 0.0;
        }
        let reach = Reach {
            t: Interval::new(from, to),
            angle: Interval::point(q.radians()),
            speed: Interval::point(0.0),
            parts: 1.0,
        };
        let loads = self.loads();
        let seen = self.curve().seen(&reach, loads.meet_slider());
        let terms = self.across(q.rest);
        let arms = Arms {
            torque: terms.place.dtheta,
            force: terms.place.dx,
        };
        let detail = loads.detail(&seen, arms, SOME_ELLIPSE);
        let (arm, x_n) = (terms.place.dx.abs(), terms.x_n.abs());
        // What changes Q by one changes the torque by one at most and the force by 1/x'.
        let most = 1.0 + mu_static * (arm * terms.theta_n.abs() + 2.0 * x_n);
        let change = (detail.change - self.rounding(&terms, q, from)).max(0.0) * most;
        match self.loads().are_dry() {
            true => change,
            false if arm > 0.0 => change / arm,
            false => 0.0,
        }
    }

    /// What rounding leaves open of the generalized force of the loads at rest, N m.
    fn rounding(&self, terms: &CurveTerms, q: Angle, t: f64) -> f64 {
        let place = &terms.place;
        let LoadValue { torque, force } = self.load(place, t, q, 0.0);
        let most = self.loads().dry_magnitude(&self.instant(place, t, q, 0.0));
        let size = torque.abs() + most.torque + (force.abs() + most.force) * place.dx.abs();
        ROUNDINGS * f64::EPSILON * size
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
    fn push(&mut self, terms: &CurveTerms, load: LoadValue, speed: f64) {
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
