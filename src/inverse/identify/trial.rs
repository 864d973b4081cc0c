//! Linear model of a record for trial values of the scene, and its prediction errors.

use std::borrow::Cow;

use super::super::grid::Path;
use super::super::kalman::{self, Companion, Innovation, Sample};
use super::super::likelihood::{Linear, Stretch};
use super::super::maximum::{ENOUGH_RISE, climb};
use super::super::measurement_model::{Scale, Sensor};
use super::super::prior::{Prior, Unknown};
use super::super::problem::Problem;
use super::super::record::Record;
use super::super::scales::{Autoregression, Intensities, Noise, Scales};
use super::super::state_space::Deviations;
use super::values::FreeValue;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::scene::Scene;

/// Prior of the torque that the scene misses: a Wiener process.
pub(super) const MISSING: Prior = Prior::new(Unknown::Torque, 1);

/// Scene as a function of its free values, and the record.
pub(super) struct Trials<'a> {
    pub scene_at: &'a (dyn Fn(&[f64]) -> Result<Scene, Error> + Sync),
    /// Free values, followed by the candidates of score tests.
    pub all: &'a [FreeValue],
    /// Number of free values, the first of `all`.
    pub count: usize,
    pub problem: &'a Problem<'a>,
    pub scales: Scales,
    /// Standard deviation of a sample about the motion without mechanics, rad or m; infinite for codes (known noise).
    pub noise: f64,
    /// First-order autoregression of the sample noise, if the smoothed motion has one.
    pub correlated: Option<Autoregression>,
}

/// Prediction errors, rad or m, with their variances in units of σ².
#[derive(Clone, Debug, Default)]
pub(super) struct Innovations {
    pub errors: Vec<f64>,
    pub variances: Vec<f64>,
}

impl Innovations {
    /// Returns Σ e²/S with these variances S, which are held fixed along a step and do not enter its gradient.
    pub fn squares(&self, errors: &[f64]) -> f64 {
        let pairs = errors.iter().zip(&self.variances);
        pairs.map(|(e, s)| e * e / s).sum()
    }

    /// Returns the errors over their standard deviations, in units of σ.
    pub fn standardised(&self) -> Vec<f64> {
        let pairs = self.errors.iter().zip(&self.variances);
        pairs.map(|(e, s)| e / s.sqrt()).collect()
    }
}

impl<const N: usize> Companion<N> for Innovations {
    fn updated(&mut self, _: usize, _: &Sample<N>, found: &Innovation<N>) {
        self.errors.push(found.error);
        self.variances.push(found.variance);
    }
}

impl<'a> Trials<'a> {
    /// Returns the free values.
    pub fn free(&self) -> &'a [FreeValue] {
        &self.all[..self.count]
    }

    /// Returns the linear model about a path for these values.
    pub fn model(&self, values: &[f64], path: &Path, sigma: f64) -> Result<Stretch, Error> {
        let scene = (self.scene_at)(values)?;
        let equation = Equation::new(&scene);
        let of_sensor = self.all.iter().zip(values);
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
            intensities: Intensities::default(),
            stop: None,
        };
        let motion = problem.motion(MISSING);
        Ok(problem.stretch(&motion, path, 0..problem.grid.len(), sigma))
    }

    /// Returns the state-space model of the deviations from the path; u begins at 0.
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

    /// Returns the prediction errors of a model.
    pub fn innovations(&self, model: &Stretch, noise: &Noise) -> Innovations {
        let mut found = Innovations::default();
        let deviations = self.deviations(model, noise);
        match self.correlated {
            None => drop(kalman::run::<3>(&deviations, None, &mut found)),
            Some(_) => drop(kalman::run::<4>(&deviations, None, &mut found)),
        }
        found
    }

    /// Evaluates the marginal likelihood and σ at a corner frequency, rad/s, of the missing torque.
    pub fn at(&self, model: &Stretch, corner: f64) -> Noise {
        let mut noise = Noise {
            correlated: self.correlated,
            ..Noise::white(corner)
        };
        let deviations = self.deviations(model, &noise);
        let evidence = match self.correlated {
            None => kalman::evidence::<3>(&deviations),
            Some(_) => kalman::evidence::<4>(&deviations),
        };
        let free = (evidence.samples as f64 - 2.0 - self.count as f64).max(1.0);
        noise.sigma = (evidence.squares / free).sqrt().max(self.scales.floor);
        let likelihood = -free * noise.sigma.ln()
            - 0.5 * (evidence.log_variances + evidence.squares / noise.sigma.powi(2));
        if likelihood.is_finite() {
            noise.likelihood = likelihood;
        }
        noise
    }

    /// Returns the corner frequency, rad/s, at which the missing torque has no effect on the samples.
    pub fn lowest(&self) -> f64 {
        0.1 / self.scales.duration
    }

    /// Maximises the likelihood over the corner frequency, from the best point of a grid.
    pub fn likeliest(&self, model: &Stretch) -> Noise {
        let (low, high) = (self.lowest().ln(), (30.0 / self.scales.spacing).ln());
        let count = (high - low).ceil().max(1.0);
        let guesses = (0..=count as usize).map(|k| low + (high - low) * k as f64 / count);
        let best = guesses
            .map(|log| (log, self.at(model, log.exp())))
            .max_by(|a, b| a.1.likelihood.total_cmp(&b.1.likelihood));
        let (guess, first) = best.unwrap_or_else(|| (low, self.at(model, low.exp())));
        climb(
            |log| self.at(model, log.exp()),
            guess,
            first,
            [low, high],
            0.0,
        )
    }

    /// Maximises the likelihood near this corner frequency, rad/s; keeps it where the gain is below `ENOUGH_RISE`.
    pub fn likelier(&self, model: &Stretch, corner: f64) -> Noise {
        let (low, high) = (self.lowest().ln(), (30.0 / self.scales.spacing).ln());
        let here = self.at(model, corner);
        let found = climb(
            |log| self.at(model, log.exp()),
            corner.ln(),
            here,
            [low, high],
            0.0,
        );
        match found.likelihood - here.likelihood > ENOUGH_RISE {
            true => found,
            false => here,
        }
    }

    /// Computes the derivatives of the standardised prediction errors by one value: central differences about a fixed
    /// path, one-sided at the limit of the value's range.
    pub fn derivatives(
        &self,
        values: &[f64],
        k: usize,
        step: f64,
        path: &Path,
        base: &Innovations,
        noise: &Noise,
    ) -> Result<Vec<f64>, Error> {
        let beside = |h: f64| {
            let mut at = values.to_vec();
            at[k] += h;
            let model = self.model(&at, path, noise.sigma)?;
            Ok::<_, Error>((self.innovations(&model, noise).errors, h))
        };
        let here = || (base.errors.clone(), 0.0);
        let (after, before) = match (beside(step), beside(-step)) {
            (Ok(after), Ok(before)) => (after, before),
            (Ok(after), Err(_)) => (after, here()),
            (Err(_), Ok(before)) => (here(), before),
            (Err(error), Err(_)) => return Err(error),
        };
        let wide = after.1 - before.1;
        let pairs = after.0.iter().zip(&before.0).zip(&base.variances);
        Ok(pairs
            .map(|((a, b), s)| (a - b) / (wide * s.sqrt()))
            .collect())
    }
}
