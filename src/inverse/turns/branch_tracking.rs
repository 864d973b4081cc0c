//! Crank angles from samples of x or gamma: measured values in, coarse paths for the smoother out.
//!
//! A slider position or a crank-pin angle belongs to several crank angles, and at a dead centre the path may go on or
//! turn back. Several hypotheses are followed side by side (multiple-hypothesis tracking, Reid 1979), each by a Kalman
//! filter whose angular acceleration is a Wiener process; the likelier ones are kept, and noise and agility are chosen
//! to make the best hypothesis likeliest.

use std::f64::consts::TAU;
use std::ops::Range;

use super::super::measurement_model::{Scale, Sensor};
use super::super::quantised::Codes;
use super::super::residual_tests::repeats;
use super::super::row::InverseRow;
use super::hypotheses::{Setting, Tracker};
use super::hypothesis::{DROPPED_LOG_RATIO, FAR, is_resolved};
use super::mirror_image::Imaged;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::{ROUNDING_DEVIATION, parallel};
use crate::scene::{Measured, Measurement};

/// Crank angles assigned to samples.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct CrankAngles<'a> {
    /// Sensor that shows the angles as samples.
    pub sensor: Sensor<'a>,
    /// Crank angles, rad.
    pub theta: Vec<f64>,
    /// Likeliest standard deviation of a measured value, rad or m.
    pub sigma: f64,
    /// Warnings for the user, in words.
    pub warnings: Vec<String>,
}

impl CrankAngles<'_> {
    /// Returns the standard deviation of a measured value in crank lengths, or in rad.
    pub fn error(&self) -> f64 {
        self.sigma / self.sensor.size()
    }
}

/// Returns the motions that samples may stand for, with their mirror images, the likeliest first.
///
/// # Errors
/// [`Error::Refused`] if no motion of the mechanism explains the samples.
pub(in crate::inverse) fn motions<'a>(
    sensors: &[Sensor<'a>],
    measurement: &Measurement,
    equation: &Equation,
) -> Result<Vec<Imaged<'a>>, Error> {
    let (values, resolution) = (measurement.values(), measurement.resolution());
    // Values that repeat tell little of noise and agility.
    let mut told = (1..values.len()).filter(|i| !repeats(values, *i));
    let early = told.nth(EARLY).unwrap_or(values.len());
    let steps = Codes::of(values, resolution);
    let least = steps.map_or(resolution, |steps| ROUNDING_DEVIATION * steps.step);
    let likeliest = |sensor| {
        let tracker = Tracker {
            sensor,
            times: measurement.elapsed(),
            values,
            speed: typical_speed(sensor, measurement),
            equation,
            inertia: mean_inertia(equation),
            origin: measurement.origin(),
        };
        let settings = tracker.settings(least);
        let best_of = |settings: &[Setting], parts: &[Range<usize>]| {
            let score = |one: &Setting| -> f64 {
                let parts = parts.iter().map(|part| tracker.part(part.clone()));
                parts.map(|part| part.score(one)).sum()
            };
            let scored = parallel::map(settings.iter(), |one| (score(one), *one));
            scored.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let whole = 0..values.len();
        let whole = std::slice::from_ref(&whole);
        if early == values.len() {
            return best_of(&settings, whole).map(|(score, setting)| (score, tracker, setting));
        }
        let (_, found) = best_of(&settings, &stretches(values.len(), early))?;
        let is_as_quick = |one: &&Setting| {
            (one.sigma, one.prior) == (found.sigma, found.prior) && one.jerk >= found.jerk
        };
        let quicker: Vec<Setting> = settings.iter().filter(is_as_quick).copied().collect();
        // A crank may become quicker than in the stretches: two agilities at a time, as long as the last is the likeliest.
        let mut best = None;
        for two in quicker.chunks(2) {
            let next = best_of(two, whole)?;
            if best.is_some_and(|(score, _)| score >= next.0) {
                break;
            }
            best = Some(next);
            if next.1.jerk < two[two.len() - 1].jerk {
                break;
            }
        }
        best.map(|(score, setting)| (score, tracker, setting))
    };
    let mut likeliest: Vec<_> = sensors.iter().filter_map(likeliest).collect();
    likeliest.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut motions: Vec<Imaged<'a>> = Vec::new();
    for (score, tracker, setting) in &likeliest {
        // A sensor as the scene has it is judged by the equation if it shows all samples: a false zero puts dead centres where
        // none are.
        let mut excesses = (tracker.values.iter()).map(|value| tracker.sensor.angles(*value).1);
        let is_tenable = tracker.sensor.scale == Scale::TRUE
            && excesses.all(|excess| excess <= FAR * setting.sigma);
        if !is_tenable && *score <= likeliest[0].0 - DROPPED_LOG_RATIO {
            continue;
        }
        let (links, tracks) = tracker.tracks(setting);
        // Ways that are not far apart are many, about outliers.
        let mut left = [1, MOTIONS];
        let mut least = f64::NEG_INFINITY;
        for track in tracks {
            if track.score < least {
                break;
            }
            let left = &mut left[usize::from(track.is_far)];
            if *left == 0 {
                continue;
            }
            let theta = track.angles(&links);
            if !is_resolved(&theta) {
                continue;
            }
            least = least.max(track.score - CERTAIN_LOG_ODDS);
            let alike = |other: &Imaged<'_>| {
                let is_one = |path: &CrankAngles<'_>| {
                    path.sensor.scale == tracker.sensor.scale
                        && tracker.agree(setting.sigma, &path.theta, &theta)
                };
                is_one(&other.angles) || is_one(&other.image)
            };
            if !motions.iter().any(alike) {
                *left -= 1;
                motions.push(Imaged::new(CrankAngles {
                    sensor: *tracker.sensor,
                    theta,
                    sigma: setting.sigma,
                    warnings: Vec::new(),
                }));
            }
        }
    }
    match motions.is_empty() {
        true => Err(unexplained(&sensors[0])),
        false => Ok(motions),
    }
}

