//! Priors with a part that repeats every turn, or in each swing: forward selection by the likelihood.

use std::f64::consts::PI;

use super::super::likelihood::Linear;
use super::super::maximum::{ENOUGH_RISE, SIGNIFICANT_RISE, better};
use super::super::model::prior::{FOLLOWING, High, Prior, TORQUE};
use super::super::problem::Problem;
use super::super::rotation::Rotation;
use super::super::scales::Noise;
use super::super::weighed::LEAST_LOG_ODDS;
use super::{Candidate, Tried, likelier};

/// Harmonics of a turn at first; they are doubled as long as that makes the samples likelier.
const FIRST_HARMONICS: usize = 12;

/// Search beside the priors without a part that repeats.
struct Search<'a> {
    problem: &'a Problem<'a>,
    rotation: Rotation,
    tried: &'a Tried,
    is_correlated: bool,
}

impl Problem<'_> {
    /// The priors beside those with a part that repeats, where that may count beside the same prior without.
    pub fn with_repeating(&self, tried: Tried, rotation: Rotation, is_correlated: bool) -> Tried {
        // What repeats is noise that comes down: of what was computed there is none.
        if self.is_computed() || rotation.passes < 2.0 {
            return tried;
        }
        let search = Search {
            problem: self,
            rotation,
            tried: &tried,
            is_correlated,
        };
        let found = search.run();
        Tried::new([tried.candidates, found].concat(), tried.abouts)
    }
}

impl Search<'_> {
    /// Returns the priors that were found, the likeliest last.
    fn run(&self) -> Vec<Candidate> {
        let Some(plain) = self.plain() else {
            return Vec::new();
        };
        let about = self.tried.about(plain.prior);
        let high = about.map(|about| about.standing_out(plain, FIRST_HARMONICS));
        let mut found = self.first(plain, high.unwrap_or_default());
        if plain.prior.powers == 0 {
            found.extend(found.last().and_then(|one| self.followed(one)));
        }
        // What is added stays where it makes the samples likelier.
        let mut extend = |rise: f64, by: fn(Prior) -> Prior| {
            let next = |Candidate { prior, noise, .. }: Candidate| {
                self.with(by(prior), noise, noise.likelihood + rise)
            };
            let next = found.last().copied().and_then(next);
            found.extend(next);
            next.is_some()
        };
        if self.rotation.turns >= 4.0 {
            extend(ENOUGH_RISE, Prior::over_two_turns);
        }
        while extend(SIGNIFICANT_RISE, Prior::with_twice_the_harmonics) {}
        found
    }

    fn of(&self, prior: Prior) -> Option<&Candidate> {
        let mut candidates = self.tried.candidates.iter();
        candidates.find(|one| one.prior == prior)
    }

    /// Returns the prior to begin with: a part that follows the speed is tried at once where the samples show it without what repeats.
    fn plain(&self) -> Option<&Candidate> {
        let torque = self.of(TORQUE)?;
        let least = torque.noise.likelihood + SIGNIFICANT_RISE;
        let following = self.of(FOLLOWING);
        following
            .filter(|following| following.noise.likelihood > least)
            .or(Some(torque))
    }

    /// Returns the priors with the first harmonics, the likelier last: what repeats may stand for a part that follows the speed.
    fn first(&self, plain: &Candidate, high: High) -> Vec<Candidate> {
        let first = Prior {
            cycle: 1,
            harmonics: FIRST_HARMONICS,
            high,
            ..plain.prior
        };
        let least = plain.noise.likelihood + LEAST_LOG_ODDS;
        let mut found = Vec::from_iter(self.with(first, plain.noise, least));
        if first.powers > 0 {
            let before = Noise {
                speed_corner: 0.0,
                ..found.last().unwrap_or(plain).noise
            };
            let least = before.likelihood + LEAST_LOG_ODDS;
            found.extend(self.with(Prior { powers: 0, ..first }, before, least));
            found.sort_by(|a, b| a.noise.likelihood.total_cmp(&b.noise.likelihood));
        }
        found
    }

    /// Returns a prior beside a part that follows the speed, if that is likelier: from its noise, and from hardly any.
    fn followed(&self, of: &Candidate) -> Option<Candidate> {
        let prior = Prior {
            powers: 1,
            ..of.prior
        };
        let quiet = Linear::of(of.prior, of.scales).quiet(of.noise);
        let least = of.noise.likelihood + ENOUGH_RISE;
        let starts = [of.noise, quiet].into_iter();
        starts
            .filter_map(|from| self.with(prior, from, least))
            .reduce(likelier)
    }

    /// Returns a prior with its likeliest noise from a first one; none where that is less likely than `least`.
    fn with(&self, prior: Prior, before: Noise, least: f64) -> Option<Candidate> {
        let record = &self.problem.record;
        // The samples tell no more coefficients than there are samples, and the nodes no wave shorter than two of them.
        if self.problem.is_stopped()
            || 2.0 * prior.coefficients() as f64 > record.counted()
            || prior.waves() * self.rotation.step > PI
        {
            return None;
        }
        let plain = self.of(Prior {
            powers: prior.powers,
            ..TORQUE
        })?;
        let before = Noise {
            spectrum: before.spectrum,
            ..better(before, plain.noise)
        };
        let linear = self.tried.about(plain.prior)?.repeating(prior);
        let mut next = linear.candidate(before, least)?;
        if self.is_correlated {
            next = linear.with_correlation(&next);
        }
        (next.noise.sigma > record.instrument_noise()).then_some(next)
    }
}
