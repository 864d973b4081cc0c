//! What is measured on the mechanism instead of the crank angle, and the crank angles that give it.

use std::f64::consts::{PI, TAU};

use super::{Linkage, Pose};

/// Crank angles, rad, that have the same measured value; at most four.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Candidates {
    list: [f64; 4],
    count: usize,
}

impl Candidates {
    /// One crank angle.
    pub fn one(theta: f64) -> Candidates {
        Candidates {
            list: [theta, 0.0, 0.0, 0.0],
            count: 1,
        }
    }

    /// The angles.
    pub fn angles(&self) -> &[f64] {
        &self.list[..self.count]
    }

    /// These angles and others that are not among them.
    pub fn with(mut self, others: &Candidates) -> Candidates {
        for theta in others.angles() {
            if !self.angles().contains(theta) {
                self.push(*theta);
            }
        }
        self
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
        let reach = self.pin_distance(gamma.clamp(0.0, PI));
        let short = (self.e.abs() - reach).max(0.0);
        let slope = r * l * gamma.clamp(0.0, PI).sin() / reach.max(f64::MIN_POSITIVE);
        if short > 1e-12 * (r + l) {
            outside + short / slope.max(1e-3 * (r + l))
        } else {
            outside
        }
    }

    /// |OP| for an angle at the crank pin.
    fn pin_distance(&self, gamma: f64) -> f64 {
        let (r, l) = (self.r, self.l);
        (r - l * gamma.cos()).hypot(l * gamma.sin())
    }

    /// The crank angles, in [−π, π), at which the angle at the crank pin has this size; a size just outside what is
    /// possible is taken for the border.
    pub fn angles_of_gamma(&self, gamma: f64) -> Candidates {
        let gamma = gamma.clamp(0.0, PI);
        let reach = self.pin_distance(gamma);
        let x = ((reach - self.e) * (reach + self.e)).max(0.0).sqrt();
        // The direction of P as seen from O, against the crank's.
        let lean = (self.l * gamma.sin()).atan2(self.r - self.l * gamma.cos());
        let mut found = Candidates::default();
        for x in [x, -x] {
            let to_pin = (-self.e).atan2(x);
            for theta in [to_pin - lean, to_pin + lean] {
                self.keep(&mut found, theta, x);
            }
        }
        found
    }

    /// How far a slider position, m, is from those that the mechanism can have.
    pub fn excess_of_x(&self, x: f64) -> f64 {
        let (r, l) = (self.r, self.l);
        let reach = x.hypot(self.e);
        let outside = (reach - (r + l)).max((r - l).abs() - reach).max(0.0);
        if outside == 0.0 && self.angles_of_x(x).count == 0 {
            return x.abs().max(r);
        }
        outside
    }

    /// The crank angles, in [−π, π), at which the slider is at x, m; a position just outside what is possible is
    /// taken for the border.
    pub fn angles_of_x(&self, x: f64) -> Candidates {
        let (r, l) = (self.r, self.l);
        let reach = x.hypot(self.e);
        // tan² of half the angle between OP and the crank (law of cosines, without cancellation).
        let above = ((l + r) - reach).max(0.0) * (reach + (l - r)).max(0.0);
        let below = (reach - (l - r)).max(0.0) * (reach + (l + r));
        let lean = 2.0 * above.sqrt().atan2(below.sqrt());
        let to_pin = (-self.e).atan2(x);
        let mut found = Candidates::default();
        for theta in [to_pin - lean, to_pin + lean] {
            self.keep(&mut found, theta, x);
        }
        found
    }

    /// Keeps an angle that belongs to the branch and is not there yet.
    fn keep(&self, found: &mut Candidates, theta: f64, x: f64) {
        let along = self.s * (x - self.r * theta.cos());
        let theta = (theta + PI).rem_euclid(TAU) - PI;
        if along >= -1e-9 * self.l && !found.angles().contains(&theta) {
            found.push(theta);
        }
    }
}
