//! Measured crank angles: samples of theta, as they are or reduced to a period, or of the speed in; continuous and
//! reachable angles out.

use super::super::measurement_model::Sensor;
use super::super::residual_tests;
use super::branch_tracking::CrankAngles;
use crate::error::Error;
use crate::scene::{Measurement, Unwrapped};

/// Returns a measured crank angle, continued over the turns.
pub(in crate::inverse) fn unwrap<'a>(
    sensor: &Sensor<'a>,
    measurement: &Measurement,
) -> Result<CrankAngles<'a>, Error> {
    let Unwrapped { theta, warning } = measurement.unwrapped()?;
    reachable(sensor, measurement, &theta)?;
    Ok(CrankAngles {
        sensor: *sensor,
        theta,
        sigma: 0.0,
        warnings: Vec::from_iter(warning),
    })
}

/// Returns the crank angles of a measured speed, from that of the first sample, rad, by the trapezoidal rule.
pub(in crate::inverse) fn integrated<'a>(
    sensor: &Sensor<'a>,
    measurement: &Measurement,
    start: f64,
) -> Result<CrankAngles<'a>, Error> {
    let (times, speeds) = (measurement.elapsed(), measurement.values());
    let mut theta = vec![start];
    for (t, omega) in times.windows(2).zip(speeds.windows(2)) {
        theta.push(theta[theta.len() - 1] + 0.5 * (omega[0] + omega[1]) * (t[1] - t[0]));
    }
    reachable(sensor, measurement, &theta)?;
    let degrees = (start.to_degrees() * 1e6).round() / 1e6;
    let warning = format!(
        "a speed does not show where the crank is: the first sample is taken to be at the scene's [motion] angle, {degrees} deg, without error"
    );
    Ok(CrankAngles {
        sensor: *sensor,
        theta,
        sigma: residual_tests::noise(times, speeds),
        warnings: vec![warning],
    })
}

/// Checks that the mechanism reaches crank angles, rad.
fn reachable(sensor: &Sensor<'_>, measurement: &Measurement, theta: &[f64]) -> Result<(), Error> {
    let angles = theta.iter().enumerate();
    let beyond = angles.filter(|(_, theta)| !sensor.linkage.pose(**theta).is_regular());
    let faults = beyond.map(|(sample, theta)| {
        let shown = match sensor.is_of_speed() {
            true => format!("{theta} rad"),
            false => measurement.shown(measurement.values()[sample]),
        };
        let what = format!("theta = {shown} cannot be reached: the rod is too short for it");
        (sample, what)
    });
    let help = "`kinematics` shows the crank angles that can be reached";
    Ok(measurement.refuse(faults, help)?)
}
