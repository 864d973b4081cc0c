//! Typical sizes along a record, and the noise that is estimated in terms of them.

use super::linearised::{Motion, State};
use super::problem::Problem;
use super::quantised::Codes;
use super::record::Path;
use super::regression::Spectrum;
use super::state_space::Autoregression;

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
    /// Corner frequency of a smoother of order one whose noise u has in it as well, rad/s; 0 without. Where u follows the
    /// speed, such noise is in g, over the spread of the speed.
    pub level: f64,
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
            level: 0.0,
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

impl Problem<'_> {
    /// Typical sizes along a path with a prior.
    pub fn scales(&self, motion: &Motion<'_>, path: &Path, slope: f64, shape: [f64; 2]) -> Scales {
        let times = &self.grid.times;
        let duration = times[times.len() - 1] - times[0];
        let samples = self.record.times.len() as f64;
        let stride = path.states.len().div_ceil(1000);
        let (mut lever, mut count) = (0.0, 0.0);
        for (node, state) in path.nodes().step_by(stride) {
            let rates = motion.rates(times[node], state);
            if rates.by_unknown.is_finite() {
                lever += rates.by_unknown * rates.by_unknown;
                count += 1.0;
            }
        }
        Scales {
            spacing: duration / (samples - 1.0),
            duration,
            slope,
            lever: (lever / count).sqrt(),
            motion: shape,
            speed: spread(path.states.iter().step_by(stride).map(|state| state[1])),
            floor: self.record.floor,
            known: self.record.codes.map(Codes::spread),
        }
    }
}

/// Standard deviation of numbers.
fn spread(numbers: impl Iterator<Item = f64>) -> f64 {
    let (mut count, mut mean, mut squares) = (0.0, 0.0, 0.0);
    for number in numbers {
        count += 1.0;
        let off = number - mean;
        mean += off / count;
        squares += off * (number - mean);
    }
    (squares / f64::max(count, 1.0))
        .sqrt()
        .max(f64::MIN_POSITIVE)
}
