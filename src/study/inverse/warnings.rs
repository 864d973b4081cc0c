//! When a result is not to be trusted, and why.

use super::InverseOptions;
use super::fitted::Fitted;
use super::rounding::{common_step, of_step};
use super::row::Rows;
use crate::error::Error;
use crate::numeric::fit::{Curve, Kind, Size};
use crate::scene::{Measurement, Scene};

/// Residuals beyond this many standard deviations are named.
const OUTLIER: f64 = 6.0;

/// Fewest degrees of freedom of the others that tell their standard deviation well enough.
const LEAST_FREE: f64 = 10.0;

/// Part of the time between samples up to which a step of times is one of rounding.
const WITHIN: f64 = 0.3;

/// Part of what a fit leaves from which on it comes from rounded times.
const PART: f64 = 0.5;

/// Units of rounding to which a residual is computed.
const ROUNDED: f64 = 4.0;

/// What is to be known of the scene's loads.
pub(super) fn of_scene(scene: &Scene, options: &InverseOptions) -> Vec<String> {
    let reduced = scene.reduced();
    let forces = (!reduced.forces.is_empty()).then_some(if options.beside_forces {
        "the scene has forces on the slider: slider_force_n and crank_torque_nm are what acts beside them"
    } else {
        "the scene has forces on the slider: slider_force_n is the whole force on it, with those of the scene in it (--beside-forces takes them off)"
    });
    let friction = reduced.friction.map(|_| {
        "the scene has friction at the guide: slider_force_n and crank_torque_nm are what acts beside it; where the slider is at rest or turns round the force is left empty, and the torque is the middle of what friction allows"
    });
    forces
        .into_iter()
        .chain(friction)
        .map(str::to_owned)
        .collect()
}

/// What is to be known of samples at which the fit does not follow the motion.
///
/// # Errors
/// Where it follows it nowhere.
pub(super) fn of_lost(fitted: &Fitted, found: &Rows) -> Result<Option<String>, Error> {
    let (lost, all) = (found.lost.len(), found.rows.len());
    let what = |samples: String| {
        format!(
            "a polynomial of degree {}, the highest that is chosen for {all} samples, misses more of the acceleration than there usually is at {samples}",
            fitted.curve.degree()
        )
    };
    match lost {
        0 => Ok(None),
        _ if lost == all => Err(Error::refused(
            what("all of them".to_owned()),
            "--fit spline may follow the motion",
        )),
        _ => Ok(Some(format!(
            "{}: force and torque are left empty there, and --fit spline may follow the motion",
            what(format!("{lost} of them"))
        ))),
    }
}

/// What is to be known of the fit.
pub(super) fn of_fit(
    fitted: &Fitted,
    measurement: &Measurement,
    options: &InverseOptions,
) -> Vec<String> {
    let quality = fitted.curve.quality();
    let mut warnings = Vec::new();
    if !fitted.settled {
        warnings.push(
            "the fit did not settle: the motion between the samples is not certain".to_owned(),
        );
    }
    let rows = fitted.passages.unwrap_or(measurement.len()) as f64;
    if rows < 3.0 * quality.parameters && !fitted.errors.through {
        warnings.push(format!(
            "{rows} {} are few for a fit of {} parameters: its error is hardly known",
            match fitted.passages {
                Some(_) => "passages from step to step",
                None => "samples",
            },
            quality.parameters.round()
        ));
    }
    if let Some(step) = fitted.even_step {
        warnings.push(format!(
            "the samples go on by multiples of {}: the band takes them as exact, and does not hold what an instrument that rounds to steps hides of an even motion",
            measurement.shown(step)
        ));
    }
    warnings.extend(rounded_times(fitted, measurement));
    if fitted.errors.pattern.clear {
        warnings.push(format!(
            "the residuals are not noise (correlation of each with the next {:.2}, runs of one sign {:+.0} standard deviations): the fit misses part of the motion, or the samples are not independent; the standard errors {}, and {}",
            fitted.errors.pattern.lag_one,
            fitted.errors.pattern.runs,
            match &fitted.errors.missed {
                Some(_) => "have in them what a spline through the residuals shows".to_owned(),
                None => format!("are widened by {:.1}", fitted.errors.pattern.widening),
            },
            match options.fit {
                Kind::Polynomial if options.size == Size::Auto => "--fit spline may follow the motion better",
                Kind::Polynomial => "a higher --degree or --fit spline may follow the motion better",
                _ => "another --fit may follow the motion better",
            }
        ));
    }
    warnings.extend(fitted.errors.waves.map(|waves| {
        format!(
            "the residuals have waves in them of about {:.1} samples, too fast for the fit: if the crank moves like that, or faster, the force has waves that the fit does not show; the standard errors have room for them",
            waves.samples
        )
    }));
    warnings.extend(superfluous(fitted, options));
    if fitted.curve.coefficients().0.iter().any(|c| !c.is_finite()) {
        warnings.push("coefficients in plain time are left out where cancellation leaves no digits: let the time begin near 0".to_owned());
    }
    warnings.extend(outliers(fitted, measurement));
    warnings
}