/// Returns stretches at the begin, in the middle and at the end of samples, with so many in all.
fn stretches(count: usize, of_all: usize) -> [Range<usize>; 3] {
    let length = of_all / 3;
    [0, (count - length) / 2, count - length].map(|begin| begin..begin + length)
}

fn unexplained(sensor: &Sensor<'_>) -> Error {
    Error::refused(
        format!(
            "no motion of the mechanism explains the samples of {}",
            sensor.measured.name()
        ),
        "check the lengths of the scene, the unit and zero of the column, and that each turn has more than two samples",
    )
}

/// Checks that samples of x or gamma resolve the motion that was found by them.
///
/// # Errors
/// [`Error::Refused`] if they do not.
pub(in crate::inverse) fn resolves(sensor: &Sensor<'_>, rows: &[InverseRow]) -> Result<(), Error> {
    let theta: Vec<f64> = rows.iter().map(|row| row.theta).collect();
    match matches!(sensor.measured, Measured::X | Measured::Gamma) && !is_resolved(&theta) {
        true => Err(unexplained(sensor)),
        false => Ok(()),
    }
}

/// ln of the odds above which a choice is certain: 1000 to 1.
pub(in crate::inverse) const CERTAIN_LOG_ODDS: f64 = 6.9;

/// Maximum number of motions by one sensor that are compared by their likelihoods through the equation.
const MOTIONS: usize = 4;

/// Number of samples by which noise and agility are found.
pub(in crate::inverse) const EARLY: usize = 500;

/// Largest error of a value, in crank lengths or rad: lengths and zero of an instrument are hardly worse.
pub(in crate::inverse) const LARGEST_VALUE_ERROR: f64 = 0.1;

/// Refuses values far from all that the mechanism can take.
pub(in crate::inverse) fn reachable(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
) -> Result<(), Error> {
    let values = measurement.values();
    let excess = |value: f64| sensor.angles(value).1;
    let is_off = |i: &usize| excess(values[*i]) > LARGEST_VALUE_ERROR * sensor.size();
    let on_no_angle = |i: &usize| sensor.angles(values[*i]).0.angles().is_empty();
    // A few values slightly beyond the range are outliers.
    let many = (0..values.len()).filter(is_off).count() * 20 > values.len();
    let far = (0..values.len()).filter(|i| many && is_off(i) || on_no_angle(i));
    let faults = far.map(|i| {
        let why = match excess(values[i]) {
            0.0 => "it belongs to no crank angle of the branch of the scene".to_owned(),
            excess => format!(
                "it is {} beyond what the lengths of the scene allow",
                measurement.shown(excess)
            ),
        };
        let what = format!(
            "{} = {} cannot be reached: {why}",
            sensor.measured.name(),
            measurement.shown(values[i]),
        );
        (i, what)
    });
    let help = "check the lengths of the scene, the unit of the column, and from where it counts";
    Ok(measurement.refuse(faults, help)?)
}

/// Returns the mean inertia of a mechanism over the crank angles that it reaches, kg m².
fn mean_inertia(equation: &Equation) -> f64 {
    let angles = (0..60).map(|k| TAU / 60.0 * f64::from(k));
    let inertias = angles.map(|theta| equation.terms(theta).m);
    let told: Vec<f64> = inertias.filter(|m| m.is_finite()).collect();
    told.iter().sum::<f64>() / told.len() as f64
}

/// Estimates the speed of a crank, rad/s, from the total travel of slider or rod in the samples.
fn typical_speed(sensor: &Sensor<'_>, measurement: &Measurement) -> f64 {
    let (times, values) = (measurement.elapsed(), measurement.values());
    let way: f64 = values.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let duration = times[times.len() - 1] - times[0];
    (0.5 * TAU * way / (2.0 * sensor.size()) / duration).max(1e-3 / duration)
}
