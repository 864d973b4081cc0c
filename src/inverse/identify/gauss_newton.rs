//! Gauss-Newton iterations for free values (prediction errors), path (smoother) and noise (marginal likelihood).

use super::super::candidates::Candidate;
use super::super::grid::Path;
use super::super::maximum::ENOUGH_RISE;
use super::super::model::prior::{TORQUE, plain_state};
use super::super::problem::Problem;
use super::super::scales::{Noise, Scales};
use super::super::smoother::{Correction, Smoothed};
use super::information::Information;
use super::misfit::Misfit;
use super::trial::{Innovations, Trials};
use super::values::{FreeValue, Optimum};
use crate::error::Error;
use crate::numeric::parallel;
use crate::scene::Scene;

/// Maximum number of Gauss-Newton iterations.
const ITERATIONS: usize = 60;

/// Maximum number of halvings of a step.
const STEP_HALVINGS: usize = 20;

/// Change of values and path, in standard errors, below which the iterations have converged.
const VALUES_AT_REST: f64 = 0.01;

/// Difference step of a value, in the standard error that it has if free alone: prediction errors are linear along it,
/// and their change is well above rounding.
const STEP: f64 = 0.1;

/// Search for the maximum of the marginal likelihood.
pub(super) struct Search<'a> {
    trials: Trials<'a>,
    path: Path,
}

/// Gauss-Newton step with the Fisher information at its start.
struct Step {
    information: Information,
    /// Change of the values to the minimum of the linear model, tried in full and then halved.
    change: Vec<f64>,
}

