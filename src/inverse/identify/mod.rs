//! Identification of scene values from a measured motion by maximum marginal likelihood, with Gauss-Newton steps on
//! Kalman prediction errors (Särkkä and Svensson, Bayesian Filtering and Smoothing, 2nd ed. 2023, chapter 16).
//!
//! The motion obeys the equation of the scene with a missing torque u that begins at 0 and varies as a Wiener process,
//! du = √q dW. Further unknowns are q, the standard deviation σ of the samples, and the initial angle and speed. The
//! covariance of the values is σ² (JᵀJ)⁻¹, J the derivatives of the standardised prediction errors.

mod gauss_newton;
mod information;
mod misfit;
#[cfg(feature = "cli")]
mod of_draft;
mod trial;
mod values;

#[cfg(feature = "cli")]
pub use of_draft::{FreeKey, identify_keys};
pub use values::{FreeValue, IdentifiedValue};

use std::ops::RangeInclusive;

use self::gauss_newton::Search;
use self::misfit::Misfit;
use self::values::Optimum;
use super::mean_length::by_means;
use super::measurement_model::{Scale, Sensor};
use super::problem::Problem;
use super::residual_tests::Whiteness;
use super::result::warnings::alone;
use super::samples::Given;
use super::scales::root_mean_square;
use super::smoother::Smoothed;
use super::turns::alignment;
use super::turns::branch_choice::crank_angles;
use super::turns::hypothesis::FAR;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::student;
use crate::scene::{Measured, Measurement, Scene};

/// Values of a scene identified from a measured motion.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Identification {
    /// Title of the scene.
    pub scene: String,
    /// Number of samples.
    pub samples: usize,
    /// Name of the measured column.
    pub column: String,
    /// Identified values, in the order of the free keys.
    pub values: Vec<IdentifiedValue>,
    /// Correlation matrix of the values.
    pub correlations: Vec<Vec<f64>>,
    /// Half-width of a 95 % band over the standard error.
    pub band_factor: f64,
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// Root mean square of the torque that the scene misses, N m; the standard errors of the values account for it.
    pub missing_torque_rms_nm: f64,
    /// Number of Gauss-Newton iterations.
    pub iterations: usize,
    /// Warnings for the user, in words.
    pub warnings: Vec<String>,
}

/// Identifies free values of a scene from a measured motion; `scene_at` maps values in the order of `free` to a scene.
///
/// # Errors
/// [`Error::Scene`] for impossible values of scene or data, [`Error::Refused`] for what the record does not determine.
pub fn identify(
    scene_at: &(dyn Fn(&[f64]) -> Result<Scene, Error> + Sync),
    free: &[FreeValue],
    measurement: &Measurement,
) -> Result<Identification, Error> {
    identify_among(scene_at, free, free.len(), measurement)
}

