//! Calibration of a force sensor: least-squares line through readings under known loads, and its inverse.

use std::path::Path;

use serde::Serialize;

use crate::error::Error;
use crate::numeric::line_fit::LineFit;
use crate::numeric::median::range;
use crate::scene::calibration_points;

/// Line reading = intercept + slope load, and the forces of given readings.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// Slope (reading per N), intercept, standard errors of both, R² about the mean.
    pub fit: LineFit,
    /// Forces of the given readings.
    pub forces: Vec<Measured>,
    /// Warnings about the result.
    pub warnings: Vec<String>,
}

/// Reading and its force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Reading of the sensor.
    pub reading: f64,
    /// Force, N.
    pub force_n: f64,
    /// Standard uncertainty of the force from the scatter about the line, N; none with two points.
    pub force_se_n: Option<f64>,
}

/// Fits readings in the second column of a CSV file to loads (N) in the first, and converts `readings` to forces by the
/// line.
///
/// # Errors
/// [`Error::Read`] and [`Error::Refused`] for files that are no calibration, fewer than two different loads, or
/// readings that do not depend on the load.
pub fn calibrate(file: &Path, readings: &[f64]) -> Result<Calibration, Error> {
    let points = calibration_points(file)?;
    let refused = |what: String, help| Error::refused(format!("{}: {what}", file.display()), help);
    let fit = LineFit::new(&points).ok_or_else(|| {
        let what = "no straight line goes through these points".to_owned();
        refused(what, "give readings under at least two different loads")
    })?;
    if points.iter().all(|(_, reading)| *reading == points[0].1) {
        let what = "the readings do not depend on the load".to_owned();
        return Err(refused(what, "give readings that change with the load"));
    }
    let mut warnings = Vec::new();
    let loads: Vec<f64> = points.iter().map(|(load, _)| *load).collect();
    let (least, most) = range(&loads);
    let mut forces = Vec::new();
    for reading in readings {
        if !reading.is_finite() {
            return Err(Error::refused(
                format!("a reading of {reading} is no finite number"),
                "give readings as the sensor shows them",
            ));
        }
        let (force_n, force_se_n) = fit.inverse(*reading).ok_or_else(|| {
            let what = format!("the force of the reading {reading:e} is no finite number");
            refused(what, "give readings as the sensor shows them")
        })?;
        if !(least..=most).contains(&force_n) {
            warnings.push(format!(
                "the force {force_n} N of the reading {reading} is outside the loads of the calibration, {least} to {most} N"
            ));
        }
        forces.push(Measured {
            reading: *reading,
            force_n,
            force_se_n,
        });
    }
    Ok(Calibration {
        fit,
        forces,
        warnings,
    })
}
