//! Both branches of a mechanism whose crank cannot turn fully: a motion past the limit goes on along the other one.

use super::super::limit::apart;
use super::super::sensor::Sensor;
use super::strokes::{Stroke, Strokes};
use crate::error::Error;
use crate::mechanism::Linkage;
use crate::scene::{Branch, Measured, Measurement};

fn other(linkage: &Linkage) -> Linkage {
    linkage.on_branch(if linkage.s > 0.0 {
        Branch::Left
    } else {
        Branch::Right
    })
}

/// Whether a value is that of a crank angle on the other branch.
fn is_beyond(sensor: &Sensor<'_>, value: f64, theta: f64) -> bool {
    let other = other(sensor.linkage);
    let beyond = Sensor {
        linkage: &other,
        ..*sensor
    };
    let scale = match sensor.measured {
        Measured::X => sensor.linkage.r,
        _ => 1.0,
    };
    // At the limit itself, and at some other angles, the branches show the same.
    let off = |sensor: &Sensor<'_>| sensor.residual(value, theta).0.abs();
    off(&beyond) + 1e-9 * scale < off(sensor)
}

/// The strokes of the first value that are on the branch of the scene, or all if none is.
pub(super) fn begin_on_branch(strokes: &Strokes<'_>, value: f64) -> Vec<Stroke> {
    let all = strokes.all();
    let linkage = strokes.sensor.linkage;
    if linkage.limit_angles().is_empty() {
        return all;
    }
    let angles = strokes.angles(value);
    let on_branch = |stroke: &Stroke| !is_beyond(strokes.sensor, value, angles[*stroke]);
    let kept: Vec<Stroke> = all.iter().copied().filter(on_branch).collect();
    if kept.is_empty() { all } else { kept }
}

/// Refuses a motion that leaves the branch of the scene.
pub(super) fn stays(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
    theta: &[f64],
) -> Result<(), Error> {
    if sensor.linkage.limit_angles().is_empty() {
        return Ok(());
    }
    let values = measurement.values();
    let leaves = (0..theta.len()).find(|i| is_beyond(sensor, values[*i], theta[*i]));
    let Some(sample) = leaves else {
        return Ok(());
    };
    Err(Error::refused(
        format!(
            "the motion is beyond a limit of the crank at {} (t = {} s): {} = {} belongs to the other branch there",
            measurement.place(sample),
            measurement.times()[sample],
            sensor.measured.name(),
            measurement.shown(values[sample])
        ),
        apart(sensor.linkage),
    ))
}
