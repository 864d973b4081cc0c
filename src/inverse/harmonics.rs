//! Harmonics of the crank angle, whose amplitudes may follow the speed.

use std::iter;

use super::grid::hermite;
use super::linearised::{Linearised, State};
use super::matrix::Matrix;
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

    /// Adds what the torque does in each step to its prediction from states at its ends.
    pub fn act(&self, states: &[State], steps: &mut [Linearised]) {
        let ways: Vec<_> = ways(states, steps, self.speed).collect();
        let mut before = ways.first().map_or(0.0, |[begin, ..]| self.at(*begin));
        for (step, [_, middle, end]) in steps.iter_mut().zip(ways) {
            let [half, whole] = [middle, end].map(|place| self.at(place) - before);
            before += whole;
            let responses = responses(step.h, step.lever);
            for (to, [by_half, by_whole]) in step.defect.iter_mut().zip(responses) {
                *to += by_half * half + by_whole * whole;
            }
        }
    }

    /// Returns the torque at a crank angle, rad, and a speed in units of its own.
    fn at(&self, [theta, speed]: [f64; 2]) -> f64 {
        let pairs = cosines_and_sines(theta / f64::from(self.prior.cycle), self.prior.harmonics);
        let of = self.coefficients.chunks_exact(self.prior.of_harmonic());
        let torques = pairs.zip(of).map(|(pair, some)| {
            let (alone, with_speed) = some.split_at(2);
            dot(alone, &pair) + speed * dot(with_speed, &pair)
        });
        torques.sum()
    }
}

/// Responses of θ, ω and u at the end of a step h to torques in its middle and at its end, by Simpson's rule for θ̈.
pub(super) fn responses(h: f64, lever: f64) -> [[f64; 2]; 3] {
    [
        [h * h * lever / 3.0, 0.0],
        [h * lever * (2.0 / 3.0), h * lever / 6.0],
        [0.0, 1.0],
    ]
}

/// Crank angles, rad, and speeds, in units of one, at begin, middle and end of each step.
pub(super) fn ways(
    states: &[State],
    steps: &[Linearised],
    speed: f64,
) -> impl Iterator<Item = [[f64; 2]; 3]> {
    let pairs = states.windows(2).zip(steps);
    pairs.map(move |(ends, step)| {
        let [a, b] = [0, 1].map(|k| [ends[k][0], ends[k][1]]);
        let middle = hermite([0.0, step.h], [a, b], 0.5 * step.h);
        [a, middle, b].map(|[theta, omega]| [theta, omega / speed])
    })
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
        let at = |[angle, speed]: [f64; 2]| -> Vec<f64> {
            let list = cosines_and_sines(angle / f64::from(prior.cycle), prior.harmonics);
            match prior.follows_speed {
                false => list.flatten().collect(),
                true => list
                    .flat_map(|[cos, sin]| [cos, sin, speed * cos, speed * sin])
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
fn cosines_and_sines(angle: f64, harmonics: usize) -> impl Iterator<Item = [f64; 2]> {
    let (sin, cos) = angle.sin_cos();
    let next = move |[c, s]: &[f64; 2]| Some([c * cos - s * sin, s * cos + c * sin]);
    iter::successors(Some([cos, sin]), next).take(harmonics)
}

/// Sum of the products of two rows.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
