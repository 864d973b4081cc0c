//! Inverse position: crank angles from a slider position or an angle at the crank pin, by the law of cosines.

use std::f64::consts::{PI, TAU};

use super::{Linkage, Pose};

/// Crank angles, rad, with the same measured value; at most four.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InversePosition {
    list: [f64; 4],
    count: usize,
}

impl InversePosition {
    /// Returns the angles, rad.
    pub fn angles(&self) -> &[f64] {
        &self.list[..self.count]
    }
}

impl Linkage {
    /// Returns the angle at the crank pin from crank to rod (Duarte et al. (10): 180° − θ − φ on the right branch),
    /// rad, signed and not reduced to one turn, and its derivative. A protractor shows its size, between 0 and π.
    pub fn crank_pin_angle(&self, theta: f64, pose: &Pose) -> (f64, f64) {
        let start = if self.s > 0.0 { PI } else { 0.0 };
        (
            start - theta - self.s * pose.phi(),
            -1.0 - self.s * pose.dphi,
        )
    }

    /// Returns the distance, rad, of an angle at the crank pin from the possible range, to first order; zero inside.
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

    /// Returns the vector from O to P along the crank and across it, m, for an angle at the crank pin.
    fn pin(&self, gamma: f64) -> [f64; 2] {
        let (sin, cos) = gamma.clamp(0.0, PI).sin_cos();
        [self.r - self.l * cos, self.l * sin]
    }

    /// Returns the crank angles in [−π, π) with a crank-pin angle of this size; one just outside the range is its end.
    pub fn angles_of_gamma(&self, gamma: f64) -> InversePosition {
        let [along, across] = self.pin(gamma);
        let reach = length(along, across);
        let x = ((reach - self.e) * (reach + self.e)).max(0.0).sqrt();
        // Direction of P as seen from O, relative to the crank.
        let mut found = InversePosition::default();
        for x in [x, -x] {
            self.keep(&mut found, [x, reach], [along, across, reach]);
        }
        found
    }

    /// Returns the distance, m, of |OP| at a slider position (m) from the range |l − r| to l + r; zero inside.
    pub fn excess_of_x(&self, x: f64) -> f64 {
        let (r, l) = (self.r, self.l);
        let reach = length(x, self.e);
        (reach - (r + l)).max((r - l).abs() - reach).max(0.0)
    }

    /// Solves for the crank angles, in [−π, π), with the slider at x, m; a position just outside the range is its end.
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

    /// Adds the new crank angles of this branch: the direction of OP, with P at [x, |OP|], m, minus and plus the angle
    /// between crank and OP, given by a cosine and a sine over a common denominator.
    fn keep(&self, found: &mut InversePosition, [x, reach]: [f64; 2], [cos, sin, whole]: [f64; 3]) {
        let both = reach * whole;
        let fits = |sine: f64| {
            // r cos θ times `both`, by the addition theorem.
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
                found.list[found.count] = theta;
                found.count += 1;
            }
        }
    }
}

/// Returns the length of a vector.
fn length(along: f64, across: f64) -> f64 {
    (along * along + across * across).sqrt()
}

/// Reduces a crank angle between −2π and 2π to [−π, π).
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
