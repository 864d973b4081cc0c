//! Least squares of a tone beside the likeliest noise of a linear model.

use nalgebra::{Matrix2, Vector2};

use super::super::grid::Path;
use super::super::likelihood::Linear;
use super::super::maximum::ENOUGH_RISE;
use super::super::model::harmonics::responses;
use super::super::model::kalman;
use super::super::model::repeating::dot;
use super::super::model::state_space::{Stretch, with_dimension};
use super::super::model::tone::{Carrier, Tone};
use super::super::problem::Problem;
use super::super::scales::Noise;
use crate::numeric::gauss::LOBATTO;
use crate::numeric::maximum;

/// A linear model of one stretch about a path, with its likeliest noise, for tones beside it.
pub(in crate::inverse) struct Beside<'a> {
    pub problem: &'a Problem<'a>,
    pub path: Path,
    pub linear: Linear,
    pub stretch: Stretch,
    pub noise: Noise,
}

impl Beside<'_> {
    /// The prediction errors of the samples of a stretch, in their standard deviations.
    fn errors(&self, stretch: &Stretch, noise: &Noise) -> Vec<f64> {
        let model = self.linear.deviations(stretch, noise);
        let mut errors = Vec::with_capacity(stretch.observed.len());
        with_dimension!(model.dimension(), N => {
            kalman::run::<N>(&model, None, |_, at| {
                if let Some((_, found)) = at.sample {
                    errors.push(found.error / found.variance.sqrt());
                }
            });
        });
        errors
    }

    /// The likeliest tone next to a frequency, rad/s, with the likeliest noise of what is left: least squares and the noise in
    /// turn. None where the samples have no likelihood.
    pub fn likeliest(&self, carrier: Carrier, near: f64) -> Option<(Tone, Noise)> {
        let mut found = None;
        let mut noise = Noise {
            likelihood: f64::NEG_INFINITY,
            ..self.noise
        };
        let resolved = self.linear.resolved_frequency();
        loop {
            let errors = self.errors(&self.stretch, &noise);
            let of = |frequency| self.solved(carrier, frequency, &errors, &noise);
            let range = [near - resolved, near + resolved];
            // As fine that the phase is off by 3e-4 rad at the ends of the record.
            let (frequency, _) = maximum::largest_to(|one| of(one).1, range, 1e-4 * resolved);
            let tone = Tone {
                carrier,
                frequency,
                amplitudes: of(frequency).0,
                log_unit: 0.0,
                log_odds: None,
            };
            let left = self.with(carrier, 1.0, |t| -tone.at(t));
            let model = Linear {
                stretches: std::iter::once(left.clone()).collect(),
                ..self.linear.clone()
            };
            let next = model.with_corner(model.begun(noise));
            let is_likelier = next.likelihood > noise.likelihood + ENOUGH_RISE;
            if !is_likelier {
                return found;
            }
            found = Some((self.corrected(&left, tone, &next)?, next));
            noise = next;
        }
    }

    /// Fits cosine and sine of a frequency, rad/s, to prediction errors; returns their amplitudes and the fall of the sum of squares.
    fn solved(
        &self,
        carrier: Carrier,
        frequency: f64,
        errors: &[f64],
        noise: &Noise,
    ) -> ([f64; 2], f64) {
        let waves: [fn(f64) -> f64; 2] = [f64::cos, f64::sin];
        // The prediction errors that each alone makes.
        let rows = waves.map(|wave| {
            let alone = self.with(carrier, 0.0, |t| wave(frequency * t));
            self.errors(&alone, noise)
        });
        let information = Matrix2::from_fn(|i, j| dot(&rows[i], &rows[j]));
        let score = Vector2::from_fn(|i, _| dot(&rows[i], errors));
        let amplitudes = information.try_inverse().unwrap_or_default() * score;
        (amplitudes.into(), amplitudes.dot(&score))
    }

    /// The stretch with a part of its deviations, and those that a wave of a carrier makes.
    pub fn with(&self, carrier: Carrier, part: f64, wave: impl Fn(f64) -> f64) -> Stretch {
        let mut steps = self.stretch.steps.to_vec();
        let mut observed = self.stretch.observed.to_vec();
        let Problem { grid, record, .. } = self.problem;
        for (step, t) in steps.iter_mut().zip(&grid.times) {
            step.defect = step.defect.map(|own| part * own);
            if carrier == Carrier::Torque {
                let ends = LOBATTO.map(|part| wave(t + part * step.h));
                let torques = [ends[0], ends[1], wave(t + step.h)].map(|one| one - wave(*t));
                // What the model predicts is not in the deviations.
                let responses = responses(step);
                let pairs = step.defect.iter_mut().zip(responses);
                pairs.for_each(|(value, response)| *value -= dot(&response, &torques));
            }
        }
        for (observed, first) in observed.iter_mut().zip(&grid.first) {
            observed.residual *= part;
            if carrier == Carrier::Sensor && *first < record.times.len() {
                let [a, b] = record.times_of(*first).map(&wave);
                observed.residual += 0.5 * (a + b);
            }
        }
        Stretch {
            steps: steps.into(),
            constants: self.stretch.constants.map(|one| part * one),
            observed: observed.into(),
            ..self.stretch.clone()
        }
    }
}
