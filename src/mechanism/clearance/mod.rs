//! Mechanism with one loose joint: crank angle θ, direction ψ of the rod and slider position x are independent, and a
//! contact force acts between the pin (journal) and the end of the rod (bearing).
//!
//! The rod stays pinned at its other end: to the slider with the clearance at the crank pin, to the crank with the
//! clearance at the wrist pin. Equations by Newton and Euler, about the pinned end.

mod energy;
mod forces;
mod law;
mod rubbing;
mod start;
mod turn;
mod variation;

pub use law::NormalForce;
pub use rubbing::Rubbing;
pub use turn::Turned;
pub use variation::SpeedSizes;

use super::plane::dot;
use super::{Loads, LooseRates, LooseState};
use crate::scene::{Clearance, ContactLaw, Friction};

/// Depth of the contact with its time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Depth {
    /// Penetration δ, m, negative while apart.
    pub value: f64,
    /// δ̇, m/s
    pub rate: f64,
    /// δ̈, m/s²
    pub acceleration: f64,
}

/// Contact of journal and bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointTouch {
    /// No contact.
    Apart,
    /// Contact by the contact law. The penetration may be known more accurately than from the position.
    Pressed {
        /// Speed at which the contact began, m/s.
        approach: f64,
        /// Penetration, m; none: that of the position.
        depth: Option<f64>,
    },
    /// Journal and bearing are the two ends of a massless link.
    Linked,
}

/// Mechanism with a loose joint: immutable, shared by all evaluations.
#[derive(Clone, Debug)]
pub struct LooseMechanism {
    /// +1 where the crank carries the journal, −1 where the slider does.
    side: f64,
    r: f64,
    l: f64,
    e: f64,
    driven: bool,
    crank_inertia: f64,
    /// Coefficients of the moment of gravity on the crank, N, over the components of its pin.
    crank_weight: [f64; 2],
    rod_mass: f64,
    /// Centre of gravity of the rod from the pinned end, along the rod and to its left, m.
    rod_centre: [f64; 2],
    /// Moment of inertia of the rod about the pinned end, kg m².
    rod_inertia: f64,
    per_rod_inertia: f64,
    slider_mass: f64,
    per_slider_mass: f64,
    gravity: [f64; 2],
    loads: Option<Loads>,
    turns: f64,
    /// Clearance of the scene.
    pub clearance: Clearance,
    bearing: f64,
    /// Law of the contact.
    pub force: NormalForce,
    friction: f64,
    guide: Option<Friction>,
}

/// Vectors of a state that several terms need, m and m/s.
struct Frame {
    crank_pin: [f64; 2],
    axis: [f64; 2],
    centre: [f64; 2],
    /// Vector from the bearing's centre to the journal's, and its rate.
    offset: [f64; 2],
    rate: [f64; 2],
}

/// Force on the rod at its loose end, N, and couples on rod and journal, N m.
#[derive(Clone, Copy, Default)]
struct Action {
    force: [f64; 2],
    on_rod: f64,
    on_journal: f64,
}

impl LooseMechanism {
    fn frame(&self, s: &LooseState) -> Frame {
        self.frame_from(s, s.theta.sin_cos(), s.psi.sin_cos())
    }

    #[inline(always)]
    fn frame_from(&self, s: &LooseState, crank: (f64, f64), rod: (f64, f64)) -> Frame {
        let ((sin, cos), (dy, dx)) = (crank, rod);
        let a = [self.r * cos, self.r * sin];
        let [along, lateral] = self.rod_centre;
        let side = self.side;
        Frame {
            crank_pin: a,
            axis: [dx, dy],
            centre: [along * dx - lateral * dy, along * dy + lateral * dx],
            offset: [
                side * (a[0] - s.x + self.l * dx),
                side * (a[1] + self.e + self.l * dy),
            ],
            rate: [
                side * (-s.omega * a[1] - s.v - self.l * s.spin * dy),
                side * (s.omega * a[0] + self.l * s.spin * dx),
            ],
        }
    }

    /// Returns the centre of the journal from the centre of the bearing, m.
    pub fn journal(&self, s: &LooseState) -> [f64; 2] {
        self.frame(s).offset
    }

