//! Simpler models of a smoothed motion, where the samples are likelier with them: the likelihood has several maxima, and
//! the search began about a path without mechanics.

use super::candidates::Candidate;
use super::grid::Path;
use super::problem::Problem;
use super::scales::Noise;
use super::smoother::{Correction, PATH_AT_REST, Smoothed};

impl Problem<'_> {
    /// The cost of a correlation of the sample noise in ln of the likelihood.
    pub fn cost_of_correlation(&self, noise: &Noise) -> f64 {
        noise.correlated.map_or(0.0, |_| self.cost(2.0))
    }

    /// A smoothed motion without its part that repeats, where that no longer makes the samples likelier than it costs: about the
    /// first path it may have stood for what that path leaves out. The paths of a long record are those of its stretches.
    pub fn without_repeating(&self, found: Smoothed) -> Smoothed {
        if found.prior.cycle == 0 || self.sampled() != self.all() {
            return found;
        }
        let prior = found.prior.beside_known();
        let path = Path {
            repeating: None,
            ..found.path()
        };
        let linear = self.linear(prior, found.scales, &path, found.noise.sigma);
        let first = Noise {
            spectrum: None,
            ..found.noise
        };
        let candidate = linear.with(linear.with_corner(linear.begun(first)));
        let least = found.noise.likelihood;
        let likely = Some(candidate).filter(|one| one.noise.likelihood > least);
        let other = likely.map(|one| self.iterated(&one, path));
        let holds = |other: &Smoothed| other.converged && other.noise.likelihood > least;
        match other.filter(holds) {
            Some(other) => Smoothed {
                compared: found.compared,
                ..other
            },
            None => found,
        }
    }

    /// The motion to which a search comes from the path without process noise, for a torque that follows the speed: a path through
    /// the noise of the samples makes a noise of the torque likely, a part that repeats, or noise of the samples that is correlated.
    /// It is likelier than the motion found, or it is simpler and no less likely than that pays.
    pub fn without_process_noise(&self, found: &Smoothed) -> Option<Smoothed> {
        let prior = found.prior.beside_known();
        if prior.powers == 0 || self.sampled() != self.all() {
            return None;
        }
        let noise = Noise {
            sigma: found.noise.sigma,
            ..Noise::white(found.scales.corners()[0])
        };
        let mut path = Path {
            repeating: None,
            ..found.path()
        };
        let candidate = Candidate {
            prior,
            noise,
            ..found.candidate()
        };
        let mut correction = Correction::default();
        let likelihood = |path: &Path| {
            let linear = self.linear(prior, found.scales, path, noise.sigma);
            linear.evaluated(noise).likelihood
        };
        let is_simple = found.is_simple();
        let least = found.noise.likelihood - self.cost_of_correlation(&found.noise);
        let does_without = likelihood(&path) > least;
        if does_without && is_simple {
            return None;
        }
        // Such paths come to rest soon, or not at all.
        let most = if does_without { 0 } else { 6 };
        for _ in 0..most {
            let estimates = self.smoothed(&mut path, &candidate);
            let change = correction.taken(&mut path, &estimates);
            if change < PATH_AT_REST || !change.is_finite() {
                break;
            }
        }
        let least = if is_simple {
            found.noise.likelihood
        } else {
            least
        };
        let is_likely = likelihood(&path) > least;
        let other = is_likely.then(|| self.iterated(&candidate, path));
        other.filter(|other| other.converged && other.noise.likelihood > least)
    }
}

impl Smoothed {
    /// True without a part that repeats and without correlated noise.
    pub fn is_simple(&self) -> bool {
        self.prior.cycle == 0 && self.noise.correlated.is_none()
    }
}
