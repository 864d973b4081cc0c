//! Moments of a normal distribution truncated to an interval, for expectation propagation over encoder codes.

/// Cavity distribution of a code, from all other samples: mean from the middle of the step, and variance, in steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cavity {
    pub mean: f64,
    pub variance: f64,
}

/// Site of a code, the normal distribution in its place: precision, and precision times mean from the middle, in steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Site {
    pub precision: f64,
    pub shift: f64,
}

impl Cavity {
    /// Returns ln of the probability of the code, and the site of equal moments; `jitter` of the ends in steps.
    pub fn matched(&self, jitter: f64) -> (f64, Site) {
        let variance = self.variance + jitter * jitter;
        let spread = variance.sqrt();
        let far = Site {
            precision: 1.0 / (1.0 / 12.0 + jitter * jitter),
            shift: 0.0,
        };
        let (a, b) = ((-0.5 - self.mean) / spread, (0.5 - self.mean) / spread);
        let [at_a, at_b] = [a, b].map(density);
        let probability = match a > 0.0 {
            true => tail(a) - tail(b),
            false => tail(-b) - tail(-a),
        };
        // A narrow step leaves a normal distribution already; a far one gives no more than its position.
        if 1.0 < NARROW * spread || probability < f64::MIN_POSITIVE.sqrt() {
            let off = self.mean * self.mean / (variance + 1.0 / 12.0);
            return (-0.5 * (off + (variance + 1.0 / 12.0).ln()) - 0.919, far);
        }
        let slope = (at_a - at_b) / (spread * probability);
        let bend = slope * slope + (b * at_b - a * at_a) / (variance * probability);
        let left = 1.0 - self.variance * bend;
        let precision = (bend / left).max(0.0);
        if !(precision.is_finite() && left > 0.0) {
            return (probability.ln(), far);
        }
        // Precision times (mean + slope/bend), without the quotient of two vanishing numbers.
        let shift = precision * self.mean + slope / left;
        (probability.ln(), Site { precision, shift })
    }
}

/// Width of a step over the standard deviation of the cavity, below which the step is narrow.
const NARROW: f64 = 0.3;

/// Returns the density of the standard normal distribution.
fn density(z: f64) -> f64 {
    (-0.5 * z * z).exp() * 0.398_942_280_401_432_7
}

/// Returns the probability that a standard normal variable exceeds z, by the continued fraction of Mills' ratio, near
/// zero by the series of the error function; relative error 1e-9.
fn tail(z: f64) -> f64 {
    if z < 0.0 {
        return 1.0 - tail(-z);
    }
    if z > 2.5 {
        // This number of terms leaves a relative error of 1e-10.
        let terms = 10 + (200.0 / (z * z)) as u32;
        let fraction = (1..=terms)
            .rev()
            .fold(0.0, |rest, k| f64::from(k) / (z + rest));
        return density(z) / (z + fraction);
    }
    let (mut term, mut sum) = (z, z);
    for k in 1..40 {
        term *= z * z / f64::from(2 * k + 1);
        sum += term;
        if term < 1e-12 * sum {
            break;
        }
    }
    0.5 - density(z) * sum
}

#[cfg(test)]
mod tests {
    use super::{Cavity, density};

    /// Moments of a normal distribution cut off at ±½, by the midpoint rule.
    #[test]
    fn a_code_leaves_the_moments_of_a_normal_distribution_that_is_cut_off() {
        for (mean, variance) in [(0.1f64, 0.04f64), (0.6, 0.1), (-0.4, 1.0), (0.0, 3.0)] {
            let mut moments = [0.0f64; 3];
            let count = 200_000;
            for k in 0..count {
                let at = -0.5 + (f64::from(k) + 0.5) / f64::from(count);
                let weight = density((at - mean) / variance.sqrt()) / variance.sqrt();
                moments[0] += weight / f64::from(count);
                moments[1] += at * weight / f64::from(count);
                moments[2] += at * at * weight / f64::from(count);
            }
            let middle = moments[1] / moments[0];
            let left = moments[2] / moments[0] - middle * middle;
            let (likelihood, site) = Cavity { mean, variance }.matched(0.0);
            assert!((likelihood - moments[0].ln()).abs() < 1e-7);
            let precision = 1.0 / variance + site.precision;
            assert!((1.0 / precision / left - 1.0).abs() < 1e-6, "{mean}");
            assert!(((mean / variance + site.shift) / precision - middle).abs() < 1e-6);
        }
    }
}
