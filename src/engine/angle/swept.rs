//! The motion on a panel.

use super::forces::Forces;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Series, Values};

/// Force without a potential on a panel, or on its first part.
#[derive(Clone, Copy)]
pub(super) struct Spent {
    /// N m, at the points of the whole panel.
    pub values: Values,
    /// The part of the panel.
    share: f64,
}

impl Spent {
    /// Work from the start of a part of this length (rad, with sign) until a place in it, −1 to 1; J.
    pub fn work(&self, rule: &Rule, span: f64, x: f64) -> f64 {
        let half = 0.5 * span / self.share;
        if x * self.share == 1.0 {
            return half * rule.rounded_integral(&self.values);
        }
        let work = rule.series(&self.values).integral();
        half * work.value(self.share * (1.0 + x) - 1.0)
    }
}

/// The motion on a panel.
#[derive(Clone)]
pub(super) struct Swept {
    /// J, at the points.
    pub kinetic: Values,
    /// |dt/dx| at the points.
    pub slopes: Values,
    /// Series of the derivative.
    pub slope: Series,
    pub(super) forces: Forces,
    /// Kinetic energy that is gained, J.
    pub gain: f64,
    /// Kinetic energy at the end, J.
    pub end: f64,
    /// The part of the panel at which it ends.
    pub share: f64,
    /// Evaluations of the loads.
    pub evaluations: u64,
}

impl Swept {
    /// Room for the motion on a panel.
    pub fn new() -> Swept {
        let zero = [0.0; MAX_DEGREE + 1];
        Swept {
            kinetic: zero,
            slopes: zero,
            slope: Series::new(0, zero),
            forces: Forces::new(),
            gain: 0.0,
            end: 0.0,
            share: 1.0,
            evaluations: 0,
        }
    }

    /// Force without a potential.
    pub fn spent(&self) -> Spent {
        Spent {
            values: self.forces.spent,
            share: self.share,
        }
    }

    /// The integral of dt/2K over the panel, s/J, and the larger kinetic energy of its ends, J.
    pub fn early(&self, rule: &Rule) -> (f64, f64) {
        let early: Values = std::array::from_fn(|j| 0.5 * self.slopes[j] / self.kinetic[j]);
        let most = self.kinetic[0].max(self.kinetic[rule.degree()]);
        (rule.rounded_integral(&early), most)
    }
}
