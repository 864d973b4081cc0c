//! Both branches of a mechanism whose crank cannot turn fully: a motion past the limit goes on along the other one.

use super::super::limit::apart;
use super::super::sensor::Sensor;
use super::anchors::Anchors;
use crate::error::Error;
use crate::mechanism::{Candidates, Linkage};
use crate::scene::{Branch, Measured, Measurement};

/// Reads crank angles from a measured value.
#[derive(Debug)]
pub(super) struct Branches<'a> {
    sensor: &'a Sensor<'a>,
    /// The linkage on the other branch, if the motion can reach it.
    other: Option<Linkage>,
}

impl Branches<'_> {
    pub fn new<'a>(sensor: &'a Sensor<'a>) -> Branches<'a> {
        let reaches = !sensor.linkage.limit_angles().is_empty();
        Branches {
            sensor,
            other: reaches.then(|| other(sensor.linkage)),
        }
    }

    fn of(&self, linkage: &Linkage, value: f64) -> Candidates {
        match self.sensor.measured {
            Measured::X => linkage.angles_of_x(value),
            _ => linkage.angles_of_gamma(value),
        }
    }

    /// The crank angles of a turn that belong to a measured value on the linkage's branch.
    pub fn of_one(&self, value: f64) -> Candidates {
        self.of(self.sensor.linkage, value)
    }

    /// The same, and those of the other branch if the motion can reach it.
    pub fn angles(&self, value: f64) -> Candidates {
        self.beside(self.of_one(value), value)
    }

    /// These angles and those of the other branch if the motion can reach it.
    pub fn beside(&self, one: Candidates, value: f64) -> Candidates {
        match &self.other {
            Some(other) => one.with(&self.of(other, value)),
            None => one,
        }
    }
}

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

/// Lets the motion begin on the branch of the scene, if it can.
pub(super) fn begin_on_branch(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
    anchors: &mut Anchors,
) {
    if sensor.linkage.limit_angles().is_empty() {
        return;
    }
    let value = measurement.values()[anchors.index[0]];
    let mut kept = Candidates::default();
    for theta in anchors.candidates[0].angles() {
        if !is_beyond(sensor, value, *theta) {
            kept = kept.with(&Candidates::one(*theta));
        }
    }
    if !kept.angles().is_empty() {
        anchors.candidates[0] = kept;
    }
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
