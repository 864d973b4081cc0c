//! The smoothed motion: Gauss-Newton iterations of the linear smoother about the last path (iterated extended smoother), the
//! prior chosen by marginal likelihood.

use super::likelihood::{Linear, Noise, Scales};
use super::problem::{Estimate, Problem};
use super::record::Path;
use super::residual_tests::Whiteness;
use super::state_space::{Prior, Unknown};
use crate::numeric::parallel;

/// A smoothed motion with its prior and noise.
#[derive(Clone, Debug)]
pub(super) struct Smoothed {
    pub prior: Prior,
    pub noise: Noise,
    pub scales: Scales,
    pub estimates: Vec<Estimate>,
    /// Whether the iterations came to rest.
    pub settled: bool,
}

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(super) const KINEMATIC: Prior = Prior {
    unknown: Unknown::Acceleration,
    order: 2,
    follows_speed: false,
};

/// Priors through the equation of motion.
pub(super) const MECHANICAL: [Prior; 5] = [
    Prior {
        unknown: Unknown::Torque,
        order: 2,
        follows_speed: true,
    },
    Prior {
        unknown: Unknown::Torque,
        order: 1,
        follows_speed: false,
    },
    Prior {
        unknown: Unknown::Torque,
        order: 2,
        follows_speed: false,
    },
    Prior {
        unknown: Unknown::Force,
        order: 1,
        follows_speed: false,
    },
    Prior {
        unknown: Unknown::Force,
        order: 2,
        follows_speed: false,
    },
];

/// Most iterations of Gauss and Newton.
const ITERATIONS: usize = 12;

/// Change of the path, in its standard errors, at which the iterations have come to rest.
const AT_REST: f64 = 0.01;

