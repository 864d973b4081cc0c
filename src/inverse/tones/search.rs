//! Search for a tone by the periodogram of the prediction errors.

use std::f64::consts::TAU;

use super::super::grid::LONG;
use super::super::likelihood::Linear;
use super::super::measurement_model::Shown;
use super::super::model::prior::{TORQUE, Unknown};
use super::super::model::state_space::Stretch;
use super::super::model::tone::{Carrier, Tone};
use super::super::problem::{MOST_NODES, Problem};
use super::super::repeating::periodogram::lines;
use super::super::scales::Noise;
use super::super::smoother::Smoothed;
use super::sinusoid::Beside;

/// Tones corrected by least squares.
pub(in crate::inverse) struct Corrected {
    pub tones: Vec<Tone>,
    /// Mean square of the corrections, in standard errors.
    pub square: f64,
    /// ln of the determinant of their covariance.
    pub log_unit: f64,
}

/// A tone with ln of its probability, up to a constant.
pub(in crate::inverse) struct Probable {
    pub tone: Tone,
    pub log_probability: f64,
}

impl Probable {
    /// Returns a tone with its likeliest noise beside a motion, whose noise is the scale of one of the sensor, and whose torque that of
    /// one of the torque.
    fn new(tone: Tone, noise: &Noise, problem: &Problem<'_>, motion: &Smoothed) -> Probable {
        let scale = match tone.carrier {
            Carrier::Sensor => noise.sigma,
            Carrier::Torque => problem.accelerating_torque(motion),
        };
        Probable {
            tone,
            log_probability: noise.likelihood + tone.log_prior(scale),
        }
    }

    /// Returns ln of its odds to another tone.
    pub fn log_odds_to(&self, other: &Probable) -> f64 {
        self.log_probability - other.log_probability
    }
}

/// A tone of the other carrier.
pub(in crate::inverse) struct Rival {
    pub tone: Tone,
    /// ln of the odds of the accepted tone to it.
    pub log_odds: f64,
}

impl Problem<'_> {
    /// Returns the likeliest tone in what a smoothed motion leaves, once of the sensor and once of the torque; none if no line stands
    /// out there, or if no tone gains what it costs. A very long record and one of codes or of several sensors have none.
    pub fn another_tone(&self, smoothed: &Smoothed) -> Option<Vec<Probable>> {
        let record = &self.record;
        let may_have = record.codes.is_none() && record.beside.is_empty() && !self.is_computed();
        // The likelihoods of stretches of means do not tell a tone.
        let is_long = self.condensed.is_some() && self.sampled() != self.all();
        if !may_have || is_long || self.grid.len() > LONG || self.is_stopped() {
            return None;
        }
        // A wave of the angle shows with the sensor's slope.
        let slopes: [fn(&Shown) -> f64; 2] = [|_| 1.0, |shown| shown.slope];
        let lists = slopes.map(|slope| {
            let nodes = self.grid.times.iter().zip(&smoothed.estimates);
            let errors = nodes.map(|(t, estimate)| {
                let shown = record.sensor.shown(estimate.turning());
                [*t, slope(&shown) * estimate.innovation]
            });
            let errors = Vec::from_iter(errors.filter(|[_, error]| error.is_finite()));
            (lines(&errors, MOST_NODES), errors)
        });
        let most = lists.iter().map(|(lines, _)| lines.len()).max();
        let most = most.filter(|most| *most > 0)?;
        let known = self.beside_known(smoothed);
        let least = known.noise.likelihood + self.cost_of_tone();
        let at = |k: usize| {
            let places = lists.iter();
            let places = places.filter_map(|(lines, errors)| Some(lines.get(k)?.highest(errors)));
            let mut places = Vec::from_iter(places);
            places.dedup();
            let likeliest = |carrier| {
                let found = places
                    .iter()
                    .filter_map(|near| known.likeliest(carrier, *near));
                found.max_by(|(_, a), (_, b)| a.likelihood.total_cmp(&b.likelihood))
            };
            let carriers = [Carrier::Sensor, Carrier::Torque].into_iter();
            let found = Vec::from_iter(carriers.filter_map(likeliest));
            let gains = found.iter().any(|(_, noise)| noise.likelihood > least);
            let with = |(tone, noise)| Probable::new(tone, &noise, self, smoothed);
            gains.then(|| found.into_iter().map(with).collect())
        };
        (0..most).find_map(at)
    }

    /// Returns the last tone of the record as one of the other carrier, by the same linear model about the motion beside it. None without
    /// a tone, or where the samples do not tell the other.
    pub fn rival(&self, smoothed: &Smoothed) -> Option<Rival> {
        let own = *self.record.tones.last()?;
        let mut known = self.beside_known(smoothed);
        known.stretch = known.stretch.beside_known_tones();
        let linear = Linear {
            stretches: [known.stretch.clone()].into(),
            ..known.linear.clone()
        };
        let noise = linear.renewed(known.noise);
        known.stretch = known.with(own.carrier, 1.0, |t| own.at(t));
        let (tone, noise_beside) = known.likeliest(own.carrier.other(), own.frequency)?;
        let other = Probable::new(tone, &noise_beside, self, smoothed);
        Some(Rival {
            tone,
            log_odds: Probable::new(own, &noise, self, smoothed).log_odds_to(&other),
        })
    }

    /// The cost of a frequency and two amplitudes in ln of the likelihood.
    pub fn cost_of_tone(&self) -> f64 {
        self.cost(3.0)
    }

    /// Returns the tones of the record, corrected by what a smoothed motion beside them leaves; none where the samples do not tell
    /// them.
    pub fn corrected_tones(&self, smoothed: &Smoothed) -> Option<Corrected> {
        let tones = &self.record.tones;
        let Smoothed { prior, noise, .. } = *smoothed;
        if tones.is_empty() || tones.iter().any(|tone| !tone.is_beside(prior)) {
            return None;
        }
        let nodes = 0..self.grid.len();
        let linear = Linear {
            stretches: [self.stretch(prior, &smoothed.path(), nodes, noise.sigma)].into(),
            ..Linear::of(prior, smoothed.scales)
        };
        let noise = match self.sampled() == self.all() {
            true => noise,
            // That of parts of the record is beside tones that are held.
            false => linear.renewed(noise),
        };
        linear.corrected(tones, &noise)
    }

    /// The linear model of a torque about a smoothed motion, beside what repeats in it, and its likeliest noise.
    pub fn beside_known(&self, smoothed: &Smoothed) -> Beside<'_> {
        let (prior, path) = match smoothed.prior.unknown {
            Unknown::Torque => (smoothed.prior.beside_known(), smoothed.path()),
            _ => (TORQUE, self.path_of(TORQUE, smoothed, self.all())),
        };
        let first = Noise {
            spectrum: None,
            ..smoothed.noise
        };
        let scales = self.scales(prior, &path, smoothed.scales.slope, first.sigma);
        let stretch = self.stretch(prior, &path, 0..self.grid.len(), first.sigma);
        let linear = Linear {
            stretches: [stretch.clone()].into(),
            ..Linear::of(prior, scales)
        };
        Beside {
            problem: self,
            path,
            noise: linear.with_corner(linear.begun(first)),
            linear,
            stretch,
        }
    }
}

