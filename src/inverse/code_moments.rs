//! Codes of an encoder: each says that the crank is within one step, with the probability Φ((b − θ)/ε) − Φ((a − θ)/ε) for the
//! ends a, b of the step and their jitter ε. Expectation propagation (Minka 2001) puts a normal distribution in the place of
//! each such likelihood: the one with the moments that the code leaves of what all other samples say. Where the shaft is slow
//! the codes inside a step say nothing and the passages say much; where it is fast each is worth step²/12.

use super::likelihood::Linear;
use super::linearised::Prior;
use super::problem::Problem;
use super::quantised::Codes;
use super::record::Path;
use super::smoother::Smoothed;
use crate::numeric::parallel;

/// Jitters that are tried, in steps, and most samples by which one is chosen.
const JITTERS: [f64; 8] = [1e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0];
const ENOUGH: usize = 4000;

/// Part by which the normal distributions move towards the moments.
const DAMPING: f64 = 0.6;

/// What all other samples say of the angle at a code: mean from the middle of the step and variance, in steps.
#[derive(Clone, Copy, Debug)]
struct Cavity {
    mean: f64,
    variance: f64,
}

/// A normal distribution that stands for a code: precision, and that times the mean from the middle of the step, in steps.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Site {
    precision: f64,
    shift: f64,
}

impl Cavity {
    /// ln of the probability of the code, and the normal distribution of the same moments in its place.
    fn matched(&self, jitter: f64) -> (f64, Site) {
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
        // What a narrow step leaves is a normal distribution already; one that is far away says no more than its place.
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
        // λ times (mean + slope/bend), without a quotient of two that vanish.
        let shift = precision * self.mean + slope / left;
        (probability.ln(), Site { precision, shift })
    }
}

/// Width of a step over the spread of what the others say, below which the step is narrow.
const NARROW: f64 = 0.3;

/// The density of the standard normal distribution.
fn density(z: f64) -> f64 {
    (-0.5 * z * z).exp() * 0.398_942_280_401_432_7
}

