//! Marginal likelihood of a prior (prediction error decomposition with a diffuse start, that is REML), maximised over the
//! intensity of its noise; the variance of a sample is profiled out.

use std::f64::consts::TAU;
use std::sync::Arc;

use multiversion::multiversion;

use super::model::fixed_interval::Companion;
use super::model::kalman::{self, Evidence};
use super::model::prior::{Prior, State};
use super::model::regressors::Regressors;
use super::model::state_space::{Deviations, Stretch, with_dimension};
use super::repeating::periodic::Regressed;
use super::repeating::regression::{Regression, Rest};
use super::repeating::spectra::OverSpectra;
use super::repeating::spectrum::Spectrum;
use super::scales::{Noise, Scales};
use crate::numeric::parallel;

/// Returns the likelihood terms of a model.
#[multiversion(targets("x86_64+avx2"))]
fn evidence<const N: usize>(model: &Deviations<'_>) -> Evidence {
    let mut evidence = Evidence::default();
    kalman::run::<N>(model, None, |_, at| evidence.add(at));
    evidence
}

/// Returns the normal equations of a model.
#[multiversion(targets("x86_64+avx2"))]
fn regression<const N: usize>(model: &Deviations<'_>) -> Regression {
    let mut regressed = Regressed::<N>::new(model, false);
    kalman::run::<N>(model, None, |node, at| regressed.filtered(node, at));
    regressed.into_parts().0
}

/// Stretches of nodes with their linear models, and the scales of the search.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    /// Steps and samples of each stretch.
    pub stretches: Arc<[Stretch]>,
    pub prior: Prior,
    pub scales: Scales,
    /// Standard deviations of the coefficients of what repeats, in the place of those of one spectrum.
    pub over_spectra: Option<Arc<OverSpectra>>,
}

impl Linear {
    /// A prior and its scales, without steps.
    pub fn of(prior: Prior, scales: Scales) -> Linear {
        Linear {
            stretches: Arc::default(),
            prior,
            scales,
            over_spectra: None,
        }
    }

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
            law_noise: match (self.prior.powers, self.prior.order) {
                (1.., 1) => self.scales.density(noise.corner, 1) / self.scales.powers[0].powi(2),
                _ => 0.0,
            },
            correlated: noise.correlated,
            spread: self.spread(),
        }
    }

    /// The regressors of the tones; none without tones.
    fn tones(&self) -> Option<&Regressors> {
        let first = self.stretches.first()?;
        Some(&*first.tones).filter(|tones| tones.count > 0)
    }

    /// Returns the evidence without a periodic part.
    fn plain(&self, noise: &Noise) -> Evidence {
        let of = |stretch: &Stretch| {
            let model = self.deviations(stretch, noise);
            with_dimension!(model.dimension(), N => evidence::<N>(&model))
        };
        let mut all = Evidence::default();
        for part in parallel::map(self.stretches.iter(), of) {
            all += part;
        }
        all
    }

    /// Returns the normal equations of the coefficients of what repeats, over all values of the tones.
    pub fn regression(&self, noise: &Noise) -> Regression {
        let unit = self.tones().map_or(0.0, |tones| tones.log_unit);
        self.normal_equations(noise).over_tones(unit)
    }

    /// Returns the normal equations of the coefficients of what repeats, then of the numbers of the tones.
    pub fn normal_equations(&self, noise: &Noise) -> Regression {
        let of = |stretch: &Stretch| {
            let model = self.deviations(stretch, noise);
            with_dimension!(model.dimension(), N => regression::<N>(&model))
        };
        Regression::of_all(self.prior, parallel::map(self.stretches.iter(), of))
    }

    /// What the samples tell without what repeats.
    pub fn rest(&self, evidence: &Evidence) -> Rest {
        let starts = self.prior.diffuse() * self.stretches.len();
        let Scales { known, floor, .. } = self.scales;
        let turn = f64::from(self.prior.cycle) * TAU / self.scales.speed;
        let free = (evidence.samples.saturating_sub(starts)).max(1) as f64;
        Rest {
            squares: evidence.squares,
            free,
            cost: free.ln(),
            variances: [known.unwrap_or(floor), known.unwrap_or(f64::INFINITY)].map(|s| s * s),
            waves: (0.5 * turn / self.scales.spacing) as usize,
        }
    }

    /// The linear model in which what repeats has all spectra that the samples allow, beside a noise with the likeliest one.
    pub fn with_all_spectra(self, noise: &Noise) -> Linear {
        let Some(likeliest) = noise.spectrum.filter(|_| self.prior.cycle > 0) else {
            return self;
        };
        let regression = self.regression(noise);
        let rest = self.rest(&regression.evidence);
        let over_spectra = regression.over_spectra(likeliest, &rest).map(Arc::new);
        Linear {
            over_spectra,
            ..self
        }
    }

    /// Returns the evidence; with a periodic part, for the spectrum of the noise or else for the likeliest, which is left there.
    fn evidence(&self, noise: &mut Noise, near: Option<Spectrum>) -> Evidence {
        if self.prior.cycle == 0 && self.tones().is_none() {
            return self.plain(noise);
        }
        let regression = self.regression(noise);
        let mut evidence = regression.evidence;
        if self.prior.cycle == 0 {
            return evidence;
        }
        let rest = self.rest(&evidence);
        let found = match noise.spectrum {
            Some(spectrum) => regression
                .solved(spectrum, &rest)
                .map(|found| (spectrum, found)),
            None => regression.likeliest(near, &rest),
        };
        noise.spectrum = found.as_ref().map(|(spectrum, _)| *spectrum);
        if let Some((_, found)) = found {
            evidence.squares -= found.fall;
            evidence.log_variances += found.penalty;
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
        let evidence = self.evidence(&mut noise, near);
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
        // The spreads of θ and ω are the same for all priors.
        let mut start = (spread[0] * spread[1]).ln();
        let sizes = self.scales.of_unknown(&noise);
        let spreads = spread[2..self.prior.diffuse()].iter().zip(sizes);
        for (spread, size) in spreads.filter(|(spread, _)| **spread > 0.0) {
            start += spread.ln() - size.ln();
        }
        // Size and order of a spectrum (Schwarz, Ann. Statist. 6 (1978) 461).
        let cost = match noise.spectrum {
            Some(_) => (self.scales.samples * evidence.samples as f64).ln(),
            None => 0.0,
        };
        let likelihood = start * begun as f64
            - free * noise.sigma.ln()
            - 0.5 * (evidence.log_variances + evidence.squares / (noise.sigma * noise.sigma))
            - cost;
        noise.likelihood = match likelihood.is_finite() {
            true => likelihood,
            false => f64::NEG_INFINITY,
        };
        noise
    }
}