/// Identifies the first `count` of the values; where the equation does not describe the record, score tests suggest
/// which of the others to free.
fn identify_among(
    scene_at: &(dyn Fn(&[f64]) -> Result<Scene, Error> + Sync),
    all: &[FreeValue],
    count: usize,
    measurement: &Measurement,
) -> Result<Identification, Error> {
    let free = &all[..count];
    check(free)?;
    let scene_at = &|values: &[f64]| Ok(measurement.known_in(&scene_at(values)?)?);
    let start: Vec<f64> = free.iter().map(|one| one.start).collect();
    let scene = scene_at(&start)?;
    modelled(&scene)?;
    let equation = Equation::new(&scene);
    let sensor = Sensor::exact(equation.linkage(), measurement.measured());
    let sensor = match free.iter().any(|one| one.is_sensor_zero) {
        true => alignment::centred(sensor, measurement),
        false => sensor,
    };
    let angles = crank_angles(&sensor, measurement, &equation, &scene.motion, None)?;
    let given = Given {
        measurement,
        angles: &angles,
        equation: &equation,
        stop: None,
    };
    let of = |most| given.kinematic(&[], most);
    let finer = |(problem, smooth): &(Problem<'_>, Smoothed)| problem.finer(smooth, smooth);
    let ((mut problem, mut smooth), _) = by_means(measurement.len(), of, finer);
    if let Some(codes) = problem.record.codes {
        problem.record.take_middles(codes);
    }
    problem.record.beside.clear();
    let mut at_rest = 0;
    if equation.loads().are_dry() {
        let nodes = moving(&smooth, &problem.grid.times);
        smooth.estimates = smooth.estimates[nodes.clone()].to_vec();
        at_rest = problem.single().times.len() - problem.keep(nodes);
    }
    let first = smooth.path();
    let smooth = problem.kinematic(first, smooth.noise.sigma);
    // The first path is by the zero and gain that fit the scene's lengths, the identification by the lengths alone.
    problem.record.sensor.scale = Scale::TRUE;
    let search = Search::new(scene_at, all, count, &problem, &smooth);
    // A crank read backwards is a possible reason why the equation does not describe the record.
    let found = search.run();
    let (best, misfit) = found.map_err(|error| error.with_notes(&angles.warnings))?;
    let missing = root_mean_square(best.path.states.iter().map(|state| state[2]));
    let mut warnings = measurement.notes().to_vec();
    warnings.extend(angles.warnings.clone());
    warnings.extend((at_rest > 0).then(|| {
        format!("the crank stands at the begin or the end of the record: {at_rest} samples are left out, as a dry load may hold it there with any torque")
    }));
    let several = measurement.has_sensors_beside();
    warnings.extend(several.then(|| alone(measurement)));
    warnings.extend(warnings_of(&best, misfit.as_ref(), missing));
    if free.iter().any(|one| one.is_sensor_zero) && measurement.measured() == Measured::Gamma {
        let sign = "sensor.zero of gamma is taken with the sign that gamma has along the motion";
        warnings.push(sign.to_owned());
    }
    let told = best.innovations.len();
    let freedom = told as f64 - 2.0 - free.len() as f64;
    let band_factor = student::half_band(freedom.max(1.0));
    Ok(Identification {
        scene: scene.title.unwrap_or_default(),
        samples: problem.record.stands_for().unwrap_or(told),
        column: measurement.measured().name().to_owned(),
        values: best.values(free, band_factor),
        correlations: best.information.correlations(),
        band_factor,
        sigma: best.noise.sigma,
        missing_torque_rms_nm: missing,
        iterations: best.iterations,
        warnings,
    })
}

/// Returns the nodes between a rest at the begin and one at the end of the record: a dry load holds the crank there with any
/// torque up to its magnitude, and the equation does not say with which.
fn moving(smooth: &Smoothed, times: &[f64]) -> RangeInclusive<usize> {
    let estimates = &smooth.estimates;
    let last = estimates.len().saturating_sub(1);
    let usual = root_mean_square(estimates.iter().map(|estimate| estimate.state[1]));
    let is_apart = |end: usize, node: usize| {
        let [a, b] = [&estimates[end], &estimates[node]];
        (a.state[0] - b.state[0]).abs() > FAR * (a.covariance[0] + b.covariance[0]).sqrt()
    };
    // At rest the crank goes less than half of its usual way.
    let is_rest = |end: usize, node: usize| {
        let way = (estimates[end].state[0] - estimates[node].state[0]).abs();
        way < 0.5 * usual * (times[end] - times[node]).abs()
    };
    // An end whose neighbour is apart from it is no rest.
    let begin = (0..=last).find(|node| is_apart(0, *node));
    let begin = begin.filter(|node| *node > 1 && is_rest(0, *node));
    let end = (0..=last).rev().find(|node| is_apart(last, *node));
    let end = end.filter(|node| node + 1 < last && is_rest(last, *node));
    begin.unwrap_or(0)..=end.unwrap_or(last)
}

/// Refuses an empty list of free values, and duplicate keys.
fn check(free: &[FreeValue]) -> Result<(), Error> {
    let help = "name keys of the scene, like --free torque[1].coefficient,crank.inertia";
    if free.is_empty() {
        return Err(Error::refused("no key is free", help));
    }
    for (i, one) in free.iter().enumerate() {
        if free[..i].iter().any(|other| other.key == one.key) {
            return Err(Error::refused(format!("`{}` is free twice", one.key), help));
        }
    }
    Ok(())
}

/// Refuses clearance and Coulomb friction at the guide, which the smoother's equation does not model.
fn modelled(scene: &Scene) -> Result<(), Error> {
    let reduced = scene.reduced();
    let what = match (reduced.clearance, reduced.friction) {
        (Some(_), _) => "clearance in a joint",
        (_, Some(_)) => "Coulomb friction at the guide",
        _ => return Ok(()),
    };
    Err(not_modelled(what))
}

fn not_modelled(what: &str) -> Error {
    Error::refused(
        format!("identify does not model {what}"),
        "take it out of the scene; a [[force]] or [[torque]] of kind \"dry\" has a friction force or moment that can be free",
    )
}

/// Returns the warnings of a maximum beside a missing torque, N m in root mean square.
fn warnings_of(best: &Optimum, misfit: Option<&Misfit>, missing: f64) -> Vec<String> {
    let mut list = Vec::new();
    if !best.settled {
        list.push(
            "the iterations did not come to rest: the values are not to be trusted".to_owned(),
        );
    }
    match misfit {
        Some(misfit) => {
            let errors = match misfit.misses_torque {
                true => format!(
                    "a torque beside it of {missing:.3e} N m in root mean square stands for what is missing, and the errors of the values hold if that varies at random"
                ),
                false => "the errors of the values do not hold".to_owned(),
            };
            list.push(format!("{}; {errors}; {}", misfit.words(), misfit.help()));
        }
        None if Whiteness::of(best.innovations.iter().copied()).is_violated() => {
            list.push("the prediction errors are not white noise: the standard errors hold for white noise, and may be too small".to_owned());
        }
        None => {}
    }
    list
}
