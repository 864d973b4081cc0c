//! Mechanism with a loose joint as the contact engine sees it: state vector, rates, gap and scales.

use super::super::row::{LooseRow, Row};
use super::super::run_setup::RunSetup;
use crate::engine::contact::{Contact, Phase, Sample};
use crate::engine::time::MotionState;
use crate::mechanism::{
    JointTouch, LooseMechanism, LooseRates, LooseState, Rubbing, SpeedSizes, Turned,
};
use crate::numeric::enclosure::{Interval, Variation};

/// Length of the state of a free crank: t, θ, ψ, x, rates of θ, ψ, x, work of the loads, loss in contact and guide.
pub(super) const FREE: usize = 9;
/// Length of the state at prescribed speed: without θ and its rate; the work includes that of the drive.
pub(super) const DRIVEN: usize = 7;

/// Run of a mechanism, with scales for the error control; its state has N numbers.
pub(super) struct Loose<'a, const N: usize> {
    pub mechanism: &'a LooseMechanism,
    pub task: &'a RunSetup<'a>,
    pub start: LooseState,
    /// Scale of the positions, m.
    pub length: f64,
    /// Scale of the angles, rad.
    pub angle: f64,
    /// Ratio of the scales of speeds and positions, 1/s.
    pub pace: f64,
    /// Size of the mechanism, m.
    pub reach: f64,
    /// Last time of the run, s.
    pub t_end: f64,
}

impl<const N: usize> Loose<'_, N> {
    /// Unpacks a state vector.
    #[inline(always)]
    pub fn state(&self, y: &[f64; N]) -> LooseState {
        if N == DRIVEN {
            let LooseState { theta, omega, .. } = self.start;
            LooseState {
                t: y[0],
                theta: theta + omega * y[0],
                psi: y[1],
                x: y[2],
                omega,
                spin: y[3],
                v: y[4],
            }
        } else {
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
    }

    /// Packs a state with work and loss, J.
    pub fn numbers(&self, s: &LooseState, [work, lost]: [f64; 2]) -> [f64; N] {
        let free = [s.t, s.theta, s.psi, s.x, s.omega, s.spin, s.v, work, lost];
        Self::packed(&free)
    }

    /// Returns the work of loads and drive, and the energy lost in the contact and by friction at the guide, J.
    pub fn work(&self, y: &[f64; N]) -> [f64; 2] {
        [y[N - 2], y[N - 1]]
    }

    /// Returns the state of the crank.
    pub fn crank(&self, s: &LooseState) -> MotionState {
        MotionState {
            t: s.t,
            angle: self.task.angle(s.theta),
            speed: s.omega,
        }
    }

    /// Makes the row of slider and rod, with the slider of ideal joints for comparison.
    pub fn row(&self, s: &LooseState, phase: Phase) -> Row {
        let mechanism = self.mechanism;
        let linked = matches!(phase, Phase::Link).then(|| mechanism.relinked(s));
        let s = linked.as_ref().unwrap_or(s);
        let rates = mechanism.rates(s, touch(phase, None));
        let maker = &self.task.maker;
        let ideal = maker.row(s.t, self.task.angle(s.theta), s.omega, Some(rates.alpha));
        Row {
            x: s.x,
            v: s.v,
            a: rates.a,
            phi: phi(s.psi, self.task.scene.geometry.branch.sign()),
            reactions: maker
                .reactor
                .as_ref()
                .map(|reactor| reactor.loose(mechanism.clearance.joint, s, &rates)),
            driving_torque: maker.driving_torque.then_some(rates.driving_torque),
            clearance: Some(LooseRow {
                ideal: [ideal.x, ideal.v, ideal.a],
                journal: mechanism.journal(s),
                force: rates.normal,
            }),
            ..ideal
        }
    }

    #[inline(always)]
    fn packed(free: &[f64; FREE]) -> [f64; N] {
        const KEPT: [usize; DRIVEN] = [0, 2, 3, 5, 6, 7, 8];
        let mut packed = [0.0; N];
        for (i, each) in packed.iter_mut().enumerate() {
            *each = free[if N == DRIVEN { KEPT[i] } else { i }];
        }
        packed
    }
}

/// Returns the inclination φ of the rod from its direction ψ, rad.
pub(super) fn phi(psi: f64, branch: f64) -> f64 {
    let (sin, cos) = psi.sin_cos();
    (-sin).atan2(branch * cos)
}

/// Returns the action of a phase on the bodies.
#[inline(always)]
pub(super) fn touch(phase: Phase, depth: Option<f64>) -> JointTouch {
    match phase {
        Phase::Flight | Phase::Release { .. } => JointTouch::Apart,
        Phase::Contact { approach } => JointTouch::Pressed { approach, depth },
        Phase::Link => JointTouch::Linked,
    }
}

