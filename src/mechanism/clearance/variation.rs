//! Variation of the loads between two states of a mechanism with a loose joint.

use std::f64::consts::TAU;

use super::rubbing::Rubbing;
use super::{Action, LooseMechanism};
use crate::mechanism::{EnclosedState, LoadValue, Loads, LooseState, UnitLoadEffects};
use crate::numeric::enclosure::{Interval, Variation};
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
    pub fn varies_between_nodes(&self) -> bool {
        self.loads.as_ref().is_some_and(Loads::vary_between_nodes)
    }

    /// Returns the variation of the accelerations by the loads, each over the size of its speed (1/s), where all
    /// numbers of the state lie between those of two states, and in an ellipse of this size around that range.
    pub fn variation(
        &self,
        [low, high]: [&LooseState; 2],
        sizes: SpeedSizes,
        ellipse: f64,
    ) -> Variation {
        let Some(loads) = &self.loads else {
            return Variation::NONE;
        };
        let between = |of: fn(&LooseState) -> f64| Interval::between(of(low), of(high));
        let state = EnclosedState {
            t: between(|s| s.t),
            theta: between(|s| s.theta) + Interval::point(self.turns * TAU),
            omega: between(|s| s.omega),
            x: between(|s| s.x),
            v: between(|s| s.v),
            dx: Interval::WHOLE,
        };
        loads.variation(&state, self.unit_load_effects(low, sizes), ellipse)
    }

    /// Returns the largest change of an acceleration over the size of its speed per unit load, while the joint is open:
    /// torque and force then act on separate bodies, and the rod moves with one of them.
    fn unit_load_effects(&self, s: &LooseState, sizes: SpeedSizes) -> UnitLoadEffects {
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
        match self.clearance.joint {
            Joint::CrankPin => UnitLoadEffects {
                torque: crank,
                force: rod.max(slider),
            },
            Joint::WristPin => UnitLoadEffects {
                torque: crank.max(rod),
                force: slider,
            },
        }
    }
}
