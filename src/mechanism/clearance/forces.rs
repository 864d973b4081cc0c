//! Forces in the loose joint, and the accelerations that follow from them by the Newton-Euler equations.

use super::rubbing::Rubbing;
use super::{Action, Frame, LooseMechanism};
use crate::mechanism::plane::{cross, dot};
use crate::mechanism::{GuideForces, LoadValue, LooseRates, LooseState};
use crate::numeric::angle::Angle;
use crate::scene::{Instant, Joint};

impl LooseMechanism {
    /// Returns the action of the loose joint at an approach speed (m/s) of the impact and a depth (m), by default that
    /// of the state, with the normal force, N, and the power lost, W.
    #[inline(always)]
    pub(super) fn contact(
        &self,
        s: &LooseState,
        f: &Frame,
        approach: f64,
        depth: Option<f64>,
    ) -> (Action, f64, f64) {
        let distance = dot(f.offset, f.offset).sqrt();
        let depth = depth.unwrap_or(distance - self.clearance.radial);
        if depth <= 0.0 {
            return (Action::default(), 0.0, 0.0);
        }
        let per_distance = 1.0 / distance;
        let n = [f.offset[0] * per_distance, f.offset[1] * per_distance];
        let closing = dot(f.offset, f.rate) * per_distance;
        let elastic = self.force.elastic(depth);
        let normal = elastic * self.force.factor(closing, approach).max(0.0);
        let mut action = Action {
            force: [normal * n[0], normal * n[1]],
            ..Action::default()
        };
        let mut lost = (normal - elastic) * closing;
        if self.friction != 0.0 {
            // Both surfaces at one point of contact: action equals reaction.
            let arm = self.bearing - distance;
            let turning = match self.clearance.joint {
                Joint::CrankPin => s.omega,
                Joint::WristPin => 0.0,
            };
            let sliding =
                n[0] * f.rate[1] - n[1] * f.rate[0] + arm * turning - self.bearing * s.spin;
            let share = (sliding / self.clearance.friction_threshold).clamp(-1.0, 1.0);
            let drag = self.friction * normal * share;
            action.force[0] -= drag * n[1];
            action.force[1] += drag * n[0];
            action.on_rod = self.bearing * drag;
            action.on_journal = -arm * drag;
            lost += drag * sliding;
        }
        (action, normal, lost)
    }

    /// Solves for the link's force N, which keeps ε·ε̈ + ε̇² at zero: linear in the accelerations, and these in N.
    #[inline(never)]
    pub(super) fn linked(&self, load: &LoadValue, s: &LooseState, f: &Frame) -> LooseRates {
        let distance = dot(f.offset, f.offset).sqrt();
        let n = [f.offset[0] / distance, f.offset[1] / distance];
        let at = |normal: f64| {
            let action = Action {
                force: [normal * n[0], normal * n[1]],
                ..Action::default()
            };
            let rates = self.under(load, s, f, action, Rubbing::Never);
            let bend = dot(f.offset, self.second(f, s, &rates)) + dot(f.rate, f.rate);
            (rates, bend)
        };
        // Trial force of a typical size, N.
        let unit = self.slider_mass + self.rod_mass;
        let (free, pressed) = (at(0.0).1, at(unit).1);
        let normal = unit * free / (free - pressed);
        let (mut rates, _) = at(normal);
        rates.normal = normal;
        rates
    }

    /// Computes the accelerations under a load, an action in the loose joint, and friction at the guide.
    #[inline(always)]
    pub(super) fn under(
        &self,
        load: &LoadValue,
        s: &LooseState,
        f: &Frame,
        action: Action,
        rubbing: Rubbing,
    ) -> LooseRates {
        // Moment on the crank beside the torque of the loads, N m.
        let (mut rates, on_crank) = match self.clearance.joint {
            Joint::CrankPin => self.loose_at_crank(s, f, &action, load, rubbing),
            Joint::WristPin => self.loose_at_slider(s, f, &action, load, rubbing),
        };
        rates.on_rod = action.force;
        rates.power = load.force * s.v;
        if self.driven {
            rates.driving_torque = -on_crank - load.torque;
            rates.power -= on_crank * s.omega;
        } else {
            rates.power += load.torque * s.omega;
        }
        rates.lost = -rates.guide.friction * s.v;
        rates
    }

    #[inline(always)]
    pub(super) fn load(&self, s: &LooseState) -> LoadValue {
        let loads = self.loads.as_ref();
        loads.map_or_else(LoadValue::default, |loads| loads.at(&self.instant(s)))
    }

    /// Returns the variables of the loads at a state.
    #[inline(always)]
    pub fn instant(&self, s: &LooseState) -> Instant {
        Instant {
            t: s.t,
            theta: Angle::new(self.turns, s.theta).radians(),
            omega: s.omega,
            x: s.x,
            v: s.v,
        }
    }

