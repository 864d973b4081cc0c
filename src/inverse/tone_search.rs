//! Search for a tone by the periodogram of the prediction errors.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use super::grid::{LONG, Path};
use super::likelihood::Linear;
use super::periodogram::{Line, lines};
use super::prior::{TORQUE, Unknown};
use super::problem::{MOST_NODES, Problem};
use super::repeating::dot;
use super::scales::Noise;
use super::sinusoid::Beside;
use super::smoother::Smoothed;
use super::state_space::Stretch;
use super::tone::{Carrier, Tone};

/// A linear model of one stretch about a path, with its likeliest noise.
pub(super) struct BesideKnown {
    pub linear: Linear,
    pub noise: Noise,
    pub path: Path,
}

impl Problem<'_> {
    /// Returns the likeliest tone in what a smoothed motion leaves, once of the sensor and once of the torque; none if no line stands
    /// out there, or if no tone gains what it costs. A very long record and one of codes or of several sensors have none.
    pub fn another_tone(&self, smoothed: &Smoothed) -> Vec<Tone> {
        let record = &self.record;
        let may_have = record.codes.is_none() && record.beside.is_empty() && !self.is_computed();
        // The likelihoods of stretches of means do not tell a tone.
        let is_long = self.condensed.is_some() && self.sampled() != self.all();
        if !may_have || is_long || self.grid.len() > LONG || self.is_stopped() {
            return Vec::new();
        }
        let nodes = self.grid.times.iter().zip(&smoothed.estimates);
        let errors = nodes.map(|(t, estimate)| [*t, estimate.innovation]);
        let errors: Vec<[f64; 2]> = errors.filter(|[_, error]| error.is_finite()).collect();
        let lines = lines(&errors, MOST_NODES);
        if lines.is_empty() {
            return Vec::new();
        }
        let BesideKnown { linear, noise, .. } = self.beside_known(smoothed);
        let least = noise.likelihood + self.cost_of_tone();
        let at = |line: &Line| {
            let near = line.highest(&errors);
            let of = |carrier| self.beside(&linear, carrier)?.likeliest(near, noise);
            let carriers = [Carrier::Sensor, Carrier::Torque].into_iter();
            let found = Vec::from_iter(carriers.filter_map(of));
            let gains = found.iter().any(|(_, noise)| noise.likelihood > least);
            gains.then(|| found.into_iter().map(|(tone, _)| tone).collect())
        };
        lines.iter().find_map(at).unwrap_or_default()
    }

    /// The cost of a frequency and two amplitudes in ln of the likelihood.
    pub fn cost_of_tone(&self) -> f64 {
        self.cost(3.0)
    }

    /// Returns the last tone of the record, corrected by what a smoothed motion beside it leaves.
    pub fn last_tone(&self, smoothed: &Smoothed) -> Option<Tone> {
        let tone = self.record.tones.last()?;
        let BesideKnown { linear, noise, .. } = self.beside_known(smoothed);
        let beside = self.beside(&linear, tone.carrier)?;
        beside.corrected(&beside.stretch, *tone, &noise)
    }

    /// The place of a tone beside a linear model of one stretch; none without.
    pub fn beside<'b>(&'b self, linear: &'b Linear, carrier: Carrier) -> Option<Beside<'b>> {
        Some(Beside {
            linear,
            stretch: linear.stretches.first()?.clone(),
            problem: self,
            carrier,
        })
    }

    /// The linear model of a torque about a smoothed motion, beside what repeats in it, and its likeliest noise.
    pub fn beside_known(&self, smoothed: &Smoothed) -> BesideKnown {
        let (prior, path) = match smoothed.prior.unknown {
            Unknown::Torque => (smoothed.prior.beside_known(), smoothed.path()),
            _ => (TORQUE, self.path_of(TORQUE, smoothed, self.all())),
        };
        let first = Noise {
            spectrum: None,
            ..smoothed.noise
        };
        let scales = self.scales(prior, &path, smoothed.scales.slope, first.sigma);
        let linear = Linear {
            stretches: [self.stretch(prior, &path, 0..self.grid.len(), first.sigma)].into(),
            ..Linear::of(prior, scales)
        };
        let noise = linear.with_corner(linear.begun(first));
        BesideKnown {
            linear,
            noise,
            path,
        }
    }
}

impl Beside<'_> {
    /// Returns a tone with its covariance, corrected by least squares for what a stretch without it leaves (Gauss-Newton); none where
    /// the samples do not tell it.
    pub fn corrected(&self, without: &Stretch, tone: Tone, noise: &Noise) -> Option<Tone> {
        let errors = self.errors(without, noise);
        let rows = [0, 1, 2].map(|k| self.errors_of(noise, |t| tone.slopes(t)[k]));
        let information = Matrix3::from_fn(|i, j| dot(&rows[i], &rows[j]));
        let score = Vector3::from_fn(|i, _| dot(&rows[i], &errors));
        let inverse = information.try_inverse()?;
        let correction = inverse * score;
        let is_finite = correction.iter().chain(&inverse).all(|one| one.is_finite());
        // The wave is linear in the frequency next to it alone.
        let is_near = correction[2].abs() < 2.0 * self.width();
        (is_finite && is_near).then(|| Tone {
            amplitudes: [0, 1].map(|k| tone.amplitudes[k] + correction[k]),
            frequency: tone.frequency + correction[2],
            covariance: inverse * noise.sigma.powi(2),
            ..tone
        })
    }

    /// Half the distance of two frequencies that the samples tell apart, rad/s.
    pub fn width(&self) -> f64 {
        0.5 * TAU / self.linear.scales.duration
    }
}
