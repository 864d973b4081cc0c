//! What is measured on the mechanism instead of the crank angle, and the crank angles that give it.

use std::f64::consts::{PI, TAU};

use super::{Linkage, Pose};

/// Crank angles, rad, that have the same measured value; at most four.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InversePosition {
    list: [f64; 4],
    count: usize,
}

impl InversePosition {
    /// The angles.
    pub fn angles(&self) -> &[f64] {
        &self.list[..self.count]
    }

    fn push(&mut self, theta: f64) {
        if self.count < self.list.len() {
            self.list[self.count] = theta;
            self.count += 1;
        }
    }
}

impl Linkage {
    /// The angle at the crank pin from the crank to the rod (Duarte et al. (10): 180° − θ − φ on the right branch),
    /// rad, signed and not reduced to one turn, and its derivative. A protractor shows its size, between 0 and π.
    pub fn crank_pin_angle(&self, theta: f64, pose: &Pose) -> (f64, f64) {
        let start = if self.s > 0.0 { PI } else { 0.0 };
        (
            start - theta - self.s * pose.phi(),
            -1.0 - self.s * pose.dphi,
        )
    }

    /// How far an angle at the crank pin, rad, is from those that the mechanism can have.
    pub fn excess_of_gamma(&self, gamma: f64) -> f64 {
        let (r, l) = (self.r, self.l);
        let outside = (-gamma).max(gamma - PI).max(0.0);
        let [along, across] = self.pin(gamma);
        let reach = length(along, across);
        let short = (self.e.abs() - reach).max(0.0);
        if short > 1e-12 * (r + l) {
            let slope = r * across / reach.max(f64::MIN_POSITIVE);
            outside + short / slope.max(1e-3 * (r + l))
        } else {
            outside
        }
    }

    /// The way from P to O along the crank and across it, m, for an angle at the crank pin.
    fn pin(&self, gamma: f64) -> [f64; 2] {
        let (sin, cos) = gamma.clamp(0.0, PI).sin_cos();
        [self.r - self.l * cos, self.l * sin]
    }

    /// The crank angles, in [−π, π), at which the angle at the crank pin has this size; a size just outside what is
    /// possible is taken for the border.
    pub fn angles_of_gamma(&self, gamma: f64) -> InversePosition {
        let [along, across] = self.pin(gamma);
        let reach = length(along, across);
        let x = ((reach - self.e) * (reach + self.e)).max(0.0).sqrt();
        // The direction of P as seen from O, against the crank's.
        let mut found = InversePosition::default();
        for x in [x, -x] {
            self.keep(&mut found, [x, reach], [along, across, reach]);
        }
        found
    }

    /// How far a slider position, m, is from those that a crank and a rod of these lengths reach.
    pub fn excess_of_x(&self, x: f64) -> f64 {
        let (r, l) = (self.r, self.l);
        let reach = length(x, self.e);
        (reach - (r + l)).max((r - l).abs() - reach).max(0.0)
    }

    /// The crank angles, in [−π, π), at which the slider is at x, m; a position just outside what is possible is
    /// taken for the border.
    pub fn angles_of_x(&self, x: f64) -> InversePosition {
        let (r, l) = (self.r, self.l);
        let reach = length(x, self.e);
        // tan² of half the angle between OP and the crank (law of cosines, without cancellation).
        let above = ((l + r) - reach).max(0.0) * (reach + (l - r)).max(0.0);
        let below = (reach - (l - r)).max(0.0) * (reach + (l + r));
        let lean = [below - above, 2.0 * (above * below).sqrt(), below + above];
        let mut found = InversePosition::default();
        self.keep(&mut found, [x, reach], lean);
        found
    }

    /// Keeps the angles that belong to the branch and are not there yet: those of the direction from O to P, which is at
    /// [x, |OP|], m, less and plus the lean of the crank against it, given by a cosine, a sine and what both are parts
    /// of.
    fn keep(&self, found: &mut InversePosition, [x, reach]: [f64; 2], [cos, sin, whole]: [f64; 3]) {
        let both = reach * whole;
        let fits = |sine: f64| {
            // r times the cosine of the crank angle, by the theorem of addition.
            let crank = self.r * (x * cos - self.e * sine);
            self.s * (x * both - crank) >= -1e-9 * self.l * both
        };
        let fits = [fits(sin), fits(-sin)];
        if fits == [false; 2] {
            return;
        }
        let (to_pin, lean) = ((-self.e).atan2(x), sin.atan2(cos));
        for (fits, theta) in fits.into_iter().zip([to_pin - lean, to_pin + lean]) {
            let theta = in_one_turn(theta);
            if fits && !found.angles().contains(&theta) {
                found.push(theta);
            }
        }
    }
}

/// Length of a way with these two parts.
fn length(along: f64, across: f64) -> f64 {
    (along * along + across * across).sqrt()
}

/// Crank angle in [−π, π), of one between −2π and 2π.
fn in_one_turn(theta: f64) -> f64 {
    let theta = theta + PI;
    let turn = if theta < 0.0 {
        TAU
    } else if theta >= TAU {
        -TAU
    } else {
        0.0
    };
    theta + turn - PI
}
