//! Harmonics of the crank angle, whose amplitudes may follow the speed.

use std::iter;

use super::linearised::State;
use super::prior::Prior;

/// A torque that repeats, N m.
#[derive(Clone, Debug)]
pub(super) struct Repeating {
    pub prior: Prior,
    pub coefficients: Vec<f64>,
    /// Number of harmonics that the samples determine.
    pub told: usize,
    /// Unit of the speed, rad/s.
    pub speed: f64,
}

impl Repeating {
    /// Returns the derivatives by θ and ω at a state.
    pub fn slopes(&self, [theta, omega, ..]: &State) -> [f64; 2] {
        let cycle = f64::from(self.prior.cycle);
        let pairs = cosines_and_sines(theta / cycle, self.prior.harmonics);
        let pairs = pairs.chunks_exact(2);
        let of = self.prior.of_harmonic();
        let (mut by_theta, mut by_omega) = (0.0, 0.0);
        for (k, (pair, some)) in pairs.zip(self.coefficients.chunks_exact(of)).enumerate() {
            let rate = (k + 1) as f64 / cycle;
            for (power, some) in some.chunks_exact(2).enumerate() {
                let factor = if power == 0 { 1.0 } else { omega / self.speed };
                by_theta += rate * factor * (some[1] * pair[0] - some[0] * pair[1]);
                if power == 1 {
                    by_omega += dot(some, pair) / self.speed;
                }
            }
        }
        [by_theta, by_omega]
    }
}

/// Harmonics in the middle and at the end of each step less those at its begin.
#[derive(Clone, Debug, Default)]
pub(super) struct Increments {
    /// Number of coefficients.
    pub count: usize,
    /// Middle and end of each step, one after the other.
    values: Vec<f64>,
}

impl Increments {
    /// Of a prior along a path with these crank angles, rad, and speeds, over their root mean square, at begins, middles and ends.
    pub fn new(ways: impl Iterator<Item = [[f64; 2]; 3]>, prior: Prior) -> Increments {
        let at = |[angle, speed]: [f64; 2]| {
            let list = cosines_and_sines(angle / f64::from(prior.cycle), prior.harmonics);
            match prior.follows_speed {
                false => list,
                true => list
                    .chunks(2)
                    .flat_map(|pair| [pair[0], pair[1], speed * pair[0], speed * pair[1]])
                    .collect(),
            }
        };
        let mut values = Vec::new();
        let mut known = None;
        for [begin, middle, end] in ways {
            let begin = known.unwrap_or_else(|| at(begin));
            let end = at(end);
            for list in [&at(middle), &end] {
                values.extend(list.iter().zip(&begin).map(|(now, before)| now - before));
            }
            known = Some(end);
        }
        let count = prior.coefficients();
        Increments { count, values }
    }

    /// Middle and end of a step.
    pub fn of(&self, step: usize) -> (&[f64], &[f64]) {
        self.values[2 * step * self.count..][..2 * self.count].split_at(self.count)
    }
}

/// cos kθ and sin kθ of the cycle angle.
fn cosines_and_sines(angle: f64, harmonics: usize) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let next = |(c, s): &(f64, f64)| Some((c * cos - s * sin, s * cos + c * sin));
    let pairs = iter::successors(Some((cos, sin)), next).take(harmonics);
    pairs.flat_map(|(c, s)| [c, s]).collect()
}

/// Sum of the products of two rows.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