/// Directions of the links and friction of the slider at a nearby state.
#[derive(Clone, Copy)]
pub(super) struct Near {
    turned: Turned,
    rubbing: Rubbing,
}

impl<const N: usize> Contact<N> for Loose<'_, N> {
    type Near = Near;

    fn near(&self, y: &[f64; N]) -> Near {
        let s = self.state(y);
        Near {
            turned: Turned::new(s.theta, s.psi),
            rubbing: self.mechanism.rubbing(&s, JointTouch::Apart),
        }
    }

    fn near_after(&self, before: &Near, y: &[f64; N]) -> Near {
        let s = self.state(y);
        Near {
            turned: Turned::new(s.theta, s.psi),
            ..*before
        }
    }

    fn breaks(&self, near: &Near, phase: Phase, y: &[f64; N]) -> Option<[f64; 2]> {
        let speed = self.reach * self.pace;
        self.mechanism.rubs().then(|| {
            let (s, touch) = (self.state(y), touch(phase, None));
            self.mechanism.rubs_on(&s, touch, near.rubbing, speed)
        })
    }

    fn change(&self, near: &Near, phase: Phase, y: &mut [f64; N], soon: &[f64; N]) -> Near {
        let touch = touch(phase, None);
        let rubbing = match near.rubbing {
            Rubbing::Sticks => self.mechanism.let_go(&self.state(soon), touch),
            _ => {
                // The remaining velocity is rounding.
                let s = LooseState {
                    v: 0.0,
                    ..self.state(y)
                };
                *y = self.numbers(&s, self.work(y));
                self.mechanism.rubbing(&s, touch)
            }
        };
        Near { rubbing, ..*near }
    }

    #[inline(always)]
    fn sample(&self, near: &Near, phase: Phase, depth: Option<f64>, y: &[f64; N]) -> Sample<N> {
        let s = self.state(y);
        let touch = touch(phase, depth);
        let (r, d) = self
            .mechanism
            .rates_near(&near.turned, &s, touch, near.rubbing);
        Sample {
            rates: Self::packed(&[
                1.0,
                s.omega,
                s.spin,
                s.v,
                r.alpha,
                r.spin_rate,
                r.a,
                r.power,
                r.lost,
            ]),
            depth: d.value,
            depth_rate: d.rate,
            depth_acceleration: d.acceleration,
        }
    }

    fn gap(&self, near: &Near, y: &[f64; N], rates: &[f64; N]) -> [f64; 3] {
        // The accelerations stand where the state has the speeds.
        let LooseState { omega, spin, v, .. } = self.state(rates);
        let rates = LooseRates {
            alpha: if N == DRIVEN { 0.0 } else { omega },
            spin_rate: spin,
            a: v,
            ..LooseRates::default()
        };
        self.mechanism.gap(&near.turned, &self.state(y), &rates)
    }

    fn pressing(&self, approach: f64, rate: f64) -> f64 {
        self.mechanism.force.factor(rate, approach)
    }

    /// A crank angle rounds by more as it grows, and with it the crank pin.
    fn rounding(&self, y: &[f64; N]) -> f64 {
        let crank = self.length / self.angle;
        f64::EPSILON * (8.0 * self.reach + 2.0 * crank * self.state(y).theta.abs())
    }

    fn receded(&self, start: &[f64; N], end: &[f64; N]) -> [f64; N] {
        let stored = |y: &[f64; N]| self.mechanism.stored(&self.state(y));
        let mut receded = *end;
        receded[N - 1] += stored(start) - stored(end);
        receded
    }

    fn approach(&self, speed: f64) -> f64 {
        speed.max(self.mechanism.clearance.least_approach_speed)
    }

    fn relinked(&self, y: &[f64; N]) -> [f64; N] {
        self.numbers(&self.mechanism.relinked(&self.state(y)), self.work(y))
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.task.equation().loads().next_corner(t)
    }

    fn varies_between_nodes(&self) -> bool {
        self.mechanism.varies_between_nodes()
    }

    fn variation(&self, over: &[Interval; N], ellipse: f64) -> Variation {
        let low = self.state(&over.map(|of| of.low));
        let high = self.state(&over.map(|of| of.high));
        let sizes = SpeedSizes {
            turning: self.angle * self.pace,
            sliding: self.length * self.pace,
        };
        self.mechanism.variation([&low, &high], sizes, ellipse)
    }

    fn sizes(&self) -> ([f64; N], usize) {
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
        (Self::packed(&sizes), N - 2)
    }
}
