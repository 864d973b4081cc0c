//! Unwrapping of measured crank angles: samples of theta in, as they are or reduced to one turn, continuous angles out.

use std::f64::consts::{PI, TAU};

use super::branch_tracking::CrankAngles;
use super::measurement_model::Sensor;
use crate::error::Error;
use crate::numeric::median::{median, range};
use crate::scene::Measurement;

/// Largest range, in turns, of angles reduced to one turn: noise and the scale of a sensor exceed one.
const ONE_TURN: f64 = 1.05;

/// Ratio of the speed at a jump by more than half a turn to the median speed, above which the jump is reported.
const JUMP: f64 = 10.0;

/// Returns a measured crank angle as it is, or continued over the turns if it was reduced to one.
pub(super) fn unwrap<'a>(
    sensor: &Sensor<'a>,
    measurement: &Measurement,
) -> Result<CrankAngles<'a>, Error> {
    let values = measurement.values();
    let (least, most) = range(values);
    let jumps = values.windows(2).any(|w| (w[1] - w[0]).abs() > PI);
    let mut warnings = Vec::new();
    let mut theta = values.to_vec();
    if jumps && most - least <= TAU * ONE_TURN {
        let mut turns = 0.0;
        let mut doubtful = None;
        for i in 1..values.len() {
            let step = values[i] - values[i - 1];
            turns -= (step / TAU).round();
            theta[i] = values[i] + turns * TAU;
            if (theta[i] - theta[i - 1]).abs() > 0.8 * PI {
                doubtful = doubtful.or(Some(i));
            }
        }
        warnings.push("theta stays within one turn and jumps: it is taken as reduced to one turn, and continued over the turns by the shorter way".to_owned());
        if let Some(sample) = doubtful {
            return Err(Error::refused(
                format!(
                    "theta jumps by almost half a turn at {}: the samples do not say which way the crank went",
                    measurement.place(sample)
                ),
                "sample more often, or give theta without reducing it to one turn",
            ));
        }
    } else if jumps {
        warnings.extend(jumping(measurement));
    }
    let unreachable = |(sample, theta): (usize, &f64)| {
        (!sensor.linkage.pose(*theta).is_regular()).then(|| {
            let what = format!(
                "theta = {} cannot be reached: the rod is too short for it",
                measurement.shown(values[sample])
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
        warnings,
    })
}

/// Returns the warning about an angle that jumps, for example where a counter of turns was reset.
fn jumping(measurement: &Measurement) -> Option<String> {
    let (times, values) = (measurement.elapsed(), measurement.values());
    let step = |i: usize| values[i] - values[i - 1];
    let speed = |i: usize| step(i).abs() / (times[i] - times[i - 1]);
    let usual = median((1..values.len()).map(speed))?;
    let jumps = |i: &usize| step(*i).abs() > PI && speed(*i) > JUMP * usual;
    let count = (1..values.len()).filter(jumps).count();
    let first = (1..values.len()).find(jumps)?;
    Some(format!(
        "theta jumps {}, by {} at {}: more than half a turn, more than {JUMP} times as fast as usual; it is taken as it is",
        match count {
            1 => "once".to_owned(),
            _ => format!("{count} times, first"),
        },
        measurement.shown(step(first)),
        measurement.place(first),
    ))
}
