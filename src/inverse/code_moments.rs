//! Expectation propagation (Minka 2001) for encoder codes: intervals in, smoothed motion out. A code has the
//! probability Φ((b − θ)/ε) − Φ((a − θ)/ε) for the ends a, b of its interval and their jitter ε. A normal distribution
//! (site) stands for it, matched to the moments that the code leaves of the cavity distribution of all other samples.
//! On a slow shaft codes inside a step say nothing and passages much; on a fast one each is worth step²/12.

use super::estimate::Estimate;
use super::interval::{Cavity, Site};
use super::problem::Problem;
use super::quantised::{Codes, Interval};
use super::residual_tests::DEVIATIONS;
use super::smoother::{PATH_AT_REST, Smoothed, change};
use crate::numeric::parallel;

/// Jitters that are tried, in steps, and maximum number of samples by which one is chosen.
const JITTERS: [f64; 8] = [1e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0];
const JITTER_SAMPLES: usize = 4000;

/// Damping of expectation propagation: fraction of the change of a site that is made in one round.
const DAMPING: f64 = 0.6;

/// Belief about an interval: its site and its cavity, in widths of the interval.
#[derive(Clone, Copy)]
struct Belief {
    width: f64,
    site: Site,
    cavity: Cavity,
    /// Jitter of the ends of the interval, in widths.
    jitter: f64,
}

impl Belief {
    /// Returns ln of the probability of the code over that of its site.
    fn correction(&self) -> f64 {
        let (width, site, cavity) = (self.width, self.site, self.cavity);
        let probability = cavity.matched(self.jitter).0;
        if site.precision == 0.0 {
            return probability;
        }
        let variance = 1.0 / site.precision + cavity.variance;
        let off = site.shift / site.precision - cavity.mean;
        probability + 0.5 * ((variance * width * width).ln() + off * off / variance)
    }

    /// Returns the site, moved towards the moments by `DAMPING`.
    fn moved(&self) -> Site {
        let next = self.cavity.matched(self.jitter).1;
        let between = |a: f64, b: f64| a + DAMPING * (b - a);
        Site {
            precision: between(self.site.precision, next.precision),
            shift: between(self.site.shift, next.shift),
        }
    }
}

impl Codes {
    /// Returns the precision of a sample of weight 1, in units of 1/width².
    fn unit(self, width: f64) -> f64 {
        (width / self.spread()).powi(2)
    }
}

impl Problem<'_> {
    /// Returns the belief about each interval by a smoothed motion, with the likeliest jitter; none for outliers.
    fn beliefs(&self, codes: Codes, smoothed: &Smoothed) -> Vec<Option<Belief>> {
        let record = &self.record;
        let of = |i: usize| {
            let Interval {
                t, middle, width, ..
            } = record.intervals[i];
            let precision = record.weights[i] * codes.unit(width);
            let site = Site {
                precision,
                shift: precision * (record.values[i] - middle) / width,
            };
            let estimate = self.at(smoothed, t);
            let precision = width * width / estimate.covariance[0];
            // Less than 1e-6 of the precision is rounding.
            let left = (precision - site.precision).max(1e-6 * precision);
            let mean = (estimate.state[0] - middle) / width;
            let cavity = Cavity {
                mean: (precision * mean - site.shift) / left,
                variance: 1.0 / left,
            };
            (record.weights[i].is_finite() && middle.is_finite()).then_some(Belief {
                width,
                site,
                cavity,
                jitter: 0.0,
            })
        };
        let mut list = parallel::list(record.intervals.len(), of);
        let stride = list.len().div_ceil(JITTER_SAMPLES);
        let likelihood = |jitter: f64| {
            let some = list.iter().step_by(stride).flatten();
            some.map(|b| b.cavity.matched(jitter * codes.step / b.width).0)
                .sum::<f64>()
        };
        let tried = JITTERS.map(|jitter| (likelihood(jitter), jitter));
        let best = tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let jitter = best.map_or(JITTERS[0], |(_, jitter)| jitter) * codes.step;
        for belief in list.iter_mut().flatten() {
            belief.jitter = jitter / belief.width;
        }
        list
    }

    /// Moves the sites towards the moments.
    fn propagate(&mut self, codes: Codes, beliefs: &[Option<Belief>]) {
        for (i, belief) in beliefs.iter().enumerate() {
            let Some(belief) = belief else { continue };
            let site = belief.moved();
            let off = match site.precision > 0.0 {
                true => site.shift / site.precision,
                false => 0.0,
            };
            self.record.weights[i] = site.precision / codes.unit(belief.width);
            self.record.values[i] = self.record.intervals[i].middle + off * belief.width;
        }
    }
}

/// Maximum number of rounds of expectation propagation, and rounds between two estimates of the process noise.
const PROPAGATION_ROUNDS: usize = 16;
const ROUNDS_OF_A_NOISE: usize = 4;