impl<'a> Search<'a> {
    /// Creates the search from a motion that was smoothed without mechanics.
    pub fn new(
        scene_at: &'a (dyn Fn(&[f64]) -> Result<Scene, Error> + Sync),
        all: &'a [FreeValue],
        count: usize,
        problem: &'a Problem<'a>,
        smooth: &Smoothed,
    ) -> Search<'a> {
        let states = smooth.estimates.iter();
        let states = states.map(|e| plain_state([e.state[0], e.state[1], 0.0]));
        let path = Path::whole(states.collect());
        let scales = Scales {
            identified: Some(count),
            acceleration: smooth.scales.acceleration,
            ..problem.scales(TORQUE, &path, smooth.scales.slope, smooth.noise.sigma)
        };
        let trials = Trials {
            scene_at,
            all,
            count,
            problem,
            scales,
            noise: match smooth.scales.known {
                Some(_) => f64::INFINITY,
                None => smooth.noise.sigma,
            },
            correlated: None,
        };
        Search { trials, path }
    }

    /// Maximises the likelihood without a missing torque first, and with one from the values found: beside a torque
    /// that follows every misfit of a first guess the values are not determined. Returns the maximum, and the misfit of the equation
    /// without a torque beside it; none if it describes the record.
    pub fn run(mut self) -> Result<(Optimum, Option<Misfit>), Error> {
        let start: Vec<f64> = self.trials.free().iter().map(|one| one.start).collect();
        let first = self.path.clone();
        let mut alone = self.climbed(start.clone(), false).ok();
        // The noise is judged beside the values found: what a first guess of them leaves is correlated, too.
        if let Some(found) = alone.as_ref().filter(|found| found.settled) {
            self.trials.correlated = self.trials.correlation(found)?;
            if self.trials.correlated.is_some() {
                alone = self.climbed(found.values.clone(), false).ok();
            }
        }
        let from = match alone.as_ref().filter(|found| found.settled) {
            Some(found) => found.values.clone(),
            None => {
                self.path = first;
                start
            }
        };
        let best = self.climbed(from, true);
        let trials = &self.trials;
        let settled = alone.as_ref().filter(|found| found.settled);
        // Values at which a search broke off say nothing of the equation.
        let at = settled.or(best.as_ref().ok());
        let misfit = at.map(|at| Misfit::of(trials, at)).transpose()?.flatten();
        let refused = |error: Error| misfit.as_ref().map_or(error, Misfit::refused);
        let best = best.map_err(refused)?;
        best.information
            .is_told(&best.values, best.noise.sigma, trials.free())
            .map_err(refused)?;
        Ok((best, misfit))
    }

    /// Iterates until values and path converge, with a missing torque beside the equation or without.
    fn climbed(&mut self, mut values: Vec<f64>, with_torque: bool) -> Result<Optimum, Error> {
        let steps = self.trials.free().iter().map(FreeValue::first_step);
        let mut steps: Vec<f64> = steps.collect();
        let mut sigma = self.trials.scales.floor;
        let mut last = None;
        let mut iterations = 0;
        loop {
            iterations += 1;
            let trials = &self.trials;
            let model = trials.model(&values, &self.path, sigma)?;
            let noise = match (with_torque, last) {
                (false, _) => trials.without_torque(&model),
                (true, None) => model.anywhere(trials.correlated),
                (true, Some(last)) => {
                    let here = model.evaluated(last);
                    let found = model.improved(here);
                    match found.likelihood - here.likelihood > ENOUGH_RISE {
                        true => found,
                        false => here,
                    }
                }
            };
            last = Some(noise);
            sigma = noise.sigma;
            let base = Trials::innovations(&model, &noise);
            let step = self.step(&values, &steps, &base, &noise)?;
            for (k, h) in steps.iter_mut().enumerate() {
                let size = values[k].abs().max(trials.free()[k].scale);
                *h = (STEP * sigma * step.information.error_alone(k)).min(1e-2 * size);
            }
            let (taken, part) = match self.taken(&values, &step, &base, &noise) {
                Ok(taken) => taken,
                // Without a missing torque the iterations end at these values.
                Err(_) if !with_torque => (values.clone(), 0.0),
                Err(error) => return Err(error),
            };
            let full = (0..values.len())
                .map(|k| step.change[k].abs() / (sigma * step.information.error(k)))
                .fold(0.0, f64::max);
            values = taken;
            let (turned, innovations) = self.smooth(&values, &noise)?;
            let settled = full.max(turned) < VALUES_AT_REST;
            if settled || part == 0.0 && !with_torque || iterations == ITERATIONS {
                return Ok(Optimum {
                    values,
                    information: step.information,
                    noise,
                    path: self.path.clone(),
                    innovations,
                    iterations,
                    settled,
                });
            }
        }
    }

    /// Computes a step from central differences about a fixed path, one-sided at the limit of a value's range.
    fn step(
        &self,
        values: &[f64],
        steps: &[f64],
        base: &Innovations,
        noise: &Noise,
    ) -> Result<Step, Error> {
        let trials = &self.trials;
        let column = |k: usize| trials.derivatives(values, k, steps[k], &self.path, base, noise);
        let columns = parallel::list(values.len(), column);
        let columns = columns.into_iter().collect::<Result<Vec<_>, Error>>()?;
        let information = Information::new(&columns, values, trials.free())?;
        let gradient: Vec<f64> = columns
            .iter()
            .map(|column| {
                let rest = base.errors.iter().zip(&base.variances).zip(column);
                -rest.map(|((e, s), j)| j * e / s.sqrt()).sum::<f64>()
            })
            .collect();
        Ok(Step {
            change: information.solved(&gradient),
            information,
        })
    }

    /// Halves a step until the squared prediction errors do not grow; returns the values and the fraction taken.
    fn taken(
        &self,
        values: &[f64],
        step: &Step,
        base: &Innovations,
        noise: &Noise,
    ) -> Result<(Vec<f64>, f64), Error> {
        let squares = base.squares(&base.errors);
        let mut refused = None;
        let mut part = 1.0;
        for _ in 0..STEP_HALVINGS {
            let pairs = values.iter().zip(&step.change);
            let at: Vec<f64> = pairs.map(|(value, change)| value + part * change).collect();
            match self.trials.model(&at, &self.path, noise.sigma) {
                Ok(model) => {
                    let found = base.squares(&Trials::innovations(&model, noise).errors);
                    if found <= squares * (1.0 + 1e-9) {
                        return Ok((at, part));
                    }
                }
                Err(error) => refused = Some(error),
            }
            part *= 0.5;
        }
        match refused {
            None => Ok((values.to_vec(), 0.0)),
            Some(error) => Err(self.beyond(values, step, noise.sigma, &error)),
        }
    }

    /// Returns the error of a step that fails at every fraction, and names the values that no scene may have.
    fn beyond(&self, values: &[f64], step: &Step, sigma: f64, error: &Error) -> Error {
        let mut words = Vec::new();
        for (k, free) in self.trials.free().iter().enumerate() {
            let mut at = values.to_vec();
            at[k] += step.change[k];
            if (self.trials.scene_at)(&at).is_err() {
                let se = sigma * step.information.error(k);
                let (key, unit) = (&free.key, &free.unit);
                words.push(format!(
                    "`{key}` = {:.3e} {unit} with a standard error of {se:.1e}",
                    at[k]
                ));
            }
        }
        let what = match words.is_empty() {
            true => {
                format!("the samples drive the free values beyond what a scene may have: {error}")
            }
            false => format!(
                "the samples are likeliest for {}, which no scene may have",
                words.join(" and ")
            ),
        };
        Error::refused(
            what,
            "a value that is as good as 0 is left out of --free; check that the scene has all loads of the rig",
        )
    }

    /// Moves the path to the smoothed one; returns the root mean square change of the crank angle in standard errors,
    /// and the standardised prediction errors.
    fn smooth(&mut self, values: &[f64], noise: &Noise) -> Result<(f64, Vec<f64>), Error> {
        let Search { trials, path } = self;
        let candidate = Candidate {
            prior: TORQUE,
            noise: *noise,
            scales: trials.scales,
        };
        let estimates = trials.with(values, |problem| problem.smoothed(path, &candidate))?;
        let innovations = estimates.iter().map(|e| e.innovation);
        let told = innovations.filter(|value| value.is_finite()).collect();
        Ok((Correction::default().taken(path, &estimates), told))
    }
}
