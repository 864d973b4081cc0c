//! Gauss-Newton iterations: values by the prediction errors, path by the smoother, noise by the marginal likelihood.

use super::super::kalman;
use super::super::likelihood::Stretch;
use super::super::problem::Problem;
use super::super::record::Path;
use super::super::scales::Noise;
use super::super::smoother::Smoothed;
use super::FreeValue;
use super::information::{IdentifiedValue, Information};
use super::trial::{Innovations, MISSING, Trials};
use crate::error::Error;
use crate::numeric::parallel;
use crate::scene::Scene;

/// Most iterations.
const ITERATIONS: usize = 60;

/// Way of a step over the scale of a value, where the record tells little of it.
const WIDTH: f64 = 0.3;

/// Most halvings of a step.
const HALVINGS: usize = 20;

/// Change of values and path, in standard errors, at which the iterations have come to rest.
const AT_REST: f64 = 0.01;

/// Step of differences in standard errors of a value that is free alone: prediction errors are linear along it, and their change is
/// well above rounding.
const STEP: f64 = 0.1;

/// First step of differences over a value.
const FIRST: f64 = 1e-4;

/// ln of the likelihood ratio from which on a missing torque is significant.
const SIGNIFICANT: f64 = 2.0;

/// The search for the largest likelihood.
pub(super) struct Search<'a> {
    trials: Trials<'a>,
    path: Path,
}

/// What the search has found.
#[derive(Debug)]
pub(super) struct Found {
    values: Vec<f64>,
    information: Information,
    pub samples: usize,
    pub sigma: f64,
    pub missing: f64,
    pub misses_torque: bool,
    pub innovations: Vec<f64>,
    pub iterations: usize,
    pub settled: bool,
}

/// Derivatives of the prediction errors, and the step to their minimum.
struct Step {
    information: Information,
    /// To the minimum of the linear model.
    whole: Vec<f64>,
    /// The step that is taken.
    change: Vec<f64>,
}