    /// Returns the moment of gravity on the crank, N m.
    #[inline(always)]
    fn weight_on_crank(&self, f: &Frame) -> f64 {
        self.crank_weight[0] * f.crank_pin[0] - self.crank_weight[1] * f.crank_pin[1]
    }

    /// Solves for a loose crank pin: crank alone; slider and rod along x, and moments of the rod about the wrist pin.
    #[inline(always)]
    fn loose_at_crank(
        &self,
        s: &LooseState,
        f: &Frame,
        action: &Action,
        load: &LoadValue,
        rubbing: Rubbing,
    ) -> (LooseRates, f64) {
        let mut rates = LooseRates::default();
        let [gx, gy] = self.gravity;
        let (m, k, spin) = (self.rod_mass, f.centre, s.spin * s.spin);
        let on_crank =
            self.weight_on_crank(f) - cross(f.crank_pin, action.force) + action.on_journal;
        if !self.driven {
            rates.alpha = (load.torque + on_crank) / self.crank_inertia;
        }
        let mass = m + self.slider_mass;
        let along = load.force + mass * gx + action.force[0] + m * spin * k[0];
        let moment =
            m * cross(k, self.gravity) - self.l * cross(f.axis, action.force) + action.on_rod;
        let coupling = -m * k[1];
        let determinant = mass * self.rod_inertia - coupling * coupling;
        let moved = |along: f64| {
            [
                (self.rod_inertia * along - coupling * moment) / determinant,
                (mass * moment - coupling * along) / determinant,
            ]
        };
        let normal =
            |spin_rate: f64| m * (k[0] * spin_rate - k[1] * spin) - mass * gy - action.force[1];
        [rates.a, rates.spin_rate] = match rubbing {
            Rubbing::Never => moved(along),
            Rubbing::Slides(direction) => {
                let free = normal(moved(along)[1]);
                rates.guide = self.sliding(direction, free, self.guide_gain(f));
                moved(along + rates.guide.friction)
            }
            Rubbing::Sticks => {
                let spin_rate = moment / self.rod_inertia;
                rates.guide = GuideForces {
                    normal: normal(spin_rate),
                    friction: coupling * spin_rate - along,
                };
                [0.0, spin_rate]
            }
        };
        (rates, on_crank)
    }

    /// Solves for a loose wrist pin: slider alone; moments about O with the rod's mass, and those about the crank pin.
    #[inline(always)]
    fn loose_at_slider(
        &self,
        s: &LooseState,
        f: &Frame,
        action: &Action,
        load: &LoadValue,
        rubbing: Rubbing,
    ) -> (LooseRates, f64) {
        let mut rates = LooseRates::default();
        let [gx, gy] = self.gravity;
        let (m, k, a) = (self.rod_mass, f.centre, f.crank_pin);
        let (turn, spin) = (s.omega * s.omega, s.spin * s.spin);
        let along = load.force - action.force[0];
        let normal = action.force[1] - self.slider_mass * gy;
        rates.a = match rubbing {
            Rubbing::Never => along * self.per_slider_mass + gx,
            Rubbing::Slides(direction) => {
                rates.guide = self.sliding(direction, normal, 0.0);
                (along + rates.guide.friction) * self.per_slider_mass + gx
            }
            Rubbing::Sticks => {
                let friction = -(along + self.slider_mass * gx);
                rates.guide = GuideForces { normal, friction };
                0.0
            }
        };
        let together = m * dot(a, k);
        let apart = m * cross(a, k);
        let moment =
            m * cross(k, self.gravity) + self.l * cross(f.axis, action.force) + action.on_rod
                - turn * apart;
        let pushed = self.weight_on_crank(f) + m * (a[0] * gy - a[1] * gx) + cross(a, action.force);
        if self.driven {
            rates.spin_rate = moment * self.per_rod_inertia;
        } else {
            let crank = self.crank_inertia + m * self.r * self.r;
            let torque = load.torque + pushed + spin * apart;
            let determinant = crank * self.rod_inertia - together * together;
            rates.alpha = (self.rod_inertia * torque - together * moment) / determinant;
            rates.spin_rate = (crank * moment - together * torque) / determinant;
        }
        let on_crank = pushed + spin * apart - together * rates.spin_rate;
        (rates, on_crank)
    }

    /// Returns the change of the guide's normal force, N, per newton on the slider along the guide.
    pub(super) fn guide_gain(&self, f: &Frame) -> f64 {
        let (m, [along, across]) = (self.rod_mass, f.centre);
        let mass = m + self.slider_mass;
        match self.clearance.joint {
            Joint::CrankPin => {
                m * along * m * across / (mass * self.rod_inertia - (m * across).powi(2))
            }
            Joint::WristPin => 0.0,
        }
    }
}
