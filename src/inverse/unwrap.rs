//! Measured crank angles: samples of theta in, as they are or reduced to a period, continuous and reachable angles out.

use super::branch_tracking::CrankAngles;
use super::measurement_model::Sensor;
use crate::error::Error;
use crate::scene::{Measurement, Unwrapped};

/// Returns a measured crank angle, continued over the turns.
pub(super) fn unwrap<'a>(
    sensor: &Sensor<'a>,
    measurement: &Measurement,
) -> Result<CrankAngles<'a>, Error> {
    let Unwrapped { theta, warning } = measurement.unwrapped()?;
    let unreachable = |(sample, theta): (usize, &f64)| {
        (!sensor.linkage.pose(*theta).is_regular()).then(|| {
            let what = format!(
                "theta = {} cannot be reached: the rod is too short for it",
                measurement.shown(measurement.values()[sample])
            );
            (
                sample,
                what,
                "`kinematics` shows the crank angles that can be reached".to_owned(),
            )
        })
    };
    let list: Vec<_> = theta
        .iter()
        .enumerate()
        .filter_map(unreachable)
        .take(20)
        .collect();
    if !list.is_empty() {
        return Err(measurement.problems(list).into());
    }
    Ok(CrankAngles {
        sensor: *sensor,
        theta,
        sigma: 0.0,
        warnings: Vec::from_iter(warning),
    })
}
