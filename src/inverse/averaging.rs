//! Band over all priors and intensities of the process noise: few samples hardly tell whether a torque is steady or varies below
//! their noise, and the likeliest intensity may be none at all. The motion stays the likeliest one; its covariance is the mean by
//! posterior probability, with the squares of what each makes of the motion (Hoeting et al., Statist. Sci. 14 (1999) 382). The
//! standard deviation of the process noise has a uniform prior (Gelman, Bayesian Analysis 1 (2006) 515).

use super::candidates::Candidate;
use super::likelihood::Linear;
use super::maximum::FIRST_STEP;
use super::problem::Problem;
use super::scales::Noise;
use super::selection::counts;
use super::smoother::Smoothed;
use super::weighed::{LEAST_LOG_ODDS, Weighed, counting, on_both_sides};
use crate::numeric::parallel;

/// What a prior with one intensity makes of the motion.
struct Model {
    /// Posterior probability, up to a constant.
    weight: f64,
    /// Mean squares of its deviations from the likeliest motion at all nodes, as a covariance has them.
    squares: Vec<[f64; 6]>,
}

impl Problem<'_> {
    /// Returns a smoothed motion with its band over all priors and intensities of the process noise. A long record tells its
    /// own.
    pub fn averaged(&self, mut smoothed: Smoothed) -> Smoothed {
        if self.sampled() != self.all() {
            return self.with_errors_of_tones(smoothed);
        }
        let linear = self.about_itself(&smoothed);
        if smoothed.prior.cycle > 0 {
            let mut path = smoothed.path();
            smoothed.estimates = self.smoothed_along(&mut path, &linear, &smoothed.noise);
            smoothed.repeating = path.repeating;
        }
        let mut models = self.over_intensities(&linear, &smoothed, &smoothed, 0.0);
        for other in smoothed.contenders() {
            let path = self.path_of(other.prior, &smoothed, self.all());
            let mut found = self.completed(other.unsmoothed(), path, false);
            if found.converged && found.is_finite() {
                let linear = self.about_itself(&found);
                // The path by which priors were compared may be far from theirs.
                found.noise = linear.evaluated(found.noise);
                let odds = (found.noise.likelihood - smoothed.noise.likelihood).min(0.0);
                models.extend(self.over_intensities(&linear, &found, &smoothed, odds));
            }
        }
        let total: f64 = models.iter().map(|model| model.weight).sum();
        for (node, estimate) in smoothed.estimates.iter_mut().enumerate() {
            estimate.covariance = [0.0; 6];
            for Model { weight, squares } in &models {
                let pairs = estimate.covariance.iter_mut().zip(squares[node]);
                pairs.for_each(|(sum, square)| *sum += weight / total * square);
            }
        }
        self.with_errors_of_tones(smoothed)
    }

    /// Returns the models of the intensities of a prior with its linear model, whose weights add to its odds to the likeliest one.
    fn over_intensities(
        &self,
        linear: &Linear,
        of: &Smoothed,
        likeliest: &Smoothed,
        log_odds: f64,
    ) -> Vec<Model> {
        let weighed = of.posterior(linear, LEAST_LOG_ODDS - log_odds);
        let total: f64 = weighed.iter().map(|one| one.log.exp()).sum();
        parallel::map(weighed.iter(), |one| {
            let found = match one.value.corner == of.noise.corner {
                true => &of.estimates,
                false => &self.smoothed_along(&mut of.path(), linear, &one.value),
            };
            let pairs = found.iter().zip(&likeliest.estimates);
            let squares = pairs
                .map(|(found, likeliest)| found.estimated().about(likeliest.motion()).covariance);
            Model {
                weight: (log_odds + one.log).exp() / total,
                squares: squares.collect(),
            }
        })
    }
}

impl Smoothed {
    /// Returns the noises whose corner frequencies count by the least ln of their odds, in steps from the likeliest one.
    fn posterior(&self, linear: &Linear, least: f64) -> Vec<Weighed<Noise>> {
        let [lowest, highest] = self.scales.corners().map(f64::ln);
        let likeliest = self.noise.corner.ln();
        // The standard deviation of the process noise goes with this power of the corner frequency.
        let power = (self.prior.order + 2) as f64;
        let with = |corner: f64, way: f64| {
            let value = linear.evaluated(Noise {
                corner,
                ..self.noise
            });
            let log = value.likelihood - self.noise.likelihood + power * way;
            Weighed { value, log }
        };
        let at = |way: f64| {
            let corner = likeliest + way;
            let is_within = (lowest..=highest).contains(&corner);
            is_within.then(|| with(corner.exp(), way))
        };
        let first = with(self.noise.corner, 0.0);
        counting(on_both_sides(first, 2.0 * FIRST_STEP, least, at), least)
    }

    /// Returns the priors that count beside its own, whose part that repeats has harmonics enough for what others might add. One that
    /// repeats widens the band by all that noise may hide of it: it has to be in the least set with 95 % of the weights.
    fn contenders(&self) -> impl Iterator<Item = &Candidate> {
        self.compared.iter().filter(|other| {
            let log_odds = self.log_odds(other);
            match (self.prior.cycle, other.prior.cycle) {
                (1.., 1..) => false,
                (_, 1..) => counts(-log_odds),
                _ => other.prior != self.prior && log_odds > LEAST_LOG_ODDS,
            }
        })
    }

    /// Returns ln of the odds of a prior to its own, about the path by which both were compared; at most 0.
    fn log_odds(&self, other: &Candidate) -> f64 {
        let own = self.compared.iter().find(|one| one.prior == self.prior);
        let odds = own.map(|own| other.noise.likelihood - own.noise.likelihood);
        odds.map_or(f64::NEG_INFINITY, |odds| odds.min(0.0))
    }
}
