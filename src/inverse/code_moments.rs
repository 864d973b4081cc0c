//! Codes of an encoder: each says that the crank is within one step, with the probability Φ((b − θ)/ε) − Φ((a − θ)/ε) for the
//! ends a, b of the step and their jitter ε. Expectation propagation (Minka 2001) puts a normal distribution in the place of
//! each such likelihood: the one with the moments that the code leaves of what all other samples say. Where the shaft is slow
//! the codes inside a step say nothing and the passages say much; where it is fast each is worth step²/12.

use super::interval::{Cavity, Site};
use super::likelihood::Linear;
use super::linearised::Prior;
use super::problem::{Estimate, Problem};
use super::quantised::Codes;
use super::record::Path;
use super::smoother::Smoothed;
use crate::numeric::parallel;

/// Jitters that are tried, in steps, and most samples by which one is chosen.
const JITTERS: [f64; 8] = [1e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0];
const ENOUGH: usize = 4000;

/// Part by which the normal distributions move towards the moments.
const DAMPING: f64 = 0.6;

/// σ² of the record is a squared step over this.
const UNIT: f64 = 12.0;

/// Codes with the normal distributions that stand for them, and what all others say of each.
struct Sites {
    codes: Codes,
    /// None of a sample that does not count.
    list: Vec<Option<(Site, Cavity)>>,
    jitter: f64,
}

impl Sites {
    /// The sites of a record about a smoothed motion.
    fn about(problem: &Problem<'_>, smoothed: &Smoothed) -> Option<Sites> {
        let record = &problem.record;
        let codes = record.codes.clone()?;
        let step = codes.step;
        let list = parallel::list(codes.values.len(), |i| {
            let code = codes.values[i];
            let precision = record.weights[i] * UNIT;
            let site = Site {
                precision,
                shift: precision * (record.values[i] - code) / step,
            };
            let estimate = problem.at_sample(&smoothed.estimates, i);
            let precision = step * step / estimate.covariance[0];
            // What is left of almost nothing is rounding.
            let left = (precision - site.precision).max(1e-6 * precision);
            let mean = (estimate.state[0] - code) / step;
            let cavity = Cavity {
                mean: (precision * mean - site.shift) / left,
                variance: 1.0 / left,
            };
            code.is_finite().then_some((site, cavity))
        });
        let mut sites = Sites {
            codes,
            list,
            jitter: 0.0,
        };
        let some = || sites.list.iter().step_by(sites.list.len().div_ceil(ENOUGH));
        let of = |jitter: f64| {
            some()
                .flatten()
                .map(|(_, c)| c.matched(jitter).0)
                .sum::<f64>()
        };
        let tried = JITTERS.map(|jitter| (of(jitter), jitter));
        let best = tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        sites.jitter = best.map_or(JITTERS[0], |(_, jitter)| jitter);
        Some(sites)
    }

    /// ln of the probability of the codes over that of the normal distributions in their place: the evidence of the sites with
    /// it is that of the codes.
    fn correction(&self, problem: &Problem<'_>, sigma: f64) -> f64 {
        let of = |(site, cavity): &(Site, Cavity)| {
            let probability = cavity.matched(self.jitter).0;
            if site.precision == 0.0 {
                return probability;
            }
            let variance = 1.0 / site.precision + cavity.variance;
            let off = site.shift / site.precision - cavity.mean;
            probability + 0.5 * ((UNIT * variance).ln() + off * off / variance) + sigma.ln()
        };
        // Of the samples by which the evidence is found.
        let first = &problem.grid.first;
        let ranges = problem.sampled().into_iter();
        let samples = ranges.flat_map(|nodes| first[nodes.start]..first[nodes.end]);
        samples.filter_map(|i| self.list[i].as_ref()).map(of).sum()
    }

    /// Moves the sites towards the moments; the largest change of a weight.
    fn propagate(&self, problem: &mut Problem<'_>) -> f64 {
        let moved = parallel::list(self.list.len(), |i| {
            let (was, cavity) = self.list[i]?;
            let next = cavity.matched(self.jitter).1;
            let between = |a: f64, b: f64| a + DAMPING * (b - a);
            Some(Site {
                precision: between(was.precision, next.precision),
                shift: between(was.shift, next.shift),
            })
        });
        let mut change = 0.0f64;
        for (i, site) in moved.into_iter().enumerate() {
            let Some(site) = site else { continue };
            let weight = site.precision / UNIT;
            let off = match site.precision > 0.0 {
                true => site.shift / site.precision,
                false => 0.0,
            };
            change = change.max((weight - problem.record.weights[i]).abs() / (1.0 + weight));
            problem.record.weights[i] = weight;
            problem.record.values[i] = self.codes.values[i] + off * self.codes.step;
        }
        change
    }
}