/// Uneven times that were rounded, where that is a large part of what the fit leaves: it is more where the measured values
/// change fast, which the stated errors do not tell.
fn rounded_times(fitted: &Fitted, measurement: &Measurement) -> Option<String> {
    let (times, values) = (measurement.elapsed(), fitted.measured(measurement));
    let step = common_step(times, 0.0)?;
    let last = times.len() - 1;
    // Times that are multiples of the usual one are those of a clock, with gaps.
    if step > WITHIN * (times[last] - times[0]) / last as f64 {
        return None;
    }
    let pairs = times.windows(2).zip(values.windows(2));
    let rates = pairs.map(|(t, value)| ((value[1] - value[0]) / (t[1] - t[0])).powi(2));
    let rate = (rates.sum::<f64>() / last as f64).sqrt();
    (of_step(step) * rate > PART * fitted.left()).then(|| {
        format!(
            "the times are uneven and rounded to {} s, in which the measured values change by {}: the stated errors take that as noise that is the same everywhere, and may be too small by several times",
            format_args!("{step:.1e}"),
            measurement.shown(step * rate)
        )
    })
}

/// Terms of a polynomial of given degree that the samples do not support.
fn superfluous(fitted: &Fitted, options: &InverseOptions) -> Option<String> {
    let Curve::Polynomial(polynomial) = &fitted.curve else {
        return None;
    };
    let degree = polynomial.degree();
    let enough = polynomial.supported_degree();
    (options.size != Size::Auto && enough + 2 < degree).then(|| {
        format!("degree {degree} is higher than the samples support: beyond degree {enough} no term differs from zero, and each makes the force less certain")
    })
}

/// Samples far off the fit, in standard deviations of the others: one of few samples adds much to that of all.
fn outliers(fitted: &Fitted, measurement: &Measurement) -> Option<String> {
    let quality = fitted.curve.quality();
    let free = measurement.len() as f64 - quality.parameters - 1.0;
    if free < LEAST_FREE {
        return None;
    }
    let measured = fitted.measured(measurement).iter();
    let largest = measured.fold(0.0, |most: f64, value| most.max(value.abs()));
    let least = fitted.floor.max(ROUNDED * f64::EPSILON * largest).powi(2);
    let squares: f64 = fitted.residuals.iter().map(|r| r * r).sum();
    let far = |residual: &f64| {
        let square = residual * residual;
        square > OUTLIER * OUTLIER * ((squares - square) / free).max(least)
    };
    let count = fitted.residuals.iter().filter(|r| far(r)).count();
    let first = fitted.residuals.iter().position(far)?;
    let samples = if count == 1 {
        "1 sample lies".to_owned()
    } else {
        format!("{count} samples lie")
    };
    Some(format!(
        "{samples} more than {OUTLIER} standard deviations off the fit, the first at {} by {}: none was left out",
        measurement.place(first),
        measurement.shown(fitted.residuals[first])
    ))
}
