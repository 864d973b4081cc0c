//! Coulomb friction of the slider in its guide while a joint is loose.

use super::{JointTouch, LooseMechanism};
use crate::mechanism::{GuideForces, LooseState};
use crate::numeric::exact::SUM_ROUNDING;

/// Friction state of the slider in its guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rubbing {
    /// The guide has no friction.
    #[default]
    Never,
    /// The slider slides, towards +x (+1) or −x (−1).
    Slides(f64),
    /// The slider sticks.
    Sticks,
}

impl LooseMechanism {
    /// Whether the guide has friction.
    pub fn rubs(&self) -> bool {
        self.guide.is_some()
    }

    /// Returns the friction state of the slider: by its velocity, and at rest by the forces.
    pub fn rubbing(&self, s: &LooseState, touch: JointTouch) -> Rubbing {
        if !self.rubs() {
            Rubbing::Never
        } else if s.v != 0.0 {
            Rubbing::Slides(s.v.signum())
        } else if self.hold(s, touch) >= 0.0 {
            Rubbing::Sticks
        } else {
            self.let_go(s, touch)
        }
    }

    /// Returns the friction state of a slider that sticks no longer.
    pub fn let_go(&self, s: &LooseState, touch: JointTouch) -> Rubbing {
        Rubbing::Slides(-self.held(s, touch).friction.signum())
    }

    /// Returns the margin of static friction at rest, N, with an allowance for rounding.
    fn hold(&self, s: &LooseState, touch: JointTouch) -> f64 {
        let forces = self.held(s, touch);
        let most = self.guide.map_or(0.0, |guide| guide.static_coefficient) * forces.normal.abs();
        most * (1.0 + SUM_ROUNDING) - forces.friction.abs() * (1.0 - SUM_ROUNDING)
    }

    fn held(&self, s: &LooseState, touch: JointTouch) -> GuideForces {
        self.rates_in(s, &self.frame(s), touch, Rubbing::Sticks)
            .guide
    }

    /// Returns two event functions: the first is positive while the friction state lasts; the accelerations have a kink
    /// where the second changes its sign. `speed` is the size of the speeds, m/s.
    pub fn rubs_on(
        &self,
        s: &LooseState,
        touch: JointTouch,
        rubbing: Rubbing,
        speed: f64,
    ) -> [f64; 2] {
        match rubbing {
            Rubbing::Never => [1.0; 2],
            Rubbing::Sticks => [self.hold(s, touch), 1.0],
            Rubbing::Slides(direction) => {
                let rates = self.rates_in(s, &self.frame(s), touch, rubbing);
                [direction * s.v + SUM_ROUNDING * speed, rates.guide.normal]
            }
        }
    }

    /// Returns the guide's forces on a slider that slides; NaN where rigid bodies jam.
    pub(super) fn sliding(&self, direction: f64, free: f64, kappa: f64) -> GuideForces {
        let mu = self.guide.map_or(0.0, |guide| guide.coefficient);
        GuideForces::sliding(free, kappa, mu, direction).unwrap_or(GuideForces {
            normal: f64::NAN,
            friction: f64::NAN,
        })
    }

    /// Whether rigid bodies jam in a state.
    pub fn jams(&self, s: &LooseState) -> bool {
        self.sliding(1.0, 1.0, self.guide_gain(&self.frame(s)))
            .normal
            .is_nan()
    }
}
