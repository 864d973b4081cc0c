//! Typical sizes along a record, and the noise that is estimated in terms of them.

use super::linearised::State;
use super::regression::Spectrum;

/// Typical sizes along a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    /// Time from sample to sample, s.
    pub spacing: f64,
    /// Duration, s.
    pub duration: f64,
    /// d measured/dθ, root mean square.
    pub slope: f64,
    /// ∂θ̈/∂u, root mean square.
    pub lever: f64,
    /// θ̈, rad/s², and its rate, rad/s³, root mean squares: spread of the prior before the first sample.
    pub motion: [f64; 2],
    /// ω, rad/s, root mean square about its mean.
    pub speed: f64,
    /// Least standard deviation of a sample, rad or m.
    pub floor: f64,
    /// Standard deviation of a sample of weight 1, where it is known.
    pub known: Option<f64>,
}

/// Noise of the process and of the samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Corner frequency of the smoother, rad/s: the noise of the process is q = ω_c^(2D) σ² h/(lever² slope²) for D
    /// integrations from the white noise to θ.
    pub corner: f64,
    /// Corner frequency of a smoother of order one whose noise is in g, over the spread of the speed, where u follows the
    /// speed, rad/s; 0 without.
    pub drift: f64,
    /// Variances of the harmonics of what repeats.
    pub spectrum: Option<Spectrum>,
    /// First-order autoregression of the samples' noise.
    pub correlated: Option<Autoregression>,
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// ln of the marginal likelihood.
    pub likelihood: f64,
}

impl Noise {
    /// White noise of the samples, and a corner frequency.
    pub fn white(corner: f64) -> Noise {
        Noise {
            corner,
            drift: 0.0,
            spectrum: None,
            correlated: None,
            sigma: 1.0,
            likelihood: f64::NEG_INFINITY,
        }
    }
}

/// Standard deviations of the start, in those that the first few samples alone would leave: so diffuse that they count for
/// 1e-6 of one sample, and so narrow that rounding keeps ten digits.
const DIFFUSE: f64 = 1e3;

impl Scales {
    /// Standard deviations of the state before the first sample, in σ.
    pub fn spread(&self) -> State {
        let mut size = DIFFUSE / self.slope;
        std::array::from_fn(|k| {
            let spread = size;
            size /= if k == 1 {
                self.spacing * self.lever
            } else {
                self.spacing
            };
            spread
        })
    }

    /// Least and largest corner frequency, rad/s.
    pub fn corners(&self) -> [f64; 2] {
        [0.1 / self.duration, 30.0 / self.spacing]
    }

    /// Spectral density of the process noise over σ².
    pub fn density(&self, corner: f64, order: usize) -> f64 {
        let integrations = i32::try_from(2 * (order + 2)).unwrap_or(10);
        corner.powi(integrations) * self.spacing / (self.lever * self.slope).powi(2)
    }
}

/// Correlated noise: a first-order autoregression beside the white noise of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Autoregression {
    /// Rate at which the correlation decays, 1/s.
    pub decay: f64,
    /// White part of the variance of a sample.
    pub white: f64,
}

/// White part of the variance of correlated noise.
const WHITE: f64 = 0.02;

impl Autoregression {
    /// First guesses for samples so far apart, s.
    pub fn guesses(spacing: f64) -> [Autoregression; 3] {
        [0.2, 1.0, 5.0].map(|steps| Autoregression {
            decay: 1.0 / (steps * spacing),
            white: WHITE,
        })
    }
}

/// A stretch of the record and the factor of the intensity of its noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// s
    pub from: f64,
    /// s
    pub to: f64,
    pub factor: f64,
}

/// How strong the noise of the process is along a record, beside its usual intensity.
#[derive(Clone, Debug, Default)]
pub(super) struct Intensities(pub Vec<Span>);

impl Intensities {
    /// The factor of the intensity at a time.
    pub fn at(&self, t: f64) -> f64 {
        let spans = self.0.iter().filter(|span| span.from < t && t < span.to);
        spans.map(|span| span.factor).product()
    }
}
