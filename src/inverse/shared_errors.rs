//! Errors that all samples share: an uncertain value of the scene, the zero of an encoder. Each is carried through the fit and
//! the equation by a standard error to both sides, with the noise of the fit as it is (GUM 5.1.3, numerically).

use serde::Serialize;

use super::guide::Guide;
use super::inverse_dynamics::Backwards;
use super::measurement_model::Sensor;
use super::motion_estimate::MotionEstimate;
use super::polynomial::Polynomial;
use super::problem::Problem;
use super::record::{Path, Record};
use super::row::InverseRow;
use super::smoother::Smoothed;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::parallel;
use crate::scene::{Measurement, Scene};

/// A value of the scene with its standard error.
#[derive(Clone, Debug)]
pub struct UncertainValue {
    /// Name, as `geometry.rod`.
    pub key: String,
    /// The scene with the value a standard error lower, and higher.
    pub ends: [Scene; 2],
}

/// Share of a source in the error of the slider force.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BudgetShare {
    /// Key of the scene, or what else is uncertain.
    pub source: String,
    /// Standard error of the slider force that it makes, N, root mean square over the rows with a force.
    pub force_se_n: f64,
    /// Part of the variance.
    pub share: f64,
}

/// A source with the mechanism at both ends of its error.
#[derive(Debug)]
pub(super) struct Source {
    name: String,
    ends: [End; 2],
}

/// A mechanism, and what is added to the samples, rad.
#[derive(Debug)]
struct End {
    equation: Equation,
    guide: Option<Guide>,
    zero: f64,
}

impl End {
    fn new(scene: &Scene, zero: f64) -> Result<End, Error> {
        Ok(End {
            equation: Equation::new(scene),
            guide: Guide::new(scene)?,
            zero,
        })
    }
}

/// What is uncertain: values of the scene, and by a standard error (rad) the zero of an encoder.
pub(super) fn sources(
    scene: &Scene,
    uncertain: &[UncertainValue],
    zero: Option<f64>,
) -> Result<Vec<Source>, Error> {
    let source = |name: &str, [low, high]: [&Scene; 2], zero: f64| {
        Ok(Source {
            name: name.to_owned(),
            ends: [End::new(low, -zero)?, End::new(high, zero)?],
        })
    };
    let of_scene = uncertain
        .iter()
        .map(|one| source(&one.key, one.ends.each_ref(), 0.0));
    let of_zero = zero.map(|zero| source("zero of the encoder", [scene; 2], zero));
    of_scene.chain(of_zero).collect()
}

/// Motions at both ends of a source.
pub(super) type Moved = [Vec<MotionEstimate>; 2];

/// The motions that a smoother finds at the ends of the sources.
pub(super) fn moved(problem: &Problem<'_>, smoothed: &Smoothed, sources: &[Source]) -> Vec<Moved> {
    parallel::map(sources.iter(), |source| {
        source
            .ends
            .each_ref()
            .map(|end| end.smoothed(problem, smoothed))
    })
}

/// The polynomials of a degree at the ends of the sources.
pub(super) fn moved_polynomials(
    record: &Record<'_>,
    motion: &[MotionEstimate],
    degree: usize,
    sources: &[Source],
) -> Vec<Moved> {
    let of = |source: &Source| {
        source
            .ends
            .each_ref()
            .map(|end| end.polynomial(record, motion, degree))
    };
    sources.iter().map(of).collect()
}

/// Iterations of Gauss and Newton: the ends are near.
const ITERATIONS: usize = 3;

