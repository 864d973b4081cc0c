//! The deviations from a nominal path as a state-space model: u is an integrated Wiener process (Gauss-Newton; Bell 1994).
#![allow(
    clippy::needless_range_loop,
    reason = "matrices stand in index notation"
)]

use super::kalman::{Gaussian, Matrix, Model, Sample, Step, Vector};
use super::linearised::{Linearised, Prior, State};

/// Mean deviation of the samples of a node from the nominal path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Observed {
    /// Measured minus nominal, rad or m.
    pub residual: f64,
    /// d measured/dθ
    pub slope: f64,
    /// Variance over that of one sample; infinite without a sample.
    pub variance: f64,
}

/// Correlated noise: a first-order autoregression beside the white noise of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Autoregression {
    /// Rate at which the correlation decays, 1/s.
    pub decay: f64,
    /// White part of the variance of a sample.
    pub white: f64,
}

/// The linear model of the deviations from a nominal path; N is 2 + order, and one more with correlated noise.
#[derive(Clone, Debug)]
pub(super) struct Deviations<'a> {
    pub steps: &'a [Linearised],
    pub observed: &'a [Observed],
    pub prior: Prior,
    /// Spectral density of the process noise over σ².
    pub noise: f64,
    /// Spectral density of white noise that u itself follows beside it, over σ².
    pub level: f64,
    /// Spectral density of the white noise that g follows, over σ².
    pub drift: f64,
    pub correlated: Option<Autoregression>,
    /// Standard deviations of the state before the first sample, in σ.
    pub spread: State,
}

impl<const N: usize> Model<N> for Deviations<'_> {
    fn nodes(&self) -> usize {
        self.observed.len()
    }

    #[inline]
    fn step(&self, node: usize) -> Step<N> {
        let step = &self.steps[node];
        let dimension = self.prior.states();
        let mut transition: Matrix<N> = [[0.0; N]; N];
        let mut noise: Matrix<N> = [[0.0; N]; N];
        let mut offset: Vector<N> = [0.0; N];
        for row in 0..2 {
            transition[row][..dimension].copy_from_slice(&step.top[row][..dimension]);
        }
        for row in 2..dimension {
            transition[row][row] = 1.0;
        }
        offset[..dimension].copy_from_slice(&step.defect[..dimension]);
        self.integrate(step, step.h, &mut transition);
        self.add_noise(step, &mut noise);
        if let Some(Autoregression { decay, white }) = self.correlated {
            let kept = (-decay * step.h).exp();
            transition[N - 1][N - 1] = kept;
            noise[N - 1][N - 1] = (1.0 - white) * -(-2.0 * decay * step.h).exp_m1();
        }
        Step {
            transition,
            offset,
            noise,
        }
    }

    /// Φ⁻¹ = [[B⁻¹, −B⁻¹ C T⁻¹], [0, T⁻¹]] of Φ = [[B, C], [0, T]].
    #[inline]
    fn inverse(&self, node: usize) -> Matrix<N> {
        let step = &self.steps[node];
        let mut inverse: Matrix<N> = [[0.0; N]; N];
        let [[a, b, ..], [c, d, ..]] = step.top;
        let per = 1.0 / (a * d - b * c);
        let small = [[d * per, -b * per], [-c * per, a * per]];
        for row in 0..2 {
            inverse[row][..2].copy_from_slice(&small[row]);
        }
        for (k, row) in inverse.iter_mut().enumerate().skip(2) {
            row[k] = 1.0;
        }
        self.integrate(step, -step.h, &mut inverse);
        for k in 2..self.prior.states() {
            let column = [0, 1].map(|row| {
                (2..=k)
                    .map(|i| step.top[row][i] * inverse[i][k])
                    .sum::<f64>()
            });
            for row in 0..2 {
                inverse[row][k] = -(small[row][0] * column[0] + small[row][1] * column[1]);
            }
        }
        if let Some(correlated) = self.correlated {
            inverse[N - 1][N - 1] = (correlated.decay * step.h).exp();
        }
        inverse
    }

    #[inline]
    fn sample(&self, node: usize) -> Option<Sample<N>> {
        let observed = &self.observed[node];
        if observed.variance == f64::INFINITY {
            return None;
        }
        let mut row = [0.0; N];
        row[0] = observed.slope;
        let mut variance = observed.variance;
        if let Some(correlated) = self.correlated {
            row[N - 1] = 1.0;
            variance *= correlated.white;
        }
        Some(Sample {
            value: observed.residual,
            row,
            variance,
        })
    }

    fn start(&self) -> Gaussian<N> {
        let mut covariance = [[0.0; N]; N];
        for k in 0..self.prior.states() {
            covariance[k][k] = self.spread[k] * self.spread[k];
        }
        if let Some(correlated) = self.correlated {
            covariance[N - 1][N - 1] = 1.0 - correlated.white;
        }
        Gaussian {
            mean: [0.0; N],
            covariance,
        }
    }
}

