//! Priors about a smoothed path with the noise that makes the samples likeliest.

use std::ops::Range;

use super::grid::Path;
use super::harmonics::{Increments, ways};
use super::likelihood::Linear;
use super::maximum::{ENOUGH_RISE, SIGNIFICANT_RISE, better};
use super::prior::{LADDERS, Prior, SMOOTH, TORQUE};
use super::problem::Problem;
use super::scales::{Noise, Scales};
use super::smoother::Smoothed;
use super::state_space::Stretch;
use crate::numeric::parallel;

/// Harmonics of a turn at first; they are doubled as long as that makes the samples likelier.
const FIRST_HARMONICS: usize = 12;

/// A prior with its noise, about a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub prior: Prior,
    pub noise: Noise,
    pub scales: Scales,
}

impl Candidate {
    /// Returns what it is before its motion is smoothed at any node.
    pub fn unsmoothed(&self) -> Smoothed {
        Smoothed {
            prior: self.prior,
            noise: self.noise,
            scales: self.scales,
            estimates: Vec::new(),
            repeating: None,
            converged: true,
            compared: Vec::new(),
        }
    }
}

/// Returns ln of the likelihood of the likeliest candidate; the list has it first.
pub(super) fn likelihood(tried: &[Candidate]) -> f64 {
    let best = tried.first();
    best.map_or(f64::NEG_INFINITY, |best| best.noise.likelihood)
}

/// The linear model about a smoothed path: one for all orders of an unknown, whose derivatives are 0 along that path.
pub(super) struct About {
    prior: Prior,
    path: Path,
    stretches: Vec<Stretch>,
    scales: Scales,
    corner: f64,
}

impl About {
    fn linear(&self, prior: Prior) -> Linear<'_> {
        Linear {
            stretches: &self.stretches,
            prior,
            scales: self.scales,
        }
    }

    /// Returns ln of the likelihood of the prior without process noise.
    pub fn without_process_noise(&self) -> f64 {
        let none = Noise::white(0.0);
        self.linear(self.prior).evaluated(none).likelihood
    }

    /// A prior with its likeliest noise, from a first one; none where this is less likely than `least`.
    pub fn candidate(
        &self,
        prior: Prior,
        first: Noise,
        least: f64,
        correlated: &[f64],
    ) -> Option<Candidate> {
        let linear = self.linear(prior);
        let first = linear.begun(first);
        if first.likelihood < least {
            return None;
        }
        let mut noise = linear.improved(first);
        if !correlated.is_empty() {
            noise = linear.correlated(&noise, correlated);
        }
        Some(Candidate {
            prior,
            noise,
            scales: self.scales,
        })
    }
}

impl Problem<'_> {
    /// The linear model of a prior about a smoothed path.
    pub fn about(&self, prior: Prior, from: &Smoothed) -> About {
        let motion = self.motion(prior);
        let path = self.path_of(prior, from, self.sampled());
        About {
            prior,
            scales: Scales {
                motion: from.scales.motion,
                ..self.scales(&motion, &path, from.scales.slope, from.noise.sigma)
            },
            stretches: self.stretches(&motion, &path, from.noise.sigma),
            corner: from.noise.corner,
            path,
        }
    }

    /// Priors about a path, the likeliest first.
    pub fn tried(&self, kinematic: &Smoothed, correlated: &[f64]) -> Vec<Candidate> {
        let is_computed = self.record.is_computed();
        let tried = parallel::map(LADDERS.iter(), |ladder| {
            let about = self.about(ladder[0], kinematic);
            let first = Noise::white(about.corner);
            let of = |prior: &Prior| about.candidate(*prior, first, f64::NEG_INFINITY, correlated);
            let some = ladder
                .iter()
                .filter(|prior| is_computed || **prior != SMOOTH);
            (some.filter_map(of).collect::<Vec<_>>(), about)
        });
        let (tried, abouts): (Vec<_>, Vec<_>) = tried.into_iter().unzip();
        let mut tried: Vec<_> = tried.into_iter().flatten().collect();
        // What repeats is noise that comes down: of what was computed there is none.
        if !is_computed {
            tried.extend(self.repeating(self.turns(kinematic), &tried, &abouts, correlated));
        }
        tried.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        tried
    }

    /// Priors with a part that repeats every turn, where that makes the samples likelier than its two parameters cost (Schwarz 1978)
    /// beside the likeliest prior without.
    fn repeating(
        &self,
        turns: f64,
        tried: &[Candidate],
        abouts: &[About],
        correlated: &[f64],
    ) -> Vec<Candidate> {
        let torque = tried.iter().find(|one| one.prior == TORQUE);
        let torque = torque.filter(|_| turns >= 2.0);
        let Some(Candidate { noise, .. }) = torque else {
            return Vec::new();
        };
        let with = |prior: Prior, before: Noise, least: f64| {
            // The samples tell no more coefficients than there are samples, and the nodes no wave shorter than two of them.
            let waves = (prior.harmonics / usize::from(prior.cycle)) as f64;
            if self.is_stopped()
                || 2 * prior.coefficients() > self.record.times.len()
                || 2.0 * waves * turns > self.grid.len() as f64
            {
                return None;
            }
            let plain = Prior {
                powers: prior.powers,
                ..TORQUE
            };
            let about = abouts.iter().find(|about| about.prior == plain)?;
            let plain = tried.iter().find(|one| one.prior == plain)?;
            let before = Noise {
                spectrum: before.spectrum,
                ..better(before, plain.noise)
            };
            let about = About {
                prior,
                stretches: self.repeated(about, prior),
                path: about.path.clone(),
                ..*about
            };
            let next = about.candidate(prior, before, least, correlated)?;
            (next.noise.sigma > self.record.instrument_noise()).then_some(next)
        };
        let first = Prior {
            cycle: 1,
            harmonics: FIRST_HARMONICS,
            ..TORQUE
        };
        let cost = (self.record.times.len() as f64).ln();
        let mut found = Vec::from_iter(with(first, *noise, noise.likelihood + cost));
        // Forward selection: what is added stays where it makes the samples likelier.
        let mut extend = |rise: f64, by: fn(Prior) -> Prior| {
            let likelier =
                |Candidate { prior, noise, .. }| with(by(prior), noise, noise.likelihood + rise);
            let next = found.last().copied().and_then(likelier);
            found.extend(next);
            next.is_some()
        };
        extend(ENOUGH_RISE, |prior| Prior { powers: 1, ..prior });
        if turns >= 4.0 {
            extend(ENOUGH_RISE, |prior| Prior {
                cycle: 2,
                harmonics: 2 * prior.harmonics,
                ..prior
            });
        }
        while extend(SIGNIFICANT_RISE, |prior| Prior {
            harmonics: 2 * prior.harmonics,
            ..prior
        }) {}
        let without = tried.iter().map(|one| one.noise.likelihood);
        let least = without.fold(f64::NEG_INFINITY, f64::max) + cost;
        found.retain(|one| one.noise.likelihood > least);
        found
    }

    /// The stretches of a linear model, with what repeats in each step.
    fn repeated(&self, about: &About, prior: Prior) -> Vec<Stretch> {
        let pairs = self.sampled().into_iter().zip(&about.stretches);
        let with = |(range, stretch): (Range<usize>, &Stretch)| {
            let states = about.path.piece(&range).states;
            let steps = stretch.steps.clone();
            Stretch {
                increments: Increments::new(ways(states, &steps, about.path.speed()), prior),
                observed: stretch.observed.clone(),
                steps,
            }
        };
        parallel::map(pairs, with)
    }
}
