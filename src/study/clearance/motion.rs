//! The mechanism with a loose joint as the integrator sees it.

use crate::engine::contact::{Contact, Phase, Sample};
use crate::mechanism::{LooseMechanism, LooseState, Touch, Turned};

/// Numbers of a state: t, θ, ψ, x, their rates, the work of loads and drive, and the energy lost in the contact.
pub(super) const SIZE: usize = 9;
/// Work of the loads and of the drive, J.
pub(super) const WORK: usize = 7;
/// Energy lost in the contact, J.
pub(super) const LOST: usize = 8;

/// A state, and its rates.
pub(super) type State = [f64; SIZE];

/// The mechanism with sizes for the error.
pub(super) struct Loose<'a> {
    pub mechanism: &'a LooseMechanism,
    /// m
    pub length: f64,
    /// 1/s
    pub pace: f64,
    /// Angle sizes, rad.
    pub angle: f64,
    /// Size of the mechanism, m.
    pub reach: f64,
    /// Whether a load has corners in time.
    pub corners: &'a dyn Fn(f64) -> f64,
}

pub(super) fn loose(y: &State) -> LooseState {
    LooseState {
        t: y[0],
        theta: y[1],
        psi: y[2],
        x: y[3],
        omega: y[4],
        spin: y[5],
        v: y[6],
    }
}

pub(super) fn state(s: &LooseState) -> State {
    [
        s.t, s.theta, s.psi, s.x, s.omega, s.spin, s.v, 0.0, 0.0,
    ]
}

/// How a phase acts on the bodies.
pub(super) fn touch(phase: Phase, depth: Option<f64>) -> Touch {
    match phase {
        Phase::Flight | Phase::Release { .. } => Touch::Apart,
        Phase::Contact { approach } => Touch::Pressed { approach, depth },
        Phase::Link => Touch::Linked,
    }
}

impl Contact<SIZE> for Loose<'_> {
    type Near = Turned;

    fn near(&self, y: &State) -> Turned {
        Turned::new(y[1], y[2])
    }

    #[inline]
    fn sample(
        &self,
        near: &Turned,
        phase: Phase,
        depth: Option<f64>,
        y: &State,
    ) -> Sample<SIZE> {
        let s = loose(y);
        let (r, d) = self.mechanism.rates_near(near, &s, touch(phase, depth));
        Sample {
            rates: [
                1.0, s.omega, s.spin, s.v, r.alpha, r.spin_rate, r.a, r.power, r.lost,
            ],
            depth: d.value,
            depth_rate: d.rate,
            depth_acceleration: d.acceleration,
        }
    }

    fn gap(&self, y: &State) -> (f64, f64) {
        self.mechanism.gap(&loose(y))
    }

    fn pressing(&self, approach: f64, rate: f64) -> f64 {
        self.mechanism.pressing(rate, approach)
    }

    fn rounding(&self) -> f64 {
        8.0 * f64::EPSILON * self.reach
    }

    fn approach(&self, speed: f64) -> f64 {
        self.mechanism.approach(speed)
    }

    fn relinked(&self, y: &State) -> State {
        let mut linked = state(&self.mechanism.relinked(&loose(y)));
        (linked[WORK], linked[LOST]) = (y[WORK], y[LOST]);
        linked
    }

    fn next_corner(&self, t: f64) -> f64 {
        (self.corners)(t)
    }

    fn sizes(&self) -> (State, usize) {
        let (angle, length, pace) = (self.angle, self.length, self.pace);
        let sizes = [
            1.0 / pace,
            angle,
            angle,
            length,
            angle * pace,
            angle * pace,
            length * pace,
            1.0,
            1.0,
        ];
        (sizes, WORK)
    }
}
