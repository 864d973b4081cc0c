//! Typical magnitudes along a record, and the noise parameters that are estimated in terms of them.

use super::model::prior::{ORDERS, State};
use super::repeating::spectrum::Spectrum;
use crate::numeric::ROUNDING_DEVIATION;

/// Typical magnitudes along a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    /// Mean time between samples, or the means in their place, s.
    pub spacing: f64,
    /// Number of samples of a mean, in the mean.
    pub samples: f64,
    /// Duration of the record, s.
    pub duration: f64,
    /// Root mean square of d measured/dθ.
    pub slope: f64,
    /// Root mean square of ∂θ̈/∂u.
    pub lever: f64,
    /// Root mean square of θ̈, rad/s²: spread of the prior before the first sample.
    pub acceleration: f64,
    /// Root mean square of the speed, rad/s.
    pub speed: f64,
    /// Standard deviations of ω, rad/s, and of ω|ω|, rad²/s², along the record.
    pub powers: [f64; 2],
    /// Root mean square of u along the record, in σ: what a power of the speed that varies by its standard deviation adds to u has
    /// this one.
    pub torque: f64,
    /// Lower bound of the standard deviation of a sample, rad or m.
    pub floor: f64,
    /// Standard deviation of a sample of weight 1, rad, where it is known (codes).
    pub known: Option<f64>,
    /// Whether the crank angle before the first sample is known, as it has to be for samples of the speed.
    pub begins_at_angle: bool,
    /// Number of values of the scene that are estimated beside a torque that begins at 0; none where it begins anywhere.
    pub identified: Option<usize>,
}

/// Parameters of the process noise and of the sample noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Corner frequency ω_c of the smoother, rad/s: the spectral density of the process noise is q = ω_c^(2D) σ²
    /// h/(lever² slope²) for sample spacing h and D integrations from the white noise to θ.
    pub corner: f64,
    /// Corner frequency, rad/s, of the Wiener process g₁ in u = g₁ ω: density of a prior of order one, over the squared
    /// spread of the speed; 0 if g₁ is constant or absent.
    pub speed_corner: f64,
    /// Variances of the harmonics of the periodic part.
    pub spectrum: Option<Spectrum>,
    /// Decay rate, 1/s, of the correlation of the sample noise, a first-order autoregression beside white noise; none for
    /// white noise.
    pub correlated: Option<f64>,
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// ln of the marginal likelihood, less what the two parameters of a spectrum cost.
    pub likelihood: f64,
}

impl Noise {
    /// Returns white sample noise with a corner frequency of the process noise, rad/s.
    pub fn white(corner: f64) -> Noise {
        Noise {
            corner,
            speed_corner: 0.0,
            spectrum: None,
            correlated: None,
            sigma: 1.0,
            likelihood: f64::NEG_INFINITY,
        }
    }
}

/// Standard deviations of the initial state over those left by the first few samples alone: diffuse enough to count for
/// 1e-6 of one sample, narrow enough to keep ten digits under rounding.
const DIFFUSE: f64 = 1e3;

impl Scales {
    /// Returns the standard deviations of the state before the first sample, in σ.
    pub fn spread(&self) -> State {
        let mut size = DIFFUSE / self.slope;
        std::array::from_fn(|k| {
            let spread = match self.begins_at_angle && k == 0 {
                true => size / (DIFFUSE * DIFFUSE),
                false => size,
            };
            size /= if k == 1 {
                self.spacing * self.lever
            } else {
                self.spacing
            };
            spread
        })
    }

    /// Returns the sizes of u, as all of the acceleration needs it, and of its derivatives: they change u by what it is along the
    /// record, there or in the time constant of its noise.
    pub fn of_unknown(&self, noise: &Noise) -> [f64; ORDERS] {
        let all = self.torque * noise.sigma;
        let rate = noise.corner.max(1.0 / (ROUNDING_DEVIATION * self.duration));
        let derivative = |order: i32| (all * rate.powi(order)).max(f64::MIN_POSITIVE);
        [self.acceleration / self.lever, derivative(1), derivative(2)]
    }

    /// Returns the least and largest corner frequency, rad/s.
    pub fn corners(&self) -> [f64; 2] {
        [0.1 / self.duration, 30.0 / self.spacing]
    }

    /// Returns the spectral density of the process noise over σ², by corner frequency (rad/s) and order.
    pub fn density(&self, corner: f64, order: usize) -> f64 {
        let integrations = i32::try_from(2 * (order + 2)).unwrap_or(10);
        corner.powi(integrations) * self.spacing / self.samples / (self.lever * self.slope).powi(2)
    }
}

/// Returns the root of the mean square of numbers, 0 of none.
pub(super) fn root_mean_square(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.fold((0.0, 0.0), |(sum, n), x| (sum + x * x, n + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}
