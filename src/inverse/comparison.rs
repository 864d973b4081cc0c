//! Comparison of priors by marginal likelihood. The model is not linear: about a path that misses part of the motion, as one without
//! mechanics does where samples are few, other priors are likely than about the motion that is found.

use super::candidates::{Candidate, Tried};
use super::maximum::{ENOUGH_RISE, SIGNIFICANT_RISE};
use super::problem::Problem;
use super::residual_tests::Whiteness;
use super::rotation::Rotation;
use super::smoother::Smoothed;

/// Priors that were compared about a motion.
struct Compared {
    about: Smoothed,
    tried: Tried,
    /// The motion with the likeliest of them.
    best: Option<Smoothed>,
}

impl Compared {
    /// Returns the motion whose likelihood rises as its path moves: priors are compared about that one again.
    fn moved(&self, before: f64) -> Option<&Smoothed> {
        let least = self.tried.likelihood().max(before) + SIGNIFICANT_RISE;
        let best = self.best.as_ref();
        best.filter(|best| best.noise.likelihood > least)
    }

    fn likelihood(&self) -> f64 {
        likelihood(self.best.as_ref())
    }
}

/// Returns ln of the likelihood of a motion.
fn likelihood(motion: Option<&Smoothed>) -> f64 {
    motion.map_or(f64::NEG_INFINITY, |motion| motion.noise.likelihood)
}

impl Problem<'_> {
    /// The likeliest smoothed motion, from a first one, of noise that is `suspected` to be correlated or not.
    pub fn likeliest(
        &mut self,
        kinematic: &Smoothed,
        first: &Smoothed,
        suspected: bool,
    ) -> Smoothed {
        if let Some(codes) = self.record.codes {
            return self.likeliest_of_codes(codes, kinematic);
        }
        let found = self.likeliest_from(first, suspected);
        // Means of fewer samples come first.
        if self.finer(&found, kinematic).is_some() {
            return found;
        }
        let path = self.path_of(found.prior, kinematic, self.all());
        self.completed(found, path, true)
    }

    /// The smoothed motion with the likeliest prior, from a first one. Noise of the samples is correlated where that is
    /// suspected or the prediction errors say so, and the likelihood agrees.
    fn likeliest_from(&self, first: &Smoothed, suspected: bool) -> Smoothed {
        let rotation = Rotation::of(first.angles());
        let Compared { about, tried, best } = self.compared(first, rotation);
        let Some(found) = best else {
            return Smoothed {
                compared: tried.candidates,
                ..about
            };
        };
        let innovations = found.estimates.iter().map(|e| e.innovation);
        let is_noise = self.record.codes.is_none() && !self.is_computed();
        if !is_noise || !suspected && !Whiteness::of(innovations).is_violated() {
            return found;
        }
        let cost = self.cost(2.0);
        let least = tried.likelihood() + cost;
        let correlated = self.correlated(tried, rotation);
        let is_likelier = correlated.likelihood() > least;
        let other = is_likelier.then(|| self.first_converged(&correlated.candidates, &about, None));
        let gain = |other: &Smoothed| other.noise.likelihood - found.noise.likelihood;
        let other = other.flatten().filter(|other| gain(other) > cost);
        other.unwrap_or(found)
    }

    /// Compares all priors. A part that repeats may stand for what a path misses: it comes after the others, and they are compared
    /// with it about its own path.
    fn compared(&self, first: &Smoothed, rotation: Rotation) -> Compared {
        let mut plain = self.plain(first.clone(), first.noise.corner);
        let mut before = f64::NEG_INFINITY;
        loop {
            let Compared { about, tried, best } = plain;
            let corner = best.as_ref().unwrap_or(&about).noise.corner;
            let tried = self.with_repeating(tried, rotation, false);
            let best = self.first_converged(&tried.candidates, &about, best);
            let all = Compared { about, tried, best };
            let moved = all.moved(before).filter(|best| best.prior.cycle > 0);
            let Some(moved) = moved else {
                return all;
            };
            before = moved.noise.likelihood;
            plain = self.plain(moved.clone(), corner);
            if plain.likelihood() < before {
                return all;
            }
        }
    }

    /// Compares priors without a part that repeats about a motion, from a first corner frequency of their noise, rad/s, then about
    /// the motion with the likeliest of them.
    fn plain(&self, mut about: Smoothed, mut corner: f64) -> Compared {
        let mut before = f64::NEG_INFINITY;
        loop {
            let tried = self.tried(&about, corner);
            let best = self.first_converged(&tried.candidates, &about, None);
            let all = Compared { about, tried, best };
            let Some(moved) = all.moved(before) else {
                return all;
            };
            (before, corner) = (moved.noise.likelihood, moved.noise.corner);
            about = moved.clone();
        }
    }

    /// A motion, or with the likeliest prior among its own without a part that repeats: a pulse is no change of intensity, but jumps
    /// may look like harmonics.
    pub fn likeliest_plain(&self, of: &Smoothed) -> Option<Smoothed> {
        if of.prior.cycle == 0 {
            return Some(of.clone());
        }
        let plain = of.compared.iter().filter(|one| one.prior.cycle == 0);
        self.first_converged(&Vec::from_iter(plain.copied()), of, None)
    }

    /// Compares all priors about a motion.
    pub fn all_tried(&self, motion: &Smoothed) -> Tried {
        let plain = self.tried(motion, motion.noise.corner);
        self.with_repeating(plain, Rotation::of(motion.angles()), false)
    }

    /// The likeliest smoothed motion of those whose iterations come to rest, and of one that is known. About the path that they come
    /// to, a prior may be less likely than about the first one.
    fn first_converged(
        &self,
        tried: &[Candidate],
        about: &Smoothed,
        mut best: Option<Smoothed>,
    ) -> Option<Smoothed> {
        for candidate in tried {
            let before = likelihood(best.as_ref());
            if before + ENOUGH_RISE >= candidate.noise.likelihood {
                break;
            }
            let path = self.path_of(candidate.prior, about, self.sampled());
            let found = self.iterated(candidate, path);
            if found.converged && found.noise.likelihood > before {
                best = Some(found);
            }
        }
        best.map(|best| Smoothed {
            compared: tried.to_vec(),
            ..best
        })
    }
}
