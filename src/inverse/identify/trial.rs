//! Linear model of a record for trial values of the scene, and its prediction errors.

use super::super::grid::Path;
use super::super::likelihood::Linear;
use super::super::model::kalman;
use super::super::model::prior::TORQUE;
use super::super::model::state_space::with_dimension;
use super::super::problem::Problem;
use super::super::residual_tests::Whiteness;
use super::super::scales::{Noise, Scales};
use super::values::{FreeValue, Optimum};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::scene::Scene;

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
    /// Decay rate of the correlation of the sample noise, 1/s; none for white noise.
    pub correlated: Option<f64>,
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

impl<'a> Trials<'a> {
    /// Returns the free values.
    pub fn free(&self) -> &'a [FreeValue] {
        &self.all[..self.count]
    }

    /// Applies a function to the record with the mechanism of these values.
    pub fn with<T>(&self, values: &[f64], f: impl FnOnce(&Problem<'_>) -> T) -> Result<T, Error> {
        let scene = (self.scene_at)(values)?;
        let equation = Equation::new(&scene);
        let pairs = self.all.iter().zip(values);
        let of_sensor = pairs.filter(|(free, _)| free.is_sensor_zero);
        let zero: f64 = of_sensor.map(|(_, value)| *value).sum();
        let scale = self.problem.record.sensor.scale;
        Ok(f(&self.problem.moved(&equation, scale, -zero)))
    }

    /// Returns the linear model about a path for these values.
    pub fn model(&self, values: &[f64], path: &Path, sigma: f64) -> Result<Linear, Error> {
        self.with(values, |problem| Linear {
            stretches: vec![problem.stretch(TORQUE, path, 0..problem.grid.len(), sigma)].into(),
            ..Linear::of(TORQUE, self.scales)
        })
    }

    /// Returns the prediction errors of a model.
    pub fn innovations(model: &Linear, noise: &Noise) -> Innovations {
        let mut list = Innovations::default();
        for stretch in model.stretches.iter() {
            let model = model.deviations(stretch, noise);
            with_dimension!(model.dimension(), N => {
                kalman::run::<N>(&model, None, |_, at| {
                    if let Some((_, found)) = &at.sample {
                        list.errors.push(found.error);
                        list.variances.push(found.variance);
                    }
                });
            });
        }
        list
    }

    /// Evaluates the likelihood where the missing torque has no effect on the samples.
    pub fn without_torque(&self, model: &Linear) -> Noise {
        let [lowest, _] = self.scales.corners();
        model.evaluated(Noise {
            correlated: self.correlated,
            ..Noise::white(lowest)
        })
    }

    /// Returns the decay rate of the correlation of the sample noise beside these values, 1/s; none if their residuals are
    /// white, or if it is not likelier than its two parameters cost (Schwarz 1978) beside a missing torque with white noise.
    pub fn correlation(&self, at: &Optimum) -> Result<Option<f64>, Error> {
        let is_white = !Whiteness::of(at.innovations.iter().copied()).is_violated();
        if is_white || self.noise.is_infinite() || self.problem.is_computed() {
            return Ok(None);
        }
        let model = self.model(&at.values, &at.path, at.noise.sigma)?;
        let white = model.anywhere(self.correlated);
        let other = model.correlated(&white);
        let cost = (at.innovations.len() as f64).ln();
        Ok(other
            .correlated
            .filter(|_| other.likelihood > white.likelihood + cost))
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
            Ok::<_, Error>((Trials::innovations(&model, noise).errors, h))
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
