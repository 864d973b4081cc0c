//! Summaries of the parts of a fit.

use std::f64::consts::TAU;

use super::super::candidates::Candidate;
use super::super::intensity::Span;
use super::super::model::tone::Tone;
use super::summary::{CandidateSummary, IntensitySummary, ToneSummary};

impl Candidate {
    /// Returns its name and likelihood.
    pub fn summary(&self) -> CandidateSummary {
        CandidateSummary {
            prior: self.prior.name(),
            log_likelihood: self.noise.likelihood,
        }
    }
}

impl Span {
    /// Returns it in the time of the scene, which is `origin`, s, where the record begins.
    pub fn summary(&self, origin: f64) -> IntensitySummary {
        IntensitySummary {
            from_s: origin + self.from,
            to_s: origin + self.to,
            factor: self.factor,
        }
    }
}

impl Tone {
    /// Returns its frequency and amplitude with the odds.
    pub fn summary(&self) -> ToneSummary {
        ToneSummary {
            carrier: self.carrier,
            frequency_hz: self.frequency / TAU,
            amplitude: self.amplitude(),
            log_odds: self.log_odds,
        }
    }
}