/// The probability that a standard normal variable is beyond z, by the continued fraction of Mills' ratio, and by the series
/// of the error function near zero; right to 1e-9 of itself.
fn tail(z: f64) -> f64 {
    if z < 0.0 {
        return 1.0 - tail(-z);
    }
    if z > 2.5 {
        let fraction = (1..=40)
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

/// Moves the normal distributions that stand for the codes towards the moments about a smoothed motion; the largest change
/// of a precision, in those of a step.
fn propagate(problem: &mut Problem<'_>, smoothed: &Smoothed) -> f64 {
    let Some(codes) = problem.record.codes.clone() else {
        return 0.0;
    };
    let step = codes.step;
    // σ of the record is a step over √12.
    let unit = 12.0;
    let record = &problem.record;
    let before = |i: usize| Site {
        precision: record.weights[i] * unit,
        shift: record.weights[i] * unit * (record.values[i] - codes.values[i]) / step,
    };
    let cavity = |i: usize| {
        let estimate = problem.at_sample(&smoothed.estimates, i);
        let (precision, site) = (step * step / estimate.covariance[0], before(i));
        // What is left of almost nothing is rounding.
        let left = (precision - site.precision).max(1e-6 * precision);
        let mean = (estimate.state[0] - codes.values[i]) / step;
        Cavity {
            mean: (precision * mean - site.shift) / left,
            variance: 1.0 / left,
        }
    };
    let cavities = parallel::list(codes.values.len(), cavity);
    let some = || {
        let some = cavities.iter().step_by(cavities.len().div_ceil(ENOUGH));
        some.filter(|cavity| !cavity.mean.is_nan())
    };
    let likelihood = |jitter: f64| some().map(|c| c.matched(jitter).0).sum::<f64>();
    let jitter = JITTERS
        .map(|jitter| (likelihood(jitter), jitter))
        .into_iter()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(JITTERS[0], |(_, jitter)| jitter);
    let moved = parallel::list(cavities.len(), |i| {
        if cavities[i].mean.is_nan() {
            return before(i);
        }
        let (was, next) = (before(i), cavities[i].matched(jitter).1);
        let between = |a: f64, b: f64| a + DAMPING * (b - a);
        Site {
            precision: between(was.precision, next.precision),
            shift: between(was.shift, next.shift),
        }
    });
    let mut change = 0.0f64;
    for (i, site) in moved.into_iter().enumerate() {
        if cavities[i].mean.is_nan() {
            continue;
        }
        let weight = site.precision / unit;
        let off = match site.precision > 0.0 {
            true => site.shift / site.precision,
            false => 0.0,
        };
        change = change.max((weight - problem.record.weights[i]).abs() / (1.0 + weight));
        problem.record.weights[i] = weight;
        problem.record.values[i] = codes.values[i] + off * step;
    }
    change
}

/// Most rounds of expectation propagation, those between two estimates of the noise of the motion, and the change of a code's
/// weight at which they end.
const ROUNDS: usize = 16;
const SOME: usize = 4;
const STILL: f64 = 0.01;

impl Smoothed {
    /// The path of the smoothed states.
    fn path(&self) -> Path {
        Path {
            states: self.estimates.iter().map(|e| e.state).collect(),
            variances: None,
        }
    }
}

impl Problem<'_> {
    /// Codes whose steps are wider than the noise about a motion, if the samples are such.
    pub fn coded(&self, smoothed: &Smoothed) -> Option<Codes> {
        let record = &self.record;
        if !record.is_linear() {
            return None;
        }
        let mut codes = Codes::of(&record.values, record.digits)?;
        for sample in record.outliers() {
            codes.values[sample] = f64::NAN;
        }
        (smoothed.noise.sigma < codes.step).then_some(codes)
    }

    /// A smoothed motion about which the normal distributions that stand for codes have come to rest.
    pub fn propagated(&mut self, mut smoothed: Smoothed) -> Smoothed {
        let known = self.record.codes.as_ref().map(Codes::spread);
        smoothed.scales.known = known;
        smoothed.noise.sigma = known.unwrap_or(smoothed.noise.sigma);
        let motion = self.motion(smoothed.prior);
        for round in 0..ROUNDS {
            let change = propagate(self, &smoothed);
            let path = smoothed.path();
            // The noise of the motion follows codes that hardly move.
            if round % SOME == SOME - 1 {
                let linear = Linear {
                    stretches: &self.stretches(&motion, &path, smoothed.noise.sigma),
                    prior: smoothed.prior,
                    scales: smoothed.scales,
                };
                smoothed.noise = linear.renewed(smoothed.noise);
            }
            smoothed.estimates = self.smoothed(&motion, &path, smoothed.scales, &smoothed.noise);
            if change < STILL {
                break;
            }
        }
        smoothed
    }

    /// The smoothed motion with the likeliest prior; by what that makes of the codes the priors are compared once more.
    pub fn likeliest_of_codes(&mut self, kinematic: Smoothed) -> (Smoothed, Vec<(Prior, f64)>) {
        let path = kinematic.path();
        let sigma = kinematic.noise.sigma;
        let (smoothed, _) = self.likeliest(kinematic);
        self.propagated(smoothed);
        let kinematic = self.kinematic(path, sigma);
        let (smoothed, candidates) = self.likeliest(kinematic);
        (self.propagated(smoothed), candidates)
    }
}

#[cfg(test)]
mod tests {
    use super::{Cavity, density, tail};

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

    /// Q(1), Q(3) and Q(6) of Abramowitz and Stegun, table 26.1 and 26.2.
    #[test]
    fn tails_of_the_normal_distribution() {
        for (z, exact) in [
            (1.0, 0.158_655_253_931_457_05),
            (3.0, 1.349_898_031_630_094_6e-3),
            (6.0, 9.865_876_450_376_98e-10),
        ] {
            assert!((tail(z) / exact - 1.0).abs() < 1e-9, "{z}");
            assert!((tail(-z) - 1.0 + exact).abs() < 1e-9);
        }
    }
}
