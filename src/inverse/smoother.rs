//! The smoothed motion: Gauss-Newton iterations of the linear smoother about the last path (iterated extended smoother), the
//! prior chosen by marginal likelihood.

use super::likelihood::Linear;
use super::linearised::Prior;
use super::prior::{Candidate, KINEMATIC, LADDERS, likelihood, listed};
use super::problem::{Estimate, Problem};
use super::record::Path;
use super::residual_tests::Whiteness;
use super::scales::{Noise, Scales};
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

impl Smoothed {
    /// The path of the smoothed states, with their variances where the samples are curved in the crank angle.
    pub fn path(&self, is_curved: bool) -> Path {
        let variances = || self.estimates.iter().map(|e| e.covariance[0]).collect();
        Path {
            states: self.estimates.iter().map(|e| e.state).collect(),
            variances: is_curved.then(variances),
        }
    }
}

/// Most iterations of Gauss and Newton.
const ITERATIONS: usize = 12;

/// First standard deviation of a sample over the way between two, and the factor by which it is lowered: the prior of the start
/// is then as wide as that way.
const LARGE: f64 = 1e-3;

/// Nodes from which on one pass is enough where the model is linear.
const MANY: usize = 100_000;

/// Change of the path, in its standard errors, at which the iterations have come to rest.
pub(super) const AT_REST: f64 = 0.05;