impl<'a> Search<'a> {
    /// From a motion that was smoothed without mechanics.
    pub fn new(
        scene_at: &'a (dyn Fn(&[f64]) -> Result<Scene, Error> + Sync),
        free: &'a [FreeValue],
        problem: &'a Problem<'a>,
        smooth: &Smoothed,
    ) -> Search<'a> {
        let states = smooth.estimates.iter();
        let states = states.map(|e| [e.state[0], e.state[1], 0.0, 0.0, 0.0]);
        let path = Path::whole(states.collect(), None);
        let motion = problem.motion(MISSING);
        let scales = problem.scales(&motion, &path, smooth.scales.slope, smooth.scales.motion);
        let trials = Trials {
            scene_at,
            free,
            problem,
            scales,
        };
        Search { trials, path }
    }

    /// Iterates until values and path come to rest.
    pub fn run(mut self) -> Result<Found, Error> {
        let trials = &self.trials;
        let mut values: Vec<f64> = trials.free.iter().map(|one| one.start).collect();
        let mut steps: Vec<f64> = trials.free.iter().map(first_step).collect();
        let mut sigma = trials.scales.floor;
        let mut iterations = 0;
        loop {
            iterations += 1;
            let trials = &self.trials;
            let model = trials.model(&values, &self.path, sigma)?;
            let noise = trials.likeliest(&model);
            sigma = noise.sigma;
            let base = trials.innovations(&model, &noise);
            let step = self.step(&values, &steps, &base, &noise)?;
            for (k, h) in steps.iter_mut().enumerate() {
                let size = values[k].abs().max(trials.free[k].scale);
                *h = (STEP * sigma * step.information.error_alone(k)).min(1e-2 * size);
            }
            let taken = self.taken(&values, &step, &base, &noise)?;
            let moved = (0..values.len())
                .map(|k| (taken[k] - values[k]).abs() / (sigma * step.information.error(k)))
                .fold(0.0, f64::max);
            let full = (0..values.len())
                .map(|k| step.whole[k].abs() / (sigma * step.information.error(k)))
                .fold(0.0, f64::max);
            values = taken;
            let model = self.trials.model(&values, &self.path, sigma)?;
            let (turned, innovations) = self.smooth(&model, &noise);
            let settled = full.max(moved).max(turned) < AT_REST;
            if !(settled || iterations == ITERATIONS) {
                continue;
            }
            let trials = &self.trials;
            step.information.is_told(&values, sigma, trials.free)?;
            let without = trials.at(&model, trials.lowest());
            let squares: f64 = self.path.states.iter().map(|s| s[2] * s[2]).sum();
            return Ok(Found {
                values,
                samples: innovations.len(),
                sigma,
                missing: (squares / self.path.states.len() as f64).sqrt(),
                misses_torque: noise.likelihood - without.likelihood > SIGNIFICANT,
                innovations,
                information: step.information,
                iterations,
                settled,
            });
        }
    }

    /// Derivatives by central differences about a fixed path, one-sided where a value may not go further.
    fn step(
        &self,
        values: &[f64],
        steps: &[f64],
        base: &Innovations,
        noise: &Noise,
    ) -> Result<Step, Error> {
        let trials = &self.trials;
        let beside = |k: usize, h: f64| {
            let mut at = values.to_vec();
            at[k] += h;
            let model = trials.model(&at, &self.path, noise.sigma)?;
            Ok::<_, Error>((trials.innovations(&model, noise).errors, h))
        };
        let column = |k: usize| {
            let here = || (base.errors.clone(), 0.0);
            let (after, before) = match (beside(k, steps[k]), beside(k, -steps[k])) {
                (Ok(after), Ok(before)) => (after, before),
                (Ok(after), Err(_)) => (after, here()),
                (Err(_), Ok(before)) => (here(), before),
                (Err(error), Err(_)) => return Err(error),
            };
            let wide = after.1 - before.1;
            let pairs = after.0.iter().zip(&before.0).zip(&base.variances);
            Ok(pairs
                .map(|((a, b), s)| (a - b) / (wide * s.sqrt()))
                .collect::<Vec<f64>>())
        };
        let columns = parallel::list(values.len(), column);
        let columns = columns.into_iter().collect::<Result<Vec<_>, Error>>()?;
        let information = Information::new(&columns, trials.free)?;
        let gradient: Vec<f64> = columns
            .iter()
            .map(|column| {
                let rest = base.errors.iter().zip(&base.variances).zip(column);
                -rest.map(|((e, s), j)| j * e / s.sqrt()).sum::<f64>()
            })
            .collect();
        let widths: Vec<f64> = trials.free.iter().map(|one| WIDTH * one.scale).collect();
        Ok(Step {
            whole: information.solved(&gradient),
            change: information.damped(&gradient, noise.sigma, &widths),
            information,
        })
    }

    /// The values after a step, which is halved until the prediction errors are no larger than before.
    fn taken(
        &self,
        values: &[f64],
        step: &Step,
        base: &Innovations,
        noise: &Noise,
    ) -> Result<Vec<f64>, Error> {
        let squares = base.squares();
        let mut refused = None;
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let pairs = values.iter().zip(&step.change);
            let at: Vec<f64> = pairs.map(|(value, change)| value + part * change).collect();
            part *= 0.5;
            match self.trials.model(&at, &self.path, noise.sigma) {
                Ok(model) => {
                    let found = self.trials.innovations(&model, noise).squares();
                    if found <= squares * (1.0 + 1e-9) {
                        return Ok(at);
                    }
                }
                Err(error) => refused = Some(error),
            }
        }
        match refused {
            None => Ok(values.to_vec()),
            Some(error) => Err(Error::refused(
                format!("the samples drive the free values beyond what a scene may have: {error}"),
                "a value that is as good as 0 is left out of --free; check that the scene has all loads of the rig",
            )),
        }
    }

    /// Moves the path to the smoothed one; the root mean square of its way in standard errors, and the prediction errors in
    /// their standard deviations.
    fn smooth(&mut self, model: &Stretch, noise: &Noise) -> (f64, Vec<f64>) {
        let (deviations, innovations) =
            kalman::smooth::<3>(&self.trials.deviations(model, noise), &mut ());
        let mut sum = 0.0;
        for (state, deviation) in self.path.states.iter_mut().zip(&deviations) {
            for (value, change) in state.iter_mut().zip(&deviation.mean) {
                *value += change;
            }
            let variance = deviation.covariance[0][0] * noise.sigma * noise.sigma;
            let least = (1e-14 * state[0]).powi(2).max(f64::MIN_POSITIVE);
            sum += deviation.mean[0].powi(2) / variance.max(least);
        }
        let told = innovations.into_iter().flatten();
        (
            (sum / deviations.len() as f64).sqrt(),
            told.map(|value| value / noise.sigma).collect(),
        )
    }
}

/// First step of differences.
fn first_step(free: &FreeValue) -> f64 {
    FIRST
        * if free.start == 0.0 {
            free.scale
        } else {
            free.start.abs()
        }
}

impl Found {
    /// The values with their errors.
    pub fn values(&self, free: &[FreeValue], band_factor: f64) -> Vec<IdentifiedValue> {
        let value = |(k, free): (usize, &FreeValue)| {
            let standard_error = self.sigma * self.information.error(k);
            IdentifiedValue {
                key: free.key.clone(),
                unit: free.unit.clone(),
                start: free.start,
                value: self.values[k],
                standard_error,
                half_band: band_factor * standard_error,
            }
        };
        free.iter().enumerate().map(value).collect()
    }

    /// Correlation of each value with each.
    pub fn correlations(&self) -> Vec<Vec<f64>> {
        let all = 0..self.values.len();
        let row = |i: usize| {
            all.clone()
                .map(|j| self.information.correlation(i, j))
                .collect()
        };
        all.clone().map(row).collect()
    }
}