impl End {
    fn record<'a>(&'a self, record: &'a Record<'a>) -> Record<'a> {
        Record {
            sensor: Sensor {
                linkage: self.equation.linkage(),
                ..record.sensor
            },
            times: record.times.as_ref().into(),
            values: record
                .values
                .iter()
                .map(|value| value + self.zero)
                .collect(),
            weights: record.weights.clone(),
            codes: None,
            ..*record
        }
    }

    fn polynomial(
        &self,
        record: &Record<'_>,
        motion: &[MotionEstimate],
        degree: usize,
    ) -> Vec<MotionEstimate> {
        let theta: Vec<f64> = motion.iter().map(|m| m.value[0] + self.zero).collect();
        let found = Polynomial::new(&self.record(record), &theta, Some(degree));
        found.map_or_else(|_| motion.to_vec(), |found| found.motion)
    }

    fn smoothed(&self, problem: &Problem<'_>, smoothed: &Smoothed) -> Vec<MotionEstimate> {
        let record = &problem.record;
        let problem = Problem {
            record: self.record(record),
            grid: problem.grid.clone(),
            equation: &self.equation,
        };
        let motion = problem.motion(smoothed.prior);
        let variances = || smoothed.estimates.iter().map(|e| e.covariance[0]).collect();
        let mut path = Path {
            states: smoothed.estimates.iter().map(|e| e.state).collect(),
            variances: (!record.is_linear()).then(variances),
        };
        path.states
            .iter_mut()
            .for_each(|state| state[0] += self.zero);
        let mut estimates = Vec::new();
        for _ in 0..ITERATIONS {
            estimates = problem.smoothed(&motion, &path, smoothed.scales, &smoothed.noise);
            path.states = estimates.iter().map(|e| e.state).collect();
        }
        parallel::list(record.times.len(), |i| {
            problem.at_sample(&estimates, i).estimated()
        })
    }
}

/// Standard errors of force, N, and torque, N m, of each row by each source.
#[derive(Debug, Default)]
pub(super) struct SharedErrors {
    names: Vec<String>,
    of: Vec<Vec<[f64; 2]>>,
}

impl SharedErrors {
    pub fn new(
        sources: &[Source],
        moved: &[Moved],
        measurement: &Measurement,
        beside_forces: bool,
    ) -> SharedErrors {
        let mut found = SharedErrors::default();
        for (source, motions) in sources.iter().zip(moved) {
            let [low, high] = [0, 1].map(|k| {
                let end = &source.ends[k];
                let backwards = Backwards {
                    equation: &end.equation,
                    beside_forces,
                    guide: end.guide.as_ref(),
                };
                parallel::list(motions[k].len(), |i| {
                    let demand = backwards.demand(measurement.times()[i], &motions[k][i]);
                    [demand.force, demand.torque]
                })
            });
            let pairs = low.iter().zip(&high);
            let halves = pairs.map(|(a, b)| [0, 1].map(|k| 0.5 * (b[k] - a[k])));
            found.of.push(halves.collect());
            found.names.push(source.name.clone());
        }
        found
    }

    /// Standard error of the force, N, and of the torque, N m, of a row, with those of its noise.
    pub fn with(&self, row: usize, noise: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            self.of
                .iter()
                .fold(noise[k], |sum, of| sum.hypot(of[row][k]))
        })
    }

    /// The sources with their shares in the error of the force, the largest first; nothing where there is but noise.
    pub fn budget(&self, rows: &[InverseRow]) -> Vec<BudgetShare> {
        let errors = rows.iter().map(|row| row.slider_force_se);
        let known: Vec<(usize, f64)> = errors
            .enumerate()
            .filter_map(|(row, se)| Some((row, se?)))
            .collect();
        if self.of.is_empty() || known.is_empty() {
            return Vec::new();
        }
        let mean = |of: &dyn Fn(usize, f64) -> f64| {
            known.iter().map(|(row, se)| of(*row, *se)).sum::<f64>() / known.len() as f64
        };
        let whole = mean(&|_, se| se * se);
        let parts = self.of.iter().map(|of| mean(&|row, _| of[row][0].powi(2)));
        let mut parts: Vec<(String, f64)> = self.names.iter().cloned().zip(parts).collect();
        let rest = whole - parts.iter().map(|(_, part)| part).sum::<f64>();
        parts.push(("noise of the samples".to_owned(), rest.max(0.0)));
        parts.sort_by(|a, b| b.1.total_cmp(&a.1));
        let share = |(source, variance): (String, f64)| BudgetShare {
            source,
            force_se_n: variance.sqrt(),
            share: variance / whole,
        };
        parts.into_iter().map(share).collect()
    }
}