impl Beside<'_> {
    /// Returns a tone with its unit, corrected by what a stretch without it leaves; none where the samples do not tell it.
    pub fn corrected(&self, without: &Stretch, tone: Tone, noise: &Noise) -> Option<Tone> {
        let (prior, states) = (self.linear.prior, &self.path.states);
        let tones = (self.problem).regressors(&[tone], prior, 0..states.len(), states);
        let stretch = Stretch {
            tones: tones.into(),
            ..without.clone()
        };
        let model = Linear {
            stretches: [stretch].into(),
            ..self.linear.clone()
        };
        let found = model.corrected(&[tone], noise)?;
        found.tones.first().map(|tone| Tone {
            log_unit: found.log_unit,
            ..*tone
        })
    }
}

impl Linear {
    /// Returns the tones of its regressors, corrected by least squares (Gauss-Newton); none where the samples do not tell them.
    fn corrected(&self, tones: &[Tone], noise: &Noise) -> Option<Corrected> {
        let equations = self.normal_equations(noise);
        let mut beside = Vec::new();
        if let Some(spectrum) = noise.spectrum {
            let own = equations.clone().over_tones(0.0);
            beside = own.solved(spectrum, &self.rest(&own.evidence))?.deviations;
        }
        let found = equations.tones(&beside)?;
        let (count, variance) = (found.values.len(), noise.sigma.powi(2));
        let corrections = found.values.as_slice().chunks_exact(3);
        // A wave is linear in the frequency next to it alone.
        let far = 2.0 * self.resolved_frequency();
        let is_near = corrections.clone().all(|by| by[2].abs() < far);
        let corrected = tones.iter().zip(corrections);
        let corrected = corrected.map(|(tone, by)| tone.moved([by[0], by[1], by[2]]));
        is_near.then(|| Corrected {
            tones: corrected.collect(),
            square: found.fall / (count as f64 * variance),
            log_unit: count as f64 * variance.ln() - found.information.ln_determinant(),
        })
    }

    /// Half the distance of two frequencies that the samples tell apart, rad/s.
    pub fn resolved_frequency(&self) -> f64 {
        0.5 * TAU / self.scales.duration
    }
}
