//! The smoothed motion: Gauss-Newton iterations of the linear smoother about the last path (iterated extended smoother), the
//! prior chosen by marginal likelihood.

use std::ops::Range;

use super::estimate::Estimate;
use super::likelihood::Linear;
use super::prior::Prior;
use super::prior::{Candidate, KINEMATIC, LADDERS, TORQUE, likelihood, listed};
use super::problem::Problem;
use super::record::Path;
use super::residual_tests::Whiteness;
use super::scales::{Noise, Scales};
use super::state_space::Autoregression;
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
    /// The path of the states that were smoothed at all nodes, with their variances where the samples are curved in the crank
    /// angle.
    pub fn path(&self, is_curved: bool) -> Path {
        let variances = || variances(&self.estimates);
        let states = self.estimates.iter().map(|e| e.state);
        Path::whole(states.collect(), is_curved.then(variances))
    }
}

/// Most iterations of Gauss and Newton.
pub(super) const ITERATIONS: usize = 12;

/// No instrument tells an angle to the root of the rounding of doubles, rad: a record so exact was computed, and errs smoothly,
/// which a prior of order three would take for force.
const COMPUTED: f64 = 1.5e-8;

/// Change of the path, in its standard errors, at which the iterations have come to rest.
pub(super) const AT_REST: f64 = 0.05;