impl Smoothed {
    /// True if motion and likelihood are finite.
    pub fn is_finite(&self) -> bool {
        let is_finite = |e: &Estimate| e.state[0].is_finite() && e.covariance[0] > 0.0;
        self.noise.likelihood.is_finite() && self.estimates.iter().all(is_finite)
    }
}

impl Problem<'_> {
    /// Iterates expectation propagation about a smoothed motion until the sites converge.
    pub fn propagated(&mut self, codes: Codes, mut smoothed: Smoothed) -> Smoothed {
        smoothed.scales.known = Some(codes.spread());
        smoothed.noise.sigma = codes.spread();
        let mut is_at_rest = false;
        for round in 0..PROPAGATION_ROUNDS {
            let beliefs = self.beliefs(codes, &smoothed);
            self.propagate(codes, &beliefs);
            let mut path = smoothed.path();
            // The process noise is estimated with sites that hardly move.
            let is_last = round + 1 == PROPAGATION_ROUNDS || is_at_rest;
            if is_last || round % ROUNDS_OF_A_NOISE == ROUNDS_OF_A_NOISE - 1 {
                let Smoothed { prior, noise, .. } = smoothed;
                let linear = self.linear(prior, smoothed.scales, &path, noise.sigma);
                smoothed.noise = linear.renewed(noise);
            }
            smoothed.estimates = self.smoothed(&mut path, &smoothed.candidate());
            smoothed.repeating = path.repeating.clone();
            if is_last {
                break;
            }
            is_at_rest = change(&smoothed.estimates, &path) < PATH_AT_REST;
        }
        // Corrections of the samples that enter the evidence.
        let beliefs = self.beliefs(codes, &smoothed);
        let first = &self.grid.first;
        let ranges = self.sampled().into_iter();
        let samples = ranges.flat_map(|nodes| first[nodes.start]..first[nodes.end]);
        let beliefs = samples.filter_map(|i| beliefs[i].as_ref());
        smoothed.noise.likelihood += beliefs.map(Belief::correction).sum::<f64>();
        smoothed
    }

    /// Returns the smoothed motion with the prior that makes the codes likeliest, among the likeliest priors of the
    /// sites.
    pub fn likeliest_of_codes(&mut self, codes: Codes, kinematic: &Smoothed) -> Smoothed {
        let first = self.sites();
        let mut found = Vec::new();
        for candidate in self.all_tried(kinematic).candidates {
            (self.record.values, self.record.weights) = first.clone();
            let path = self.path_of(candidate.prior, kinematic, self.all());
            let smoothed = self.iterated(&candidate, path);
            if !smoothed.converged {
                continue;
            }
            let smoothed = self.propagated(codes, smoothed);
            if smoothed.is_finite() {
                found.push(OfCodes {
                    keeps_steps: self.keeps_steps(codes, &smoothed),
                    sites: self.sites(),
                    smoothed,
                });
            }
            let kept = found.iter().filter(|one| one.keeps_steps).count();
            if kept == CANDIDATES || found.len() == 2 * CANDIDATES {
                break;
            }
        }
        if found.iter().any(|one| one.keeps_steps) {
            found.retain(|one| one.keeps_steps);
        }
        let likelihood = |one: &OfCodes| one.smoothed.noise.likelihood;
        found.sort_by(|a, b| likelihood(b).total_cmp(&likelihood(a)));
        let compared = found.iter().map(|one| one.smoothed.candidate()).collect();
        let best = found.into_iter().next();
        let (smoothed, sites) = best.map_or_else(
            || (kinematic.clone(), first),
            |one| (one.smoothed, one.sites),
        );
        (self.record.values, self.record.weights) = sites;
        Smoothed {
            compared,
            ..smoothed
        }
    }

    /// True if a motion lies within the steps of all samples as evenly as chance has it: mean square 1/12 of a step, of
    /// variance 1/180. The intervals, which are fewer, do not see that a stiff motion passes beside many samples.
    fn keeps_steps(&self, codes: Codes, smoothed: &Smoothed) -> bool {
        let shown = &self.record.shown;
        let off = |[t, value]: &[f64; 2]| (self.at(smoothed, *t).state[0] - value) / codes.step;
        let mean = shown.iter().map(|one| off(one).powi(2)).sum::<f64>() / shown.len() as f64;
        mean - 1.0 / 12.0 < DEVIATIONS * (1.0 / (180.0 * shown.len() as f64)).sqrt()
    }

    /// Returns means (rad) and weights of the sites of the codes.
    pub fn sites(&self) -> (Vec<f64>, Vec<f64>) {
        (self.record.values.clone(), self.record.weights.clone())
    }
}

/// Motion with a prior, with the sites of the codes, their values (rad) and weights, that belong to it.
struct OfCodes {
    smoothed: Smoothed,
    sites: (Vec<f64>, Vec<f64>),
    keeps_steps: bool,
}

/// Maximum number of priors that are compared by the probability of the codes, and half of those tried for one that
/// keeps the steps.
const CANDIDATES: usize = 4;
