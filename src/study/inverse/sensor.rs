//! What the instrument shows at a crank angle, for fits in terms of what was measured.

use std::f64::consts::TAU;

use crate::mechanism::Linkage;
use crate::scene::Measured;

/// A measured quantity of a mechanism.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sensor<'a> {
    pub linkage: &'a Linkage,
    pub measured: Measured,
}

impl Sensor<'_> {
    /// Whether values have lost their signs.
    pub fn folds(&self) -> bool {
        self.measured == Measured::Gamma
    }

    /// What the instrument shows at a crank angle θ (rad), and its derivative; a crank-pin angle with its sign, continued over
    /// the turns.
    pub fn shown(&self, theta: f64) -> (f64, f64) {
        match self.measured {
            Measured::Theta => (theta, 1.0),
            Measured::X => {
                let pose = self.linkage.pose(theta);
                (pose.x, pose.dx)
            }
            Measured::Gamma => {
                let pose = self.linkage.pose(theta);
                self.linkage.crank_pin_angle(theta, &pose)
            }
        }
    }

    /// A size of what is measured: the crank length, m, or 1 rad.
    pub fn size(&self) -> f64 {
        match self.measured {
            Measured::X => self.linkage.r,
            _ => 1.0,
        }
    }

    /// What is measured minus what the crank angle θ (rad) gives, and the derivative of the latter.
    ///
    /// A crank-pin angle is measured without sign: the sign and turn next to those of the crank angle are taken.
    pub fn residual(&self, value: f64, theta: f64) -> (f64, f64) {
        let (shown, slope) = self.shown(theta);
        (self.unfolded(value, || shown) - shown, slope)
    }

    /// The crank angle between two others, rad, at which a value is shown: that of the middle of what is shown at these.
    pub fn between(&self, value: f64, [from, to]: [f64; 2]) -> Option<f64> {
        let middle = 0.5 * (from + to);
        let candidates = match self.measured {
            Measured::Theta => return Some(middle),
            Measured::X => self.linkage.angles_of_x(value),
            Measured::Gamma => self.linkage.angles_of_gamma(value),
        };
        let in_turn = |angle: &f64| angle + ((middle - angle) / TAU).round() * TAU;
        let angles = candidates.angles().iter().map(in_turn);
        let off = |angle: &f64| (angle - middle).abs();
        let nearest = angles.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        (off(&nearest) <= 0.5 * (to - from).abs()).then_some(nearest)
    }

    /// A value with the sign and turn next to what the instrument shows: values of a smooth motion are smooth then.
    pub fn unfolded(&self, value: f64, shown: impl FnOnce() -> f64) -> f64 {
        if !self.folds() {
            return value;
        }
        let shown = shown();
        let [plus, minus] = rests(value, shown);
        let signed = if plus.abs() <= minus.abs() {
            value
        } else {
            -value
        };
        signed + ((shown - signed) / TAU).round() * TAU
    }

    /// Whether a value counts with its sign turned round, as −1, or as it is, as 1.
    pub fn sign(&self, value: f64, theta: impl FnOnce() -> f64) -> f64 {
        if !self.folds() {
            return 1.0;
        }
        let [plus, minus] = rests(value, self.shown(theta()).0);
        if plus.abs() <= minus.abs() { 1.0 } else { -1.0 }
    }
}

/// What a crank-pin angle with either sign has beyond that of a crank angle.
fn rests(value: f64, signed: f64) -> [f64; 2] {
    [value, -value].map(|value| {
        let off = value - signed;
        off - (off / TAU).round() * TAU
    })
}