impl Problem<'_> {
    /// A motion that was smoothed at some of the nodes, smoothed at all with its noise, about paths from this first one.
    pub fn completed(&self, found: Smoothed, mut path: Path) -> Smoothed {
        if found.estimates.len() == self.grid.len() {
            return found;
        }
        let motion = self.motion(found.prior);
        let is_linear = found.prior == KINEMATIC && self.record.is_linear();
        let mut whole = Smoothed {
            settled: false,
            ..found
        };
        for _ in 0..ITERATIONS {
            // The former ones take their memory.
            whole.estimates = Vec::new();
            whole.estimates = self.smoothed(&motion, &path, whole.scales, &whole.noise);
            let change = path.moved(&whole.estimates);
            whole.settled = found.settled && (is_linear || change < AT_REST);
            if whole.settled || !change.is_finite() {
                break;
            }
        }
        whole
    }

    /// A prior about a smoothed path with its likeliest noise, from a first one; none where `least` says that it is not worth that.
    fn candidate_from(
        &self,
        prior: Prior,
        from: &Smoothed,
        first: Noise,
        least: f64,
        correlated: &[Autoregression],
    ) -> Option<Candidate> {
        let motion = self.motion(prior);
        let path = self.path_of(prior, from, self.sampled());
        let scales = self.scales(&motion, &path, from.scales.slope, from.scales.motion);
        let stretches = self.stretches(&motion, &path, from.noise.sigma);
        let linear = Linear {
            stretches: &stretches,
            prior,
            scales,
        };
        let first = linear.evaluated(first);
        if first.likelihood < least {
            return None;
        }
        let mut noise = linear.improved(first);
        if !correlated.is_empty() {
            let found = linear.correlated(&noise, correlated);
            // Noise that leaves the path rougher than white noise does is motion.
            let rougher = found.corner > noise.corner;
            noise = if rougher { noise } else { found };
        }
        Some(Candidate {
            prior,
            noise,
            scales,
        })
    }

    /// A prior about a smoothed path.
    fn candidate(&self, prior: Prior, from: &Smoothed, correlated: &[Autoregression]) -> Candidate {
        let first = Noise::white(from.noise.corner);
        let found = self.candidate_from(prior, from, first, f64::NEG_INFINITY, correlated);
        found.unwrap_or_else(|| unreachable!("any likelihood will do"))
    }

    /// The smoothed motion with the likeliest prior, and all that were tried with the ln of their likelihoods, the likeliest
    /// first. Noise of the samples is correlated where the prediction errors say so, and the likelihood agrees.
    pub fn likeliest(&self, kinematic: Smoothed) -> (Smoothed, Vec<(Prior, f64)>) {
        let white = self.tried(&kinematic, &[]);
        let Some(mut found) = self.first_settled(&white, &kinematic) else {
            return (kinematic, listed(&white));
        };
        let mut tried = listed(&white);
        let innovations = found.estimates.iter().map(|e| e.innovation);
        let is_noise = found.noise.sigma > 1.5 * self.record.floor && self.record.codes.is_none();
        if is_noise && Whiteness::of(innovations).is_violated() {
            // Two parameters more (Schwarz 1978).
            let least = likelihood(&white) + (self.record.times.len() as f64).ln();
            let guesses = Autoregression::guesses(found.scales.spacing);
            let first = self.candidate(found.prior, &kinematic, &guesses).noise;
            if let Some(guess) = first.correlated
                && first.likelihood > least
            {
                let correlated = self.tried(&kinematic, &[guess]);
                if let Some(other) = self.first_settled(&correlated, &kinematic) {
                    (found, tried) = (other, listed(&correlated));
                }
            }
        }
        let path = self.path_of(found.prior, &kinematic, self.all());
        (self.completed(found, path), tried)
    }

    /// ln of the marginal likelihood of the samples by the likeliest prior about a smoothed motion.
    pub fn evidence(&self, kinematic: &Smoothed) -> f64 {
        likelihood(&self.tried(kinematic, &[]))
    }

    /// Priors about a path, the likeliest first. The order of each unknown rises as long as its likelihood does.
    pub fn tried(&self, kinematic: &Smoothed, correlated: &[Autoregression]) -> Vec<Candidate> {
        let size = self.record.sensor.size();
        let is_computed = |noise: &Noise| noise.sigma < COMPUTED * size;
        // What repeats is noise that comes down: of what was computed there is none.
        let turns = match is_computed(&kinematic.noise) {
            true => 0.0,
            false => self.turns(kinematic),
        };
        let tried = parallel::map(LADDERS.iter(), |ladder| {
            let mut tried: Vec<Candidate> = Vec::new();
            for prior in *ladder {
                let next = self.candidate(*prior, kinematic, correlated);
                let before = tried
                    .last()
                    .map_or(f64::NEG_INFINITY, |c| c.noise.likelihood);
                let rises = next.noise.likelihood > before;
                let is_computed = is_computed(&next.noise);
                tried.push(next);
                if !rises || is_computed && prior.order == 2 {
                    break;
                }
            }
            tried
        });
        let mut tried: Vec<_> = tried.into_iter().flatten().collect();
        let repeating = self.repeating(turns, &tried, kinematic, correlated);
        tried.extend(repeating);
        tried.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        tried
    }

    /// Priors with a part that repeats, where that makes the samples likelier than its two parameters cost (Schwarz 1978) beside
    /// the torque as it is without.
    fn repeating(
        &self,
        turns: f64,
        tried: &[Candidate],
        kinematic: &Smoothed,
        correlated: &[Autoregression],
    ) -> Vec<Candidate> {
        let torque = tried.iter().find(|one| one.prior == TORQUE);
        let Some(Candidate { noise, .. }) = torque else {
            return Vec::new();
        };
        let least = noise.likelihood + (self.record.times.len() as f64).ln();
        let of_cycle = |cycle: u8| {
            let prior = Prior { cycle, ..TORQUE };
            let first = self.candidate_from(prior, kinematic, *noise, least, correlated)?;
            let prior = Prior { order: 2, ..prior };
            let next = self.candidate_from(prior, kinematic, first.noise, least, correlated);
            Some(std::iter::once(first).chain(next))
        };
        let cycles = [1, 2]
            .into_iter()
            .filter(|cycle| turns >= 2.0 * f64::from(*cycle));
        let found = parallel::map(cycles, of_cycle);
        found.into_iter().flatten().flatten().collect()
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
            let found = self.iterated(candidate, kinematic, self.sampled());
            if found.settled && found.noise.likelihood > before {
                best = Some(found);
            }
        }
        best
    }

    /// The smoothed motion with a prior at some ranges of nodes, about paths that approach it.
    pub fn iterated(
        &self,
        candidate: &Candidate,
        kinematic: &Smoothed,
        ranges: Vec<Range<usize>>,
    ) -> Smoothed {
        let Candidate {
            prior,
            mut noise,
            scales,
        } = *candidate;
        let mut path = self.path_of(prior, kinematic, ranges);
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
                    let level = 0.0;
                    noise = linear.renewed(Noise { level, ..noise });
                }
                if prior.follows_speed {
                    noise = linear.with_drift(noise);
                } else if prior.order >= 2 && iteration == 1 {
                    noise = linear.with_level(&noise);
                }
            }
            let estimates = self.smoothed(&motion, &path, scales, &noise);
            let change = path.moved(&estimates);
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

fn variances(estimates: &[Estimate]) -> Vec<f64> {
    estimates.iter().map(|e| e.covariance[0]).collect()
}

impl Path {
    /// Moves to the smoothed states; root mean square change of the crank angles in their standard errors.
    pub fn moved(&mut self, estimates: &[Estimate]) -> f64 {
        let change = change(estimates, self);
        self.states.clear();
        self.states.extend(estimates.iter().map(|e| e.state));
        if let Some(list) = &mut self.variances {
            *list = variances(estimates);
        }
        change
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
