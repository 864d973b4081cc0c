//! State-space model of deviations from a nominal path, u an integrated Wiener process (Gauss-Newton; Bell 1994).

#![allow(clippy::needless_range_loop)]

use std::sync::Arc;

use super::harmonics::Increments;
use super::kalman::{Gaussian, Sample, Step};
use super::linearised::Linearised;
use super::matrix::{Matrix, diagonal};
use super::prior::{Prior, State};
use super::regressors::Regressors;

/// Evaluates an expression with the number of states, 3 to 8, as a constant.
macro_rules! with_dimension {
    (const $n:ident = $number:literal => $value:expr) => {{
        const $n: usize = $number;
        $value
    }};
    ($states:expr, $n:ident => $value:expr) => {
        match $states {
            3 => with_dimension!(const $n = 3 => $value),
            4 => with_dimension!(const $n = 4 => $value),
            5 => with_dimension!(const $n = 5 => $value),
            6 => with_dimension!(const $n = 6 => $value),
            7 => with_dimension!(const $n = 7 => $value),
            _ => with_dimension!(const $n = 8 => $value),
        }
    };
}
pub(in crate::inverse) use with_dimension;

/// White fraction of the variance of correlated noise, held fixed.
const WHITE_FRACTION: f64 = 0.02;

/// Mean deviation of the samples of a node from the nominal path.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::inverse) struct Observed {
    /// Measured minus nominal, rad or m.
    pub residual: f64,
    /// d measured/dθ, rad or m per rad, or d measured/dω.
    pub slope: f64,
    /// Variance over that of one sample; infinite without a sample.
    pub variance: f64,
    /// Whether the speed is measured in the place of the angle.
    pub is_speed: bool,
}

/// Steps and samples of a stretch of nodes.
#[derive(Clone, Debug, Default)]
pub(in crate::inverse) struct Stretch {
    pub steps: Arc<Vec<Linearised>>,
    /// Intensity of the process noise in each step over the usual one.
    pub intensities: Vec<f64>,
    /// g₁ and g₂ of the nominal path at its begin, in the place of those that the prior expects: 0.
    pub constants: [f64; 2],
    /// Increments of the harmonics of the periodic part in each step.
    pub increments: Increments,
    /// Regressors of the tones.
    pub tones: Arc<Regressors>,
    pub observed: Arc<Vec<Observed>>,
}

impl Stretch {
    /// The same stretch beside tones that are known.
    pub fn beside_known_tones(&self) -> Stretch {
        Stretch {
            tones: Arc::default(),
            ..self.clone()
        }
    }
}

/// Linear model of the deviations from a nominal path; N is 2 + order, one more with each power of the speed, one more with
/// correlated noise.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct Deviations<'a> {
    pub stretch: &'a Stretch,
    pub prior: Prior,
    /// Spectral density of the process noise over σ².
    pub noise: f64,
    /// Spectral density of the white noise that g₁ integrates, over σ².
    pub speed_noise: f64,
    /// The same where the process noise is stronger than usual, for each part of the usual intensity.
    pub law_noise: f64,
    /// Decay rate of the correlation of the sample noise, 1/s; none for white noise.
    pub correlated: Option<f64>,
    /// Standard deviations of the state before the first sample, in σ.
    pub spread: State,
}