/// Most rounds of expectation propagation, those between two estimates of the noise of the motion, and the change of a code's
/// weight at which they end.
const ROUNDS: usize = 16;
const SOME: usize = 4;
const STILL: f64 = 0.01;

impl Smoothed {
    /// Whether motion and likelihood are finite.
    pub fn is_finite(&self) -> bool {
        let is_finite = |e: &Estimate| e.state[0].is_finite() && e.covariance[0] > 0.0;
        self.noise.likelihood.is_finite() && self.estimates.iter().all(is_finite)
    }

    /// The path of the smoothed states.
    fn path(&self) -> Path {
        Path {
            states: self.estimates.iter().map(|e| e.state).collect(),
            variances: None,
        }
    }
}

impl Problem<'_> {
    /// Codes whose steps are wider than the noise about a motion, if the samples are such.
    pub fn coded(&self, smoothed: &Smoothed) -> Option<Codes> {
        let record = &self.record;
        if !record.is_linear() {
            return None;
        }
        let mut codes = Codes::of(&record.values, record.digits)?;
        for sample in record.outliers() {
            codes.values[sample] = f64::NAN;
        }
        (smoothed.noise.sigma < codes.step).then_some(codes)
    }

    /// A smoothed motion about which the normal distributions that stand for codes have come to rest.
    pub fn propagated(&mut self, mut smoothed: Smoothed) -> Smoothed {
        let known = self.record.codes.as_ref().map(Codes::spread);
        smoothed.scales.known = known;
        smoothed.noise.sigma = known.unwrap_or(smoothed.noise.sigma);
        let motion = self.motion(smoothed.prior);
        for round in 0..ROUNDS {
            let Some(sites) = Sites::about(self, &smoothed) else {
                break;
            };
            let change = sites.propagate(self);
            let path = smoothed.path();
            // The noise of the motion follows codes that hardly move.
            let (is_last, sigma) = (round + 1 == ROUNDS || change < STILL, smoothed.noise.sigma);
            if is_last || round % SOME == SOME - 1 {
                let linear = Linear {
                    stretches: &self.stretches(&motion, &path, sigma),
                    prior: smoothed.prior,
                    scales: smoothed.scales,
                };
                smoothed.noise = linear.renewed(smoothed.noise);
            }
            smoothed.estimates = self.smoothed(&motion, &path, smoothed.scales, &smoothed.noise);
            if is_last {
                break;
            }
        }
        let sites = Sites::about(self, &smoothed);
        smoothed.noise.likelihood +=
            sites.map_or(0.0, |sites| sites.correction(self, smoothed.noise.sigma));
        smoothed
    }

    /// The smoothed motion with the prior by which the codes are likeliest, of those by which the normal distributions in their
    /// place are.
    pub fn likeliest_of_codes(&mut self, kinematic: Smoothed) -> (Smoothed, Vec<(Prior, f64)>) {
        let first = self.sites();
        let mut found = Vec::new();
        for candidate in self.tried(&kinematic, false) {
            (self.record.values, self.record.weights) = first.clone();
            let smoothed = self.iterated(&candidate, &kinematic);
            if !smoothed.settled {
                continue;
            }
            let smoothed = self.propagated(smoothed);
            if smoothed.is_finite() {
                found.push((smoothed, self.sites()));
            }
            if found.len() == CANDIDATES {
                break;
            }
        }
        found.sort_by(|a, b| b.0.noise.likelihood.total_cmp(&a.0.noise.likelihood));
        let listed = found
            .iter()
            .map(|(one, _)| (one.prior, one.noise.likelihood));
        let listed = listed.collect();
        let (smoothed, sites) = found.into_iter().next().unwrap_or((kinematic, first));
        (self.record.values, self.record.weights) = sites;
        (smoothed, listed)
    }

    /// Means and weights of the normal distributions in the place of the codes.
    fn sites(&self) -> (Vec<f64>, Vec<f64>) {
        (self.record.values.clone(), self.record.weights.clone())
    }
}

/// Priors that are compared by the probability of the codes.
const CANDIDATES: usize = 3;
