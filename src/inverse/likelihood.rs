//! Marginal likelihood of a prior (prediction error decomposition with a diffuse start, that is REML), maximised over the
//! intensity of its noise; the variance of a sample is profiled out.

use super::kalman::{self, Evidence};
use super::periodic::Regressed;
use super::prior::{Prior, State};
use super::regression::{Regression, Rest, Spectrum};
use super::scales::{Noise, Scales};
use super::state_space::{Deviations, Stretch, with_dimension};
use crate::numeric::parallel;

/// Stretches of nodes with their linear models, and the scales of the search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear<'a> {
    /// Steps and samples of each stretch.
    pub stretches: &'a [Stretch],
    pub prior: Prior,
    pub scales: Scales,
}

impl Linear<'_> {
    /// Standard deviations of the state before the first sample, in σ.
    fn spread(&self) -> State {
        let mut spread = self.scales.spread();
        if self.scales.identified.is_some() {
            spread[2] = 0.0;
        }
        for k in 0..self.prior.powers {
            spread[self.prior.diffuse() + k] = self.scales.torque / self.scales.powers[k];
        }
        spread
    }

    /// The linear model of one stretch.
    pub fn deviations<'a>(&self, stretch: &'a Stretch, noise: &Noise) -> Deviations<'a> {
        Deviations {
            stretch,
            prior: self.prior,
            noise: self.scales.density(noise.corner, self.prior.order),
            speed_noise: match self.prior.powers {
                0 => 0.0,
                _ => self.scales.density(noise.speed_corner, 1) / self.scales.powers[0].powi(2),
            },
            correlated: noise.correlated,
            spread: self.spread(),
        }
    }

    fn evidence(&self, noise: &Noise) -> Evidence {
        let of = |stretch: &Stretch| {
            let model = self.deviations(stretch, noise);
            let mut evidence = Evidence::default();
            with_dimension!(model.dimension(), N => {
                kalman::run::<N>(&model, None, &mut evidence);
            });
            evidence
        };
        parallel::map(self.stretches.iter(), of).into_iter().sum()
    }

    /// Returns the evidence with the periodic part, for the spectrum of the noise or else for the likeliest.
    fn repeated(&self, noise: &mut Noise, near: Option<Spectrum>) -> Evidence {
        let of = |stretch: &Stretch| {
            let model = self.deviations(stretch, noise);
            let mut regression = Regression::new(self.prior);
            let evidence = with_dimension!(model.dimension(), N => {
                let mut regressed = Regressed::<N>::new(&model, &mut regression, None);
                kalman::run::<N>(&model, None, &mut regressed);
                regressed.evidence
            });
            regression.multiply();
            (evidence, regression)
        };
        let (evidences, regressions): (Vec<_>, Vec<_>) =
            parallel::map(self.stretches.iter(), of).into_iter().unzip();
        let mut evidence: Evidence = evidences.into_iter().sum();
        let regression = Regression::of_all(self.prior, regressions);
        let starts = self.prior.diffuse() * self.stretches.len();
        let free = (evidence.samples.saturating_sub(starts)).max(1) as f64;
        let Scales { known, floor, .. } = self.scales;
        let rest = Rest {
            squares: evidence.squares,
            free,
            variances: [known.unwrap_or(floor), known.unwrap_or(f64::INFINITY)].map(|s| s * s),
        };
        let found = match noise.spectrum {
            Some(spectrum) => regression.solved(spectrum).map(|found| (spectrum, found)),
            None => regression.likeliest(near, &rest),
        };
        noise.spectrum = found.as_ref().map(|(spectrum, _)| *spectrum);
        if let Some((_, found)) = found {
            evidence.squares -= found.fall;
            evidence.log_variances += found.log_determinant;
        }
        evidence
    }

    /// Noise with its likelihood and its σ.
    pub fn evaluated(&self, noise: Noise) -> Noise {
        self.evaluated_near(noise, None)
    }

    /// Noise with its likelihood, its σ, and the likeliest spectrum about the one it has.
    pub fn begun(&self, mut noise: Noise) -> Noise {
        let near = noise.spectrum.take();
        self.evaluated_near(noise, near)
    }

    fn evaluated_near(&self, mut noise: Noise, near: Option<Spectrum>) -> Noise {
        let evidence = match self.prior.cycle {
            0 => self.evidence(&noise),
            _ => self.repeated(&mut noise, near),
        };
        self.judged(noise, &evidence, self.stretches.len())
    }

    /// Returns the noise with its likelihood and σ, from the evidence of filters that were started `begun` times.
    pub fn judged(&self, mut noise: Noise, evidence: &Evidence, begun: usize) -> Noise {
        let starts = match self.scales.identified {
            None => (self.prior.diffuse() * begun) as f64,
            Some(values) => (2 + values) as f64,
        };
        let free = evidence.samples as f64 - starts;
        let profiled = (evidence.squares / free.max(1.0)).sqrt();
        noise.sigma = self.scales.known.unwrap_or(profiled).max(self.scales.floor);
        let spread = self.spread();
        let Scales {
            lever,
            motion: [alpha, jerk],
            ..
        } = self.scales;
        // The spreads of θ and ω are the same for all priors.
        let mut start = (spread[0] * spread[1]).ln();
        let mut prior = alpha / lever;
        for spread in &spread[2..self.prior.diffuse()] {
            if *spread > 0.0 {
                start += (spread / prior).ln();
            }
            prior *= jerk / alpha;
        }
        let likelihood = start * begun as f64
            - free * noise.sigma.ln()
            - 0.5 * (evidence.log_variances + evidence.squares / (noise.sigma * noise.sigma));
        noise.likelihood = match likelihood.is_finite() {
            true => likelihood,
            false => f64::NEG_INFINITY,
        };
        noise
    }
}
