//! The linear model of the record for trial values, and its prediction errors.

use std::borrow::Cow;

use super::super::kalman::{self, Companion, Innovation, Sample};
use super::super::likelihood::{Linear, Stretch};
use super::super::maximum::climb;
use super::super::measurement_model::{Scale, Sensor};
use super::super::prior::{Prior, Unknown};
use super::super::problem::Problem;
use super::super::record::{Path, Record};
use super::super::scales::{Noise, Scales};
use super::super::state_space::Deviations;
use super::FreeValue;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::scene::Scene;

/// What the scene misses: a torque as a Wiener process.
pub(super) const MISSING: Prior = Prior::new(Unknown::Torque, 1);

/// The scene with its free values, and the record.
pub(super) struct Trials<'a> {
    pub scene_at: &'a (dyn Fn(&[f64]) -> Result<Scene, Error> + Sync),
    pub free: &'a [FreeValue],
    pub problem: &'a Problem<'a>,
    pub scales: Scales,
}

/// Prediction errors with their variances in units of σ².
#[derive(Clone, Debug, Default)]
pub(super) struct Innovations {
    pub errors: Vec<f64>,
    pub variances: Vec<f64>,
}

impl Innovations {
    /// Sum of squares of the standardised errors.
    pub fn squares(&self) -> f64 {
        let pairs = self.errors.iter().zip(&self.variances);
        pairs.map(|(e, s)| e * e / s).sum()
    }
}

impl Companion<3> for Innovations {
    fn updated(&mut self, _: usize, _: &Sample<3>, found: &Innovation<3>) {
        self.errors.push(found.error);
        self.variances.push(found.variance);
    }
}

impl Trials<'_> {
    /// The linear model about a path, for these values.
    pub fn model(&self, values: &[f64], path: &Path, sigma: f64) -> Result<Stretch, Error> {
        let scene = (self.scene_at)(values)?;
        let equation = Equation::new(&scene);
        let of_sensor = self.free.iter().zip(values);
        let zero: f64 = of_sensor
            .filter(|(free, _)| free.is_sensor_zero)
            .map(|(_, value)| *value)
            .sum();
        let record = &self.problem.record;
        let problem = Problem {
            record: Record {
                sensor: Sensor {
                    linkage: equation.linkage(),
                    measured: record.sensor.measured,
                    scale: Scale::TRUE,
                },
                times: Cow::Borrowed(&record.times),
                values: record.values.iter().map(|value| value - zero).collect(),
                weights: record.weights.clone(),
                codes: None,
                intervals: Vec::new(),
                beside: Vec::new(),
                ..*record
            },
            grid: self.problem.grid.clone(),
            equation: &equation,
            stop: None,
        };
        let motion = problem.motion(MISSING);
        Ok(problem.stretch(&motion, path, 0..problem.grid.len(), sigma))
    }

    /// The deviations from the path; u begins at 0.
    pub fn deviations<'b>(&self, model: &'b Stretch, noise: &Noise) -> Deviations<'b> {
        let linear = Linear {
            stretches: &[],
            prior: MISSING,
            scales: self.scales,
        };
        let mut deviations = linear.deviations(model, noise);
        deviations.spread[2] = 0.0;
        deviations
    }

    /// Prediction errors of a model.
    pub fn innovations(&self, model: &Stretch, noise: &Noise) -> Innovations {
        let mut found = Innovations::default();
        kalman::run::<3>(&self.deviations(model, noise), &mut found);
        found
    }

    /// Marginal likelihood and σ for a corner frequency of the missing torque.
    pub fn at(&self, model: &Stretch, corner: f64) -> Noise {
        let mut noise = Noise::white(corner);
        let evidence = kalman::evidence::<3>(&self.deviations(model, &noise));
        let free = (evidence.samples as f64 - 2.0 - self.free.len() as f64).max(1.0);
        noise.sigma = (evidence.squares / free).sqrt().max(self.scales.floor);
        let likelihood = -free * noise.sigma.ln()
            - 0.5 * (evidence.log_variances + evidence.squares / noise.sigma.powi(2));
        if likelihood.is_finite() {
            noise.likelihood = likelihood;
        }
        noise
    }

    /// Corner frequency, rad/s, at which the missing torque leaves nothing in the samples.
    pub fn lowest(&self) -> f64 {
        0.1 / self.scales.duration
    }

    /// The largest likelihood over the corner frequency.
    pub fn likeliest(&self, model: &Stretch) -> Noise {
        let (low, high) = (self.lowest().ln(), (30.0 / self.scales.spacing).ln());
        let count = (high - low).ceil().max(1.0);
        let guesses = (0..=count as usize).map(|k| low + (high - low) * k as f64 / count);
        let best = guesses
            .map(|log| (log, self.at(model, log.exp())))
            .max_by(|a, b| a.1.likelihood.total_cmp(&b.1.likelihood));
        let (guess, first) = best.unwrap_or_else(|| (low, self.at(model, low.exp())));
        climb(|log| self.at(model, log.exp()), guess, first, [low, high])
    }
}
