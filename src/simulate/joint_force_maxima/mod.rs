//! Largest joint forces of a run.
//!
//! The dense motion is looked at in rows that are close enough to show what geometry, loads and motion make, then by
//! Brent's method beside those at which a force may be largest.

mod search;
mod way;

use serde::Serialize;

use crate::mechanism::Reactions;
pub(super) use search::{MOST_ROWS, refined, search};

/// Number of forces that are looked at.
pub(super) const FORCES: usize = 5;

/// The largest size of a force in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peak {
    /// N
    pub value_n: f64,
    /// When, s.
    pub t_s: f64,
    /// Where the crank is then, rad, unwrapped.
    pub theta_rad: f64,
    /// What the last refinement added, N. The error of the motion itself comes on top.
    pub added_n: f64,
}

/// The largest sizes of the joint forces in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peaks {
    /// Of the crank's bearing at O.
    pub crank_bearing: Peak,
    /// Between crank and rod.
    pub crank_pin: Peak,
    /// Between rod and slider.
    pub wrist_pin: Peak,
    /// Of the guide, normal to it.
    pub guide: Peak,
    /// Minus the rate of change of the momentum of the mechanism.
    pub shaking: Peak,
}

impl Peaks {
    pub(super) fn new(
        [crank_bearing, crank_pin, wrist_pin, guide, shaking]: [Peak; FORCES],
    ) -> Peaks {
        Peaks {
            crank_bearing,
            crank_pin,
            wrist_pin,
            guide,
            shaking,
        }
    }

    /// All of them, with their names.
    pub fn named(&self) -> [(&'static str, Peak); FORCES] {
        [
            ("crank bearing", self.crank_bearing),
            ("crank pin", self.crank_pin),
            ("wrist pin", self.wrist_pin),
            ("guide", self.guide),
            ("shaking force", self.shaking),
        ]
    }
}

/// Sizes of the forces, N, in the order of [`Peaks`].
pub(super) fn sizes(forces: &Reactions) -> [f64; FORCES] {
    let size = |[x, y]: [f64; 2]| (x * x + y * y).sqrt();
    [
        size(forces.crank_bearing),
        size(forces.crank_pin),
        size(forces.wrist_pin),
        forces.guide.abs(),
        size(forces.shaking),
    ]
}
