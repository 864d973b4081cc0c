//! Errors that all samples share: uncertain values of the scene, zero of an encoder. Standard errors of the force are
//! its changes by one standard error of a source in fit and equation, with the noise of the fit held fixed (GUM 5.1.3).

use serde::Serialize;

use super::super::measurement_model::Scale;
use super::super::motion_estimate::MotionEstimate;
use super::super::polynomial::Polynomial;
use super::super::problem::Problem;
use super::super::record::Record;
use super::super::row::InverseRow;
use super::super::smoother::Smoothed;
use super::super::turns::alignment;
use super::inverse_dynamics::{Guide, InverseDynamics};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::parallel;
use crate::scene::{Measurement, MovedScene, Scene};

/// Share of a source in the variance of the slider force.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BudgetShare {
    /// Key of the scene, or name of another source.
    pub source: String,
    /// Standard error of the slider force by this source, N, root mean square over the rows with a force.
    pub force_se_n: f64,
    /// Fraction of the variance.
    pub share: f64,
}

/// Source of error: the mechanism changed by one standard error, and the shift of the samples, rad.
#[derive(Debug)]
pub(in crate::inverse) struct Source {
    name: String,
    equation: Equation,
    guide: Option<Guide>,
    zero: f64,
}

/// Lists the sources: uncertain values of the scene, and the zero of an encoder by its standard error, rad.
pub(in crate::inverse) fn sources(
    scene: &Scene,
    uncertain: &[MovedScene],
    measurement: &Measurement,
    zero: Option<f64>,
) -> Result<Vec<Source>, Error> {
    let source = |name: &str, scene: &Scene, zero: f64| {
        Ok(Source {
            name: name.to_owned(),
            equation: Equation::new(scene),
            guide: Guide::new(scene)?,
            zero,
        })
    };
    let of_scene = uncertain
        .iter()
        .map(|one| source(&one.key, &measurement.known_in(&one.moved)?, 0.0));
    let of_zero = zero.map(|zero| source("zero of the encoder", scene, zero));
    of_scene.chain(of_zero).collect()
}

impl Source {
    /// Returns the scale of a position sensor that is aligned with the changed mechanism.
    fn scale(&self, record: &Record<'_>, measurement: &Measurement) -> Scale {
        alignment::realigned(&record.sensor, self.equation.linkage(), measurement)
    }

    /// Returns θ, ω, θ̈ of the polynomial of a degree under this error.
    pub fn polynomial(
        &self,
        record: &Record<'_>,
        motion: &[MotionEstimate],
        degree: usize,
        measurement: &Measurement,
    ) -> Vec<[f64; 3]> {
        let theta: Vec<f64> = motion.iter().map(|m| m.value[0] + self.zero).collect();
        let scale = self.scale(record, measurement);
        let record = record.moved(self.equation.linkage(), scale, self.zero);
        let found = Polynomial::new(&record, &theta, Some(degree));
        let found = found.map_or_else(|_| motion.to_vec(), |found| found.motion);
        found.iter().map(|state| state.value).collect()
    }

    /// Returns θ, ω, θ̈ of the smoothed motion under this error, one Gauss-Newton step from the motion without it.
    pub fn smoothed(
        &self,
        problem: &Problem<'_>,
        smoothed: &Smoothed,
        measurement: &Measurement,
    ) -> Vec<[f64; 3]> {
        let times = measurement.elapsed();
        let scale = self.scale(&problem.record, measurement);
        let problem = problem.moved(&self.equation, scale, self.zero);
        let mut path = smoothed.path();
        path.states
            .iter_mut()
            .for_each(|state| state[0] += self.zero);
        let moved = Smoothed {
            estimates: problem.smoothed(&mut path, &smoothed.candidate()),
            ..smoothed.clone()
        };
        parallel::list(times.len(), |i| problem.at(&moved, times[i]).motion())
    }
}

/// Standard errors by each source that all rows share.
#[derive(Debug)]
pub(in crate::inverse) struct SharedErrors(Vec<SharedError>);

/// Standard errors by one source.
#[derive(Debug)]
struct SharedError {
    /// Name of the source.
    name: String,
    /// Errors of force, N, and torque, N m, of each row.
    of: Vec<[f64; 2]>,
}

impl SharedErrors {
    /// Computes the errors from the motion of the samples and the motions under each source.
    pub fn new(
        sources: &[Source],
        backwards: &InverseDynamics<'_>,
        motion: &[MotionEstimate],
        moved: &[Vec<[f64; 3]>],
        times: &[f64],
    ) -> SharedErrors {
        let of = |(source, moved): (&Source, &Vec<[f64; 3]>)| {
            let there = InverseDynamics {
                equation: &source.equation,
                guide: source.guide.as_ref(),
                ..*backwards
            };
            let of = parallel::list(times.len(), |i| {
                let here = motion[i].value;
                let a = backwards.needed(times[i], here, here[1]);
                let b = there.needed(times[i], moved[i], here[1]);
                [0, 1].map(|k| b[k] - a[k])
            });
            let name = source.name.clone();
            SharedError { name, of }
        };
        SharedErrors(sources.iter().zip(moved).map(of).collect())
    }

    /// Returns the standard errors of the force, N, and of the torque, N m, of a row, with those of its noise.
    pub fn with(&self, row: usize, noise: [f64; 2]) -> [f64; 2] {
        self.0.iter().fold(noise, |sum, one| {
            [0, 1].map(|k| sum[k].hypot(one.of[row][k]))
        })
    }

    /// Returns the shares of the sources in the variance of the force, the largest first; empty if there is only noise.
    pub fn budget(&self, rows: &[InverseRow]) -> Vec<BudgetShare> {
        let errors = rows.iter().map(|row| row.slider_force_se).enumerate();
        let known = errors.filter_map(|(row, se)| Some((row, se?)));
        let count = known.clone().count() as f64;
        if self.0.is_empty() || count == 0.0 {
            return Vec::new();
        }
        let whole = known.clone().map(|(_, se)| se * se).sum::<f64>() / count;
        let part = |one: &SharedError| {
            let squares = known.clone().map(|(row, _)| one.of[row][0].powi(2));
            (one.name.clone(), squares.sum::<f64>() / count)
        };
        let mut parts: Vec<_> = self.0.iter().map(part).collect();
        let rest = whole - parts.iter().map(|(_, part)| part).sum::<f64>();
        parts.push(("noise of the samples".to_owned(), rest.max(0.0)));
        parts.sort_by(|a, b| b.1.total_cmp(&a.1));
        parts.retain(|(_, part)| *part > 0.0);
        let share = |(source, variance): (String, f64)| BudgetShare {
            source,
            force_se_n: variance.sqrt(),
            share: variance / whole,
        };
        parts.into_iter().map(share).collect()
    }
}