impl Problem<'_> {
    /// Root mean square of d measured/dθ.
    fn slope(&self, path: &Path) -> f64 {
        let stride = path.states.len().div_ceil(1000);
        let slopes = path.states.iter().step_by(stride);
        let slopes = slopes.map(|state| self.record.sensor.shown(state[0]).slope.powi(2));
        let (sum, count) = slopes
            .filter(|s| s.is_finite())
            .fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
        (sum / f64::max(count, 1.0)).sqrt()
    }

    /// The motion without mechanics, from a first path.
    pub fn kinematic(&self, mut path: Path, sigma: f64) -> Smoothed {
        let motion = self.motion(KINEMATIC);
        let slope = self.slope(&path);
        // The start of this prior is compared with others only once the motion is known.
        let mut shape = [1.0, 1.0];
        let mut best: Option<Smoothed> = None;
        let is_linear = self.record.is_linear();
        let mut sigma = sigma;
        for iteration in 0..ITERATIONS {
            let scales = self.scales(&motion, &path, slope, shape);
            let noise = match &best {
                Some(last) if iteration > 3 => last.noise,
                last => {
                    let stretches = self.stretches(&motion, &path, sigma);
                    let linear = Linear {
                        stretches: &stretches,
                        prior: KINEMATIC,
                        scales,
                    };
                    last.as_ref().map_or_else(
                        || linear.anywhere(),
                        |last| linear.maximised(last.noise.corner, None),
                    )
                }
            };
            let estimates = self.smoothed(&motion, &path, scales, &noise);
            let change = change(&estimates, &path);
            sigma = noise.sigma;
            path = Path {
                states: estimates.iter().map(|e| e.state).collect(),
                variances: (!is_linear)
                    .then(|| estimates.iter().map(|e| e.covariance[0]).collect()),
            };
            let rms = |k: usize| {
                (estimates.iter().map(|e| e.state[k].powi(2)).sum::<f64>() / estimates.len() as f64)
                    .sqrt()
            };
            shape = [rms(2).max(f64::MIN_POSITIVE), rms(3).max(f64::MIN_POSITIVE)];
            let settled = change < AT_REST || is_linear;
            best = Some(Smoothed {
                prior: KINEMATIC,
                noise,
                scales,
                estimates,
                settled,
            });
            // A second pass takes what is lost to rounding about a straight line.
            if change < AT_REST || is_linear && iteration > 0 {
                break;
            }
        }
        let Some(mut found) = best else {
            unreachable!("at least one iteration")
        };
        found.scales.motion = shape;
        found
    }

    /// The states of a prior along a smoothed motion.
    pub fn path_of(&self, prior: Prior, from: &Smoothed) -> Path {
        let r = self.equation.linkage().r;
        let states = parallel::list(from.estimates.len(), |k| {
            let [theta, omega, alpha] = from.estimates[k].motion;
            let terms = self.equation.terms(theta);
            let t = self.record.origin + self.grid.times[k];
            let known = self.equation.loads().value(t, theta, omega, &terms.pose);
            let torque = self.equation.generalized_force(&terms, omega, alpha)
                - known.generalized(&terms.pose);
            let dx = terms.pose.dx;
            let unknown = match prior.unknown {
                Unknown::Acceleration => alpha,
                Unknown::Torque => torque,
                Unknown::Force => torque * dx / (dx * dx + 0.01 * r * r),
            };
            [theta, omega, unknown, 0.0]
        });
        let variances = (!self.record.is_linear())
            .then(|| from.estimates.iter().map(|e| e.covariance[0]).collect());
        Path { states, variances }
    }

    /// A prior about a smoothed path.
    fn candidate(&self, prior: Prior, from: &Smoothed, correlated: bool) -> Candidate {
        let motion = self.motion(prior);
        let path = self.path_of(prior, from);
        let scales = self.scales(&motion, &path, from.scales.slope, from.scales.motion);
        let stretches = self.stretches(&motion, &path, from.noise.sigma);
        let linear = Linear {
            stretches: &stretches,
            prior,
            scales,
        };
        let mut noise = linear.maximised(from.noise.corner, None);
        if correlated {
            let found = linear.correlated(&noise);
            // Noise that leaves the path rougher than white noise does is motion.
            let rougher = found.corner > noise.corner;
            noise = if rougher { noise } else { found };
        }
        Candidate {
            prior,
            noise,
            scales,
            path,
        }
    }

    /// The smoothed motion with the likeliest prior, and all that were tried with the ln of their likelihoods, the likeliest
    /// first. Noise of the samples is correlated where the prediction errors say so, and the likelihood agrees.
    pub fn likeliest(&self, kinematic: Smoothed) -> (Smoothed, Vec<(Prior, f64)>) {
        let white = self.tried(&kinematic, false);
        let Some(found) = self.first_settled(&white) else {
            return (kinematic, listed(&white));
        };
        let innovations = found.estimates.iter().map(|e| e.innovation);
        let is_noise = found.noise.sigma > 1.5 * self.record.floor;
        if is_noise && Whiteness::of(innovations).is_violated() {
            let correlated = self.tried(&kinematic, true);
            // Two parameters more (Schwarz 1978).
            let cost = (self.record.times.len() as f64).ln();
            let gain = |tried: &[Candidate]| {
                tried
                    .first()
                    .map_or(f64::NEG_INFINITY, |c| c.noise.likelihood)
            };
            if gain(&correlated) > gain(&white) + cost
                && let Some(found) = self.first_settled(&correlated)
            {
                return (found, listed(&correlated));
            }
        }
        (found, listed(&white))
    }

    /// All priors about a path, the likeliest first.
    fn tried(&self, kinematic: &Smoothed, correlated: bool) -> Vec<Candidate> {
        let priors: Vec<Prior> = std::iter::once(KINEMATIC).chain(MECHANICAL).collect();
        let tried = parallel::map(priors.iter(), |prior| {
            Some(self.candidate(*prior, kinematic, correlated))
        });
        let mut tried: Vec<_> = tried.into_iter().flatten().collect();
        tried.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        tried
    }

    /// The smoothed motion with the first prior whose iterations come to rest.
    fn first_settled(&self, tried: &[Candidate]) -> Option<Smoothed> {
        let smoothed = tried.iter().map(|candidate| self.iterated(candidate));
        smoothed.into_iter().find(|found| found.settled)
    }

    /// The smoothed motion with a prior, about paths that approach it.
    fn iterated(&self, candidate: &Candidate) -> Smoothed {
        let Candidate {
            prior,
            mut noise,
            scales,
            mut path,
        } = candidate.clone();
        let motion = self.motion(prior);
        let mut result = Smoothed {
            prior,
            noise,
            scales,
            estimates: Vec::new(),
            settled: false,
        };
        for iteration in 0..ITERATIONS {
            // A path that has moved tells another noise, once.
            if iteration == 1 {
                let stretches = self.stretches(&motion, &path, noise.sigma);
                let linear = Linear {
                    stretches: &stretches,
                    prior,
                    scales,
                };
                noise = linear.maximised(noise.corner, noise.correlated);
                if prior.order == 2 && !prior.follows_speed {
                    noise = linear.with_level(&noise);
                }
            }
            let estimates = self.smoothed(&motion, &path, scales, &noise);
            let change = change(&estimates, &path);
            path.states = estimates.iter().map(|e| e.state).collect();
            if path.variances.is_some() {
                path.variances = Some(estimates.iter().map(|e| e.covariance[0]).collect());
            }
            (result.noise, result.estimates) = (noise, estimates);
            if change < AT_REST {
                result.settled = true;
                break;
            }
            if !change.is_finite() {
                break;
            }
        }
        result
    }
}

/// A prior with its noise, about a path.
#[derive(Clone, Debug)]
struct Candidate {
    prior: Prior,
    noise: Noise,
    scales: Scales,
    path: Path,
}

fn listed(tried: &[Candidate]) -> Vec<(Prior, f64)> {
    tried
        .iter()
        .map(|candidate| (candidate.prior, candidate.noise.likelihood))
        .collect()
}

/// Root mean square change of the crank angles in their standard errors.
fn change(estimates: &[Estimate], path: &Path) -> f64 {
    let changes = estimates
        .iter()
        .zip(&path.states)
        .map(|(estimate, before)| {
            let variance = estimate.covariance[0]
                .max((1e-14 * estimate.state[0]).powi(2))
                .max(f64::MIN_POSITIVE);
            (estimate.state[0] - before[0]).powi(2) / variance
        });
    (changes.sum::<f64>() / estimates.len() as f64).sqrt()
}