impl Deviations<'_> {
    /// Number of states, that of the noise with them.
    pub fn dimension(&self) -> usize {
        self.prior.states() + usize::from(self.correlated.is_some())
    }

    /// What the derivatives of u and g add to u and to those below them over a time.
    #[inline]
    fn integrate<const N: usize>(&self, step: &Linearised, time: f64, matrix: &mut Matrix<N>) {
        let last = 2 + self.prior.order;
        for i in 2..last {
            let mut factor = 1.0;
            for k in i + 1..last {
                factor *= time / (k - i) as f64;
                matrix[i][k] = factor;
            }
        }
        if self.prior.follows_speed {
            matrix[2][last] = time * step.tilt;
        }
    }

    /// ∫ ψ ψᵀ ds of the responses ψ of the state to units of white noise.
    #[inline]
    fn add_noise<const N: usize>(&self, step: &Linearised, noise: &mut Matrix<N>) {
        let (h, b, tilt) = (step.h, step.lever, step.tilt);
        // Responses a (s/h)^p at a time s after an impulse, p from one less than their number to 0, at these states.
        let mut add = |states: &[usize], response: &[f64], density: f64| {
            let top = 2 * states.len() - 1;
            for (m, i) in states.iter().enumerate() {
                for (n, j) in states.iter().enumerate() {
                    let power = (top - m - n) as f64;
                    noise[*i][*j] += density * h * response[m] * response[n] / power;
                }
            }
        };
        let (h2, h3) = (h * h / 2.0, h * h * h / 6.0);
        match self.prior.order {
            1 => add(&[0, 1, 2], &[b * h2, b * h, 1.0], self.noise + self.level),
            _ => add(&[0, 1, 2, 3], &[b * h3, b * h2, h, 1.0], self.noise),
        }
        if self.prior.order > 1 && self.level > 0.0 {
            add(&[0, 1, 2], &[b * h2, b * h, 1.0], self.level);
        }
        if self.drift > 0.0 {
            let response = [b * tilt * h3, b * tilt * h2, tilt * h, 1.0];
            add(&[0, 1, 2, 2 + self.prior.order], &response, self.drift);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::kalman::times;
    use crate::inverse::linearised::{Unknown, exponential};

    #[test]
    fn the_inverse_transition_undoes_the_transition() {
        let step = Linearised {
            h: 0.3,
            top: exponential(0.3, -2.0, 0.7, 1.7),
            lever: 1.7,
            tilt: 0.7,
            ..Linearised::default()
        };
        let model = Deviations {
            steps: &[step],
            observed: &[],
            prior: Prior {
                unknown: Unknown::Torque,
                order: 2,
                follows_speed: false,
            },
            noise: 1.0,
            level: 0.5,
            drift: 0.0,
            correlated: Some(Autoregression {
                decay: 2.0,
                white: 0.1,
            }),
            spread: [1.0; 4],
        };
        let (step, inverse): (Step<5>, Matrix<5>) = (model.step(0), model.inverse(0));
        let x = [0.3, -1.0, 2.0, 0.7, 0.2];
        let back = times(&inverse, &times(&step.transition, &x));
        for (x, back) in x.iter().zip(back) {
            assert!((x - back).abs() < 1e-14);
        }
    }
}