impl Problem<'_> {
    /// The motion without mechanics, from a first path.
    pub fn kinematic(&self, mut path: Path, sigma: f64) -> Smoothed {
        let motion = self.motion(KINEMATIC);
        let slope = self.slope(&path);
        // The start of this prior is compared with others only once the motion is known.
        let mut shape = [1.0, 1.0];
        let mut best: Option<Smoothed> = None;
        let is_linear = self.record.is_linear();
        let mut sigma = sigma;
        // The prior of the start is so many σ wide: a σ that is large at first, and lowered, makes it wide enough.
        let mut floor = LARGE * slope * self.way();
        for iteration in 0..ITERATIONS {
            floor = floor.max(self.record.floor);
            let scales = Scales {
                floor,
                ..self.scales(&motion, |node| path.states[node], slope, shape)
            };
            let noise = match &best {
                Some(last) if iteration > 6 => last.noise,
                last => {
                    let stretches = self.stretches(&motion, &path, sigma);
                    let linear = Linear {
                        stretches: &stretches,
                        prior: KINEMATIC,
                        scales,
                    };
                    match last {
                        Some(last) => linear.maximised(last.noise.corner, None),
                        None => linear.anywhere(),
                    }
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
            let lowered = floor <= self.record.floor || noise.sigma > 3.0 * floor;
            let settled = lowered && (change < AT_REST || is_linear);
            best = Some(Smoothed {
                prior: KINEMATIC,
                noise,
                scales,
                estimates,
                settled,
            });
            // A second pass takes what is lost to rounding about a straight line.
            let many = self.grid.len() > MANY;
            if settled && (!is_linear || iteration > 0 || many) {
                break;
            }
            if !lowered {
                floor *= LARGE;
            }
        }
        let Some(mut found) = best else {
            unreachable!("at least one iteration")
        };
        found.scales.motion = shape;
        found.scales.floor = self.record.floor;
        found
    }

    /// A prior about a smoothed path.
    fn candidate(&self, prior: Prior, from: &Smoothed, correlated: bool) -> Candidate {
        let motion = self.motion(prior);
        let path = self.path_of(prior, from, &self.sampled());
        let state = |node: usize| self.state_of(prior, from, node);
        let scales = self.scales(&motion, state, from.scales.slope, from.scales.motion);
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
        }
    }

    /// The smoothed motion with the likeliest prior, and all that were tried with the ln of their likelihoods, the likeliest
    /// first. Noise of the samples is correlated where the prediction errors say so, and the likelihood agrees.
    pub fn likeliest(&self, kinematic: Smoothed) -> (Smoothed, Vec<(Prior, f64)>) {
        let white = self.tried(&kinematic, false);
        let Some(found) = self.first_settled(&white, &kinematic) else {
            return (kinematic, listed(&white));
        };
        let innovations = found.estimates.iter().map(|e| e.innovation);
        let is_noise = found.noise.sigma > 1.5 * self.record.floor && self.record.codes.is_none();
        if is_noise && Whiteness::of(innovations).is_violated() {
            let correlated = self.tried(&kinematic, true);
            // Two parameters more (Schwarz 1978).
            let cost = (self.record.times.len() as f64).ln();
            if likelihood(&correlated) > likelihood(&white) + cost
                && let Some(found) = self.first_settled(&correlated, &kinematic)
            {
                return (found, listed(&correlated));
            }
        }
        (found, listed(&white))
    }

    /// ln of the marginal likelihood of the samples by the likeliest prior about a smoothed motion.
    pub fn evidence(&self, kinematic: &Smoothed) -> f64 {
        likelihood(&self.tried(kinematic, false))
    }

    /// Priors about a path, the likeliest first. The order of each unknown rises as long as its likelihood does.
    pub fn tried(&self, kinematic: &Smoothed, correlated: bool) -> Vec<Candidate> {
        let tried = parallel::map(LADDERS.iter(), |ladder| {
            let mut tried: Vec<Candidate> = Vec::new();
            for prior in *ladder {
                let next = self.candidate(*prior, kinematic, correlated);
                let before = tried
                    .last()
                    .map_or(f64::NEG_INFINITY, |c| c.noise.likelihood);
                let rises = next.noise.likelihood > before;
                tried.push(next);
                if !rises {
                    break;
                }
            }
            tried
        });
        let mut tried: Vec<_> = tried.into_iter().flatten().collect();
        tried.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        tried
    }

    /// The likeliest smoothed motion of those whose iterations come to rest. About the path that they come to, a prior may be less
    /// likely than about the first one.
    fn first_settled(&self, tried: &[Candidate], kinematic: &Smoothed) -> Option<Smoothed> {
        let mut best: Option<Smoothed> = None;
        for candidate in tried {
            let before = best
                .as_ref()
                .map_or(f64::NEG_INFINITY, |b| b.noise.likelihood);
            if before >= candidate.noise.likelihood {
                break;
            }
            let found = self.iterated(candidate, kinematic);
            if found.settled && found.noise.likelihood > before {
                best = Some(found);
            }
        }
        best
    }

    /// The smoothed motion with a prior, about paths that approach it.
    pub fn iterated(&self, candidate: &Candidate, kinematic: &Smoothed) -> Smoothed {
        let Candidate {
            prior,
            mut noise,
            scales,
        } = *candidate;
        let all = 0..self.grid.len();
        let mut path = self.path_of(prior, kinematic, std::slice::from_ref(&all));
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
            if iteration <= 1 {
                let stretches = self.stretches(&motion, &path, noise.sigma);
                let linear = Linear {
                    stretches: &stretches,
                    prior,
                    scales,
                };
                if iteration == 1 {
                    noise = linear.maximised(noise.corner, noise.correlated);
                }
                if prior.follows_speed {
                    noise = linear.with_drift(noise);
                } else if prior.order >= 2 && iteration == 1 {
                    noise = linear.with_level(&noise);
                }
            }
            // The former ones take their memory.
            result.estimates = Vec::new();
            let estimates = self.smoothed(&motion, &path, scales, &noise);
            let change = change(&estimates, &path);
            path.states = estimates.iter().map(|e| e.state).collect();
            if path.variances.is_some() {
                path.variances = Some(estimates.iter().map(|e| e.covariance[0]).collect());
            }
            (result.noise, result.estimates) = (noise, estimates);
            // The noise of the second iteration has in it what makes the band hold.
            if change < AT_REST && (iteration > 0 || prior.order == 1) {
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

/// Root mean square change of the crank angles in their standard errors.
pub(super) fn change(estimates: &[Estimate], path: &Path) -> f64 {
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
