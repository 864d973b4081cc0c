//! Priors about a smoothed path with the noise that makes the samples likeliest.

mod with_repeating;

use std::ops::Range;

use super::grid::Path;
use super::likelihood::Linear;
use super::model::harmonics::{Increments, ways};
use super::model::prior::{LADDERS, Prior};
use super::model::state_space::Stretch;
use super::problem::Problem;
use super::rotation::Rotation;
use super::scales::{Noise, Scales};
use super::smoother::Smoothed;
use crate::numeric::parallel;

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

/// Returns the likelier of two priors.
fn likelier(a: Candidate, b: Candidate) -> Candidate {
    match b.noise.likelihood > a.noise.likelihood {
        true => b,
        false => a,
    }
}

/// Priors about a smoothed path, and the linear models by which they were compared.
pub(super) struct Tried {
    /// The likeliest first.
    pub candidates: Vec<Candidate>,
    abouts: Vec<About>,
}

impl Tried {
    fn new(mut candidates: Vec<Candidate>, abouts: Vec<About>) -> Tried {
        candidates.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        Tried { candidates, abouts }
    }

    /// The linear model of a prior.
    fn about(&self, prior: Prior) -> Option<&About> {
        let mut abouts = self.abouts.iter();
        abouts.find(|about| about.linear.prior.is_alike(prior))
    }

    /// Returns ln of the likelihood of the likeliest prior.
    pub fn likelihood(&self) -> f64 {
        let best = self.candidates.first();
        best.map_or(f64::NEG_INFINITY, |best| best.noise.likelihood)
    }
}

/// The linear model about a smoothed path: one for all priors that are alike, as along that path the derivatives of u are 0 and
/// the constants of its law do not change.
pub(super) struct About {
    pub linear: Linear,
    pub path: Path,
}

impl About {
    /// The linear model of a prior with the same steps.
    pub fn of(&self, prior: Prior) -> Linear {
        Linear {
            prior,
            ..self.linear.clone()
        }
    }

    /// The linear model of a torque with a part that repeats.
    pub fn repeating(&self, prior: Prior) -> Linear {
        let pairs = self.path.ranges.iter().zip(self.linear.stretches.iter());
        let with = |(range, stretch): (&Range<usize>, &Stretch)| {
            let states = self.path.part(range);
            let ways = ways(states, &stretch.steps, self.path.speed());
            Stretch {
                increments: Increments::new(ways, prior),
                ..stretch.clone()
            }
        };
        Linear {
            stretches: parallel::map(pairs, with).into(),
            ..Linear::of(prior, self.linear.scales)
        }
    }
}

impl Linear {
    /// The prior with its likeliest noise, from a first one; none where this is less likely than `least`.
    fn candidate(&self, first: Noise, least: f64) -> Option<Candidate> {
        let first = self.begun(first);
        (first.likelihood >= least).then(|| self.with(self.with_corner(first)))
    }

    /// A noise with hardly any noise of the process.
    fn quiet(&self, noise: Noise) -> Noise {
        Noise {
            corner: self.scales.corners()[0],
            speed_corner: 0.0,
            ..noise
        }
    }

    /// The prior with a noise.
    pub fn with(&self, noise: Noise) -> Candidate {
        Candidate {
            prior: self.prior,
            noise,
            scales: self.scales,
        }
    }

    /// The prior with the likeliest correlation of the sample noise beside its likeliest white noise.
    fn with_correlation(&self, white: &Candidate) -> Candidate {
        Candidate {
            noise: self.correlated(&white.noise),
            ..*white
        }
    }
}

impl Problem<'_> {
    /// The linear model of a prior, and of those that are alike, about a smoothed path.
    pub fn about(&self, prior: Prior, from: &Smoothed) -> About {
        let mut path = self.path_of(prior, from, self.sampled());
        // Other priors have their constants at other places of the state, where no step may change them.
        let first = path.states.first().copied().unwrap_or_default();
        for state in &mut path.states {
            let constants = prior.diffuse()..prior.states();
            state[constants.clone()].copy_from_slice(&first[constants]);
        }
        let scales = Scales {
            acceleration: from.scales.acceleration,
            ..self.scales(prior, &path, from.scales.slope, from.noise.sigma)
        };
        About {
            linear: self.linear(prior, scales, &path, from.noise.sigma),
            path,
        }
    }

    /// The cost of parameters in ln of the likelihood (Schwarz, Ann. Statist. 6 (1978) 461).
    pub fn cost(&self, parameters: f64) -> f64 {
        0.5 * parameters * self.single().counted().ln()
    }

    /// Priors without a part that repeats about a motion, with their likeliest noise from a corner frequency, rad/s.
    pub fn tried(&self, motion: &Smoothed, corner: f64) -> Tried {
        let abouts = parallel::map(LADDERS.iter(), |ladder| self.about(ladder[0], motion));
        let ladders = abouts.iter().zip(LADDERS);
        let pairs = ladders.flat_map(|(about, ladder)| ladder.iter().map(move |one| (about, one)));
        let passes = Rotation::of(motion.angles()).passes;
        let pairs = pairs.filter(|(_, prior)| prior.is_told_in(passes));
        let plain = parallel::map(pairs, |(about, prior)| {
            let first = match *prior == motion.prior {
                true => motion.noise,
                false => Noise::white(corner),
            };
            let linear = about.of(*prior);
            // A torque that follows the speed may need no process noise: the likelihood has two maxima.
            let quiet = (prior.powers > 0).then(|| linear.quiet(first));
            let starts = std::iter::once(first).chain(quiet);
            starts
                .filter_map(|first| linear.candidate(first, f64::NEG_INFINITY))
                .reduce(likelier)
        });
        Tried::new(plain.into_iter().flatten().collect(), abouts)
    }

    /// The priors with the likeliest correlation of the sample noise.
    pub fn correlated(&self, white: Tried, rotation: Rotation) -> Tried {
        let is_plain = |one: &&Candidate| one.prior.cycle == 0;
        let plain = parallel::map(white.candidates.iter().filter(is_plain), |one| {
            let about = white.about(one.prior);
            about.map_or(*one, |about| about.of(one.prior).with_correlation(one))
        });
        self.with_repeating(Tried::new(plain, white.abouts), rotation, true)
    }
}
