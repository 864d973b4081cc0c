//! Coulomb friction of the slider in its guide while a joint is loose.

use super::{JointTouch, LooseMechanism};
use crate::mechanism::{GuideForces, LooseState};
use crate::numeric::exact::SUM_ROUNDING;

/// How the slider rubs in its guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rubbing {
    /// Not at all: the guide has no friction.
    #[default]
    Never,
    /// The slider slides, towards +x (+1) or −x (−1).
    Slides(f64),
    /// The slider is held fast.
    Sticks,
}

impl LooseMechanism {
    /// Whether the guide has friction.
    pub fn rubs(&self) -> bool {
        self.guide.is_some()
    }

    /// How the slider rubs in a state: as it moves, and at rest as the forces decide.
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

    /// What a slider does that is held no longer.
    pub fn let_go(&self, s: &LooseState, touch: JointTouch) -> Rubbing {
        Rubbing::Slides(-self.held(s, touch).friction.signum())
    }

    /// By how much the guide could hold the slider more than it has to, N, beyond rounding.
    fn hold(&self, s: &LooseState, touch: JointTouch) -> f64 {
        let forces = self.held(s, touch);
        let most = self.guide.map_or(0.0, |guide| guide.static_coefficient) * forces.normal.abs();
        most * (1.0 + SUM_ROUNDING) - forces.friction.abs() * (1.0 - SUM_ROUNDING)
    }

    fn held(&self, s: &LooseState, touch: JointTouch) -> GuideForces {
        self.rates_in(s, &self.frame(s), touch, Rubbing::Sticks)
            .guide
    }

    /// What is positive while the slider rubs in this way, and what leaves a kink in the accelerations where its
    /// sign changes. `speed` is the size of the speeds, m/s.
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

    /// The guide's forces on a slider that slides. Not numbers where rigid bodies jam.
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