impl Deviations<'_> {
    /// Returns the number of states, with that of the correlated noise.
    pub fn dimension(&self) -> usize {
        self.prior.states() + usize::from(self.correlated.is_some())
    }

    /// Returns the step from a node to the next.
    #[inline(always)]
    pub fn step<const N: usize>(&self, node: usize) -> Step<N> {
        let step = &self.stretch.steps[node];
        let mut transition = diagonal([1.0; N]);
        let mut offset = [0.0; N];
        for i in 0..N {
            if i + 1 < N || self.correlated.is_none() {
                transition[0][i] = step.top[0][i];
                transition[1][i] = step.top[1][i];
                offset[i] = step.defect[i];
            }
        }
        if self.prior.order > 1 {
            transition[2][3] = step.h;
        }
        if self.prior.order > 2 {
            transition[2][4] = 0.5 * step.h * step.h;
            transition[3][4] = step.h;
        }
        for k in 0..self.prior.powers {
            // What a power of the speed adds to u begins at 0 and grows at its tilt.
            let ramp = [step.top[0][3], step.top[1][3], step.h];
            for (row, ramp) in transition.iter_mut().zip(ramp) {
                row[self.prior.diffuse() + k] = ramp * step.tilt[k];
            }
        }
        let mut noise = self.process_noise(node);
        if let Some(decay) = self.correlated {
            // e = φ − 1 of the factor φ in a step; 1 − φ² = −e (2 + e).
            let e = (-decay * step.h).exp_m1();
            transition[N - 1][N - 1] = 1.0 + e;
            noise[N - 1][N - 1] = (1.0 - WHITE_FRACTION) * -e * (2.0 + e);
        }
        Step {
            transition,
            offset,
            noise,
        }
    }

    /// Returns the sample of a node; none without a measurement.
    #[inline(always)]
    pub fn sample(&self, node: usize) -> Option<Sample> {
        let observed = &self.stretch.observed[node];
        if observed.variance == f64::INFINITY {
            return None;
        }
        let white = self.correlated.map_or(1.0, |_| WHITE_FRACTION);
        Some(Sample {
            value: observed.residual,
            is_second: observed.is_speed,
            slope: observed.slope,
            is_correlated: self.correlated.is_some(),
            variance: white * observed.variance,
        })
    }

    /// Returns mean and covariance before the first sample.
    pub fn start<const N: usize>(&self) -> Gaussian<N> {
        let (mut mean, mut variances) = ([0.0; N], [0.0; N]);
        for k in 0..self.prior.states() {
            variances[k] = self.spread[k] * self.spread[k];
        }
        for k in 0..self.prior.powers {
            mean[self.prior.diffuse() + k] = -self.stretch.constants[k];
        }
        if self.correlated.is_some() {
            variances[N - 1] = 1.0 - WHITE_FRACTION;
        }
        Gaussian {
            mean,
            covariance: diagonal(variances),
        }
    }

    /// Returns the covariance ∫ ψ ψᵀ ds of the process noise in a step, from the responses ψ of the state to white noise.
    #[inline(always)]
    pub fn process_noise<const N: usize>(&self, node: usize) -> Matrix<N> {
        let step = &self.stretch.steps[node];
        let mut covariance = [[0.0; N]; N];
        let noise = &mut covariance;
        let (h, b, tilt) = (step.h, step.lever, step.tilt[0]);
        let (h2, h3) = (h * h / 2.0, h * h * h / 6.0);
        let time = h * self.stretch.intensities[node];
        let density = time * self.noise;
        match self.prior.order {
            1 => add(noise, [0, 1, 2], &[b * h2, b * h, 1.0], density),
            2 => add(noise, [0, 1, 2, 3], &[b * h3, b * h2, h, 1.0], density),
            _ => {
                let response = [b * h3 * h / 4.0, b * h3, h2, h, 1.0];
                add(noise, [0, 1, 2, 3, 4], &response, density);
            }
        }
        let intensity = self.stretch.intensities[node];
        let of_speed = time * self.speed_noise + h * (intensity - 1.0).max(0.0) * self.law_noise;
        if of_speed > 0.0 {
            let states = [0, 1, 2, self.prior.diffuse()];
            let response = [b * tilt * h3, b * tilt * h2, tilt * h, 1.0];
            add(noise, states, &response, of_speed);
        }
        covariance
    }
}

/// ∫ s^p ds from 0 to 1.
const PER: [f64; 9] = [
    1.0,
    1.0 / 2.0,
    1.0 / 3.0,
    1.0 / 4.0,
    1.0 / 5.0,
    1.0 / 6.0,
    1.0 / 7.0,
    1.0 / 8.0,
    1.0 / 9.0,
];

/// Adds to Q white noise of a density, whose unit at a time s before the end of a step h becomes `response` times
/// (s/h)^p in `states`, p from R − 1 down to 0.
#[inline(always)]
fn add<const N: usize, const R: usize>(
    noise: &mut Matrix<N>,
    states: [usize; R],
    response: &[f64; R],
    density: f64,
) {
    for m in 0..R {
        for n in 0..R {
            let of_both = PER[2 * R - 2 - m - n] * response[m] * response[n];
            noise[states[m]][states[n]] += density * of_both;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::model::prior::FOLLOWING;

    fn model(stretch: &Stretch) -> Deviations<'_> {
        Deviations {
            stretch,
            prior: FOLLOWING,
            noise: 2.0,
            speed_noise: 0.0,
            law_noise: 0.3,
            correlated: None,
            spread: [10.0; 7],
        }
    }

    /// In a step of 0.2 s with 5 times the usual intensity g₁ has 4 times its noise of 0.3 for the usual one, and is without noise
    /// elsewhere; u has what g₁ adds to it at the rate of the speed.
    #[test]
    fn a_law_changes_where_the_noise_is_stronger() {
        let step = Linearised {
            h: 0.2,
            lever: 1.0,
            tilt: [3.0, 0.0],
            ..Linearised::default()
        };
        let stretch = Stretch {
            steps: vec![step; 3].into(),
            intensities: vec![1.0, 5.0, 0.1],
            ..Stretch::default()
        };
        let noise = [0, 1, 2].map(|node| model(&stretch).process_noise::<4>(node));
        let of_law = 4.0 * 0.3 * 0.2;
        for (found, expected) in [
            (noise[1][3][3], of_law),
            (noise[1][2][2], 5.0 * 2.0 * 0.2 + of_law * 0.6 * 0.6 / 3.0),
            (noise[0][3][3], 0.0),
            (noise[0][2][2], 2.0 * 0.2),
            (noise[2][3][3], 0.0),
        ] {
            assert!((found - expected).abs() < 1e-12, "{found}: {expected}");
        }
    }

    /// About a path whose g₁ is 0.4 the prior expects a deviation of −0.4, so that g₁ itself is 0.
    #[test]
    fn a_law_begins_at_nothing_about_any_path() {
        let stretch = Stretch {
            constants: [0.4, 0.0],
            ..Stretch::default()
        };
        assert_eq!(model(&stretch).start::<4>().mean, [0.0, 0.0, 0.0, -0.4]);
    }
}