    /// Returns the penetration δ, m, negative while apart, and its rate, m/s.
    pub fn depth(&self, s: &LooseState) -> (f64, f64) {
        self.depth_in(&self.frame(s))
    }

    #[inline(always)]
    fn depth_in(&self, f: &Frame) -> (f64, f64) {
        let distance = dot(f.offset, f.offset).sqrt();
        let c = self.clearance.radial;
        (distance - c, dot(f.offset, f.rate) * (1.0 / distance))
    }

    /// Returns (c² − ε²)/2c, m: about the gap where it is small, and smooth everywhere; with its first two derivatives in
    /// time at given accelerations. `near`: directions of the links at a state nearby.
    pub fn gap(&self, near: &Turned, s: &LooseState, rates: &LooseRates) -> [f64; 3] {
        let f = self.frame_from(s, near.crank(s.theta), near.rod(s.psi));
        let c = self.clearance.radial;
        let distance = dot(f.offset, f.offset).sqrt();
        let bend = dot(f.rate, f.rate) + dot(f.offset, self.second(&f, s, rates));
        [
            (c - distance) * (c + distance) / (2.0 * c),
            -dot(f.offset, f.rate) / c,
            -bend / c,
        ]
    }

    /// Returns δ̈, m/s², for given accelerations.
    #[inline(always)]
    fn depth_acceleration(&self, f: &Frame, s: &LooseState, rates: &LooseRates) -> f64 {
        let distance = dot(f.offset, f.offset).sqrt();
        let closing = dot(f.offset, f.rate) / distance;
        let second = self.second(f, s, rates);
        (dot(f.offset, second) + dot(f.rate, f.rate) - closing * closing) / distance
    }

    /// Returns the second derivative of the offset, m/s².
    #[inline(always)]
    fn second(&self, f: &Frame, s: &LooseState, rates: &LooseRates) -> [f64; 2] {
        let (a, axis, l) = (f.crank_pin, f.axis, self.l);
        let (turn, spin) = (s.omega * s.omega, s.spin * s.spin);
        [
            self.side
                * (-rates.alpha * a[1]
                    - turn * a[0]
                    - rates.a
                    - l * (rates.spin_rate * axis[1] + spin * axis[0])),
            self.side
                * (rates.alpha * a[0] - turn * a[1]
                    + l * (rates.spin_rate * axis[0] - spin * axis[1])),
        ]
    }

    /// Whether the contact is a massless link.
    pub fn is_linked(&self) -> bool {
        self.clearance.law == ContactLaw::MasslessLink
    }

    /// Computes accelerations, powers and forces at a state.
    pub fn rates(&self, s: &LooseState, touch: JointTouch) -> LooseRates {
        self.rates_in(s, &self.frame(s), touch, self.rubbing(s, touch))
    }

    /// Computes [`Self::rates`] and the depth, with sines and cosines from a state nearby and a given friction state.
    #[inline(always)]
    pub fn rates_near(
        &self,
        near: &Turned,
        s: &LooseState,
        touch: JointTouch,
        rubbing: Rubbing,
    ) -> (LooseRates, Depth) {
        let f = self.frame_from(s, near.crank(s.theta), near.rod(s.psi));
        let rates = self.rates_in(s, &f, touch, rubbing);
        let (value, rate) = self.depth_in(&f);
        let depth = Depth {
            value,
            rate,
            acceleration: self.depth_acceleration(&f, s, &rates),
        };
        (rates, depth)
    }

    #[inline(always)]
    fn rates_in(
        &self,
        s: &LooseState,
        f: &Frame,
        touch: JointTouch,
        rubbing: Rubbing,
    ) -> LooseRates {
        let load = self.load(s);
        match touch {
            JointTouch::Apart => self.under(&load, s, f, Action::default(), rubbing),
            JointTouch::Pressed { approach, depth } => {
                let (action, normal, lost) = self.contact(s, f, approach, depth);
                let mut rates = self.under(&load, s, f, action, rubbing);
                rates.normal = normal;
                rates.lost += lost;
                rates
            }
            JointTouch::Linked => self.linked(&load, s, f),
        }
    }
}
