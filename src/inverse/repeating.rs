//! Torque that repeats: harmonics of the crank angle, whose amplitudes may follow the speed.

use std::iter;

use super::matrix::Matrix;
use super::prior::{Prior, State};

/// A torque that repeats, N m.
#[derive(Clone, Debug)]
pub(super) struct Repeating {
    pub prior: Prior,
    pub coefficients: Vec<f64>,
    /// Number of harmonics that the samples determine.
    pub told: usize,
    /// Unit of the speed, rad/s.
    pub speed: f64,
    /// Covariance of θ, ω and u by that of the coefficients, in the mean of the nodes.
    pub covariance: Matrix<3>,
}

impl Repeating {
    /// Returns the derivatives by θ and ω at a state.
    pub fn slopes(&self, [theta, omega, ..]: &State) -> [f64; 2] {
        let cycle = f64::from(self.prior.cycle);
        let pairs = cosines_and_sines(theta / cycle, self.prior.harmonics);
        let of = self.prior.of_harmonic();
        let (mut by_theta, mut by_omega) = (0.0, 0.0);
        for (k, (pair, some)) in pairs.zip(self.coefficients.chunks_exact(of)).enumerate() {
            let rate = (k + 1) as f64 / cycle;
            for (power, some) in some.chunks_exact(2).enumerate() {
                let factor = if power == 0 { 1.0 } else { omega / self.speed };
                by_theta += rate * factor * (some[1] * pair[0] - some[0] * pair[1]);
                if power == 1 {
                    by_omega += dot(some, &pair) / self.speed;
                }
            }
        }
        [by_theta, by_omega]
    }

    /// Returns the torque at a crank angle, rad, and a speed, rad/s.
    pub fn at(&self, theta: f64, omega: f64) -> f64 {
        let speed = omega / self.speed;
        let pairs = cosines_and_sines(theta / f64::from(self.prior.cycle), self.prior.harmonics);
        let of = self.coefficients.chunks_exact(self.prior.of_harmonic());
        let torques = pairs.zip(of).map(|(pair, some)| {
            let (alone, with_speed) = some.split_at(2);
            dot(alone, &pair) + speed * dot(with_speed, &pair)
        });
        torques.sum()
    }
}

/// cos kθ and sin kθ of the cycle angle.
pub(super) fn cosines_and_sines(angle: f64, harmonics: usize) -> impl Iterator<Item = [f64; 2]> {
    let (sin, cos) = angle.sin_cos();
    let next = move |[c, s]: &[f64; 2]| Some([c * cos - s * sin, s * cos + c * sin]);
    iter::successors(Some([cos, sin]), next).take(harmonics)
}

/// Sum of the products of two rows.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
