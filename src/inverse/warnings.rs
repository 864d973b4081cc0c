//! When a result is not to be trusted, and why.

use super::InverseOptions;
use super::fitted::Fitted;
use crate::scene::{Measurement, Scene};

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

/// What is to be known of the estimated motion.
pub(super) fn of_fit(fitted: &Fitted, measurement: &Measurement) -> Vec<String> {
    let summary = &fitted.summary;
    let mut warnings = Vec::new();
    if !fitted.settled {
        warnings.push(
            "the iterations did not settle: the motion between the samples is not certain"
                .to_owned(),
        );
    }
    let rows = measurement.len() as f64;
    if rows < 3.0 * summary.parameters {
        warnings.push(format!(
            "{rows} samples are few for a motion that is worth {} parameters: its error is hardly known",
            summary.parameters.round()
        ));
    }
    if fitted.patterned {
        warnings.push(format!(
            "the residuals are not white noise (correlation of each with the next {:.2}, runs of one sign {:+.0} standard deviations): the fit misses part of the motion, or the samples are not independent, and the standard errors may be too small",
            summary.residual_lag_one, summary.residual_runs,
        ));
    }
    if summary.coefficients.iter().any(Option::is_none) {
        warnings.push("coefficients in plain time are left out where cancellation leaves no digits: let the time begin near 0".to_owned());
    }
    warnings
}
