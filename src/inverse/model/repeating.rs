//! Torque that repeats: harmonics of the crank angle, whose amplitudes may follow the speed.

use std::f64::consts::TAU;
use std::iter;

use super::matrix::Matrix;
use super::prior::Prior;
use crate::numeric::hermite::Quintic;

/// A torque that repeats, N m.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct Repeating {
    pub coefficients: Vec<f64>,
    /// Number of harmonics that the samples determine.
    pub told: usize,
    /// Unit of the speed, rad/s.
    pub speed: f64,
    /// Covariance of θ, ω and u by that of the coefficients, in the mean of the nodes.
    pub covariance: Matrix<3>,
    /// Turns of a cycle.
    turns: f64,
    /// The parts of equal length of a cycle: torque alone, and torque per unit of the speed.
    parts: Vec<[Part; 2]>,
}

/// Torque over a part of a cycle.
#[derive(Clone, Copy, Debug)]
struct Part {
    begin: f64,
    change: Quintic,
}

/// The torque of the harmonics, with its first two derivatives by the angle of the cycle.
type Series = [f64; 3];

impl Repeating {
    /// The torque of these harmonics, tabulated: the quintics err by 1e-7 of the amplitude of the last harmonic.
    pub fn new(
        prior: Prior,
        coefficients: Vec<f64>,
        speed: f64,
        told: usize,
        covariance: Matrix<3>,
    ) -> Repeating {
        let count = 16 * prior.numbers().max().unwrap_or(0);
        let length = TAU / count as f64;
        let ends: Vec<[Series; 2]> = (0..=count)
            .map(|k| series(prior, &coefficients, k as f64 * length))
            .collect();
        let part = |from: Series, to: Series| {
            let end = |[_, rate, second]: Series| [length * rate, 0.5 * length * length * second];
            Part {
                begin: from[0],
                change: Quintic::new(end(from), end(to), to[0] - from[0]),
            }
        };
        let parts = ends.windows(2);
        Repeating {
            parts: parts
                .map(|w| [0, 1].map(|k| part(w[0][k], w[1][k])))
                .collect(),
            turns: f64::from(prior.cycle),
            coefficients,
            told,
            speed,
            covariance,
        }
    }

    /// Returns the torque at a crank angle, rad, and a speed, rad/s, and its derivatives by both.
    pub fn at(&self, theta: f64, omega: f64) -> [f64; 3] {
        let count = self.parts.len() as f64;
        let per_radian = count / (TAU * self.turns);
        let place = (theta * per_radian).rem_euclid(count);
        let index = (place as usize).min(self.parts.len() - 1);
        let [alone, with_speed] = self.parts[index].map(|Part { begin, change }| {
            let [change, rate, _] = change.at(place - index as f64);
            [begin + change, rate * per_radian]
        });
        let speed = omega / self.speed;
        [
            alone[0] + speed * with_speed[0],
            alone[1] + speed * with_speed[1],
            with_speed[0] / self.speed,
        ]
    }
}

/// Returns the torque alone and that per unit of the speed at an angle of the cycle, rad.
fn series(prior: Prior, coefficients: &[f64], angle: f64) -> [Series; 2] {
    let mut sums = [[0.0; 3]; 2];
    let pairs = waves(angle, prior);
    let of = coefficients.chunks_exact(prior.of_harmonic());
    for (k, ([cos, sin], some)) in prior.numbers().zip(pairs.zip(of)) {
        let k = k as f64;
        for (sum, some) in sums.iter_mut().zip(some.chunks_exact(2)) {
            let value = some[0] * cos + some[1] * sin;
            sum[0] += value;
            sum[1] += k * (some[1] * cos - some[0] * sin);
            sum[2] -= k * k * value;
        }
    }
    sums
}

/// cos kθ and sin kθ of the cycle angle, for the harmonics of a prior.
pub(in crate::inverse) fn waves(angle: f64, prior: Prior) -> impl Iterator<Item = [f64; 2]> {
    let high = prior.high.into_iter().flatten();
    let high = high.map(move |k| (f64::from(k) * angle).sin_cos());
    let high = high.map(|(sin, cos)| [cos, sin]);
    high.chain(cosines_and_sines(angle, prior.harmonics))
}

/// cos kθ and sin kθ of the cycle angle, from k = 1 on.
pub(in crate::inverse) fn cosines_and_sines(
    angle: f64,
    harmonics: usize,
) -> impl Iterator<Item = [f64; 2]> {
    let (sin, cos) = angle.sin_cos();
    let next = move |[c, s]: &[f64; 2]| Some([c * cos - s * sin, s * cos + c * sin]);
    iter::successors(Some([cos, sin]), next).take(harmonics)
}

/// Sum of the products of two rows.
pub(in crate::inverse) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
