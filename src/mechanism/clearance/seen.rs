//! Detail of the loads between two states of a mechanism with a loose joint.

use std::f64::consts::TAU;

use super::rubbing::Rubbing;
use super::{Action, LooseMechanism};
use crate::mechanism::{Arms, EnclosedState, LoadValue, LooseState};
use crate::numeric::enclosure::{Detail, Interval};
use crate::scene::Joint;

/// Sizes of the speeds, relative to which their changes are measured.
#[derive(Clone, Copy, Debug)]
pub struct SpeedSizes {
    /// Size of the speeds of crank and rod, rad/s.
    pub turning: f64,
    /// Size of the speed of the slider, m/s.
    pub sliding: f64,
}

impl LooseMechanism {
    /// Whether loads may vary between the stages of a step.
    pub fn has_detail(&self) -> bool {
        self.loads.as_ref().is_some_and(|loads| loads.have_detail())
    }

    /// Returns the detail of the accelerations by the loads, each over the size of its speed (1/s), where all numbers
    /// of the state lie between those of two states, and in an ellipse of this size around that range.
    pub fn detail(&self, [low, high]: [&LooseState; 2], sizes: SpeedSizes, ellipse: f64) -> Detail {
        let Some(loads) = &self.loads else {
            return Detail::NONE;
        };
        let between = |of: fn(&LooseState) -> f64| Interval::between(of(low), of(high));
        let seen = EnclosedState {
            t: between(|s| s.t),
            theta: between(|s| s.theta) + Interval::point(self.turns * TAU),
            omega: between(|s| s.omega),
            x: between(|s| s.x),
            v: between(|s| s.v),
            dx: Interval::WHOLE,
        };
        loads.detail(&seen, self.arms(low, sizes), ellipse)
    }

    /// Returns the largest change of an acceleration over the size of its speed per unit load, while the joint is open:
    /// torque and force then act on separate bodies, and the rod moves with one of them.
    fn arms(&self, s: &LooseState, sizes: SpeedSizes) -> Arms {
        let frame = self.frame(s);
        let rates = |size: f64| {
            let load = LoadValue {
                torque: size,
                force: size,
            };
            self.under(&load, s, &frame, Action::default(), Rubbing::Never)
        };
        let (without, with) = (rates(0.0), rates(1.0));
        let crank = (with.alpha - without.alpha).abs() / sizes.turning;
        let rod = (with.spin_rate - without.spin_rate).abs() / sizes.turning;
        let slider = (with.a - without.a).abs() / sizes.sliding;
        match self.joint {
            Joint::CrankPin => Arms {
                torque: crank,
                force: rod.max(slider),
            },
            Joint::WristPin => Arms {
                torque: crank.max(rod),
                force: slider,
            },
        }
    }
}
