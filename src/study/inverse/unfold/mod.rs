//! From what was measured to a continuous crank angle.
//!
//! A crank-pin angle or a slider position belongs to two crank angles of a turn (to more on some rockers), which meet
//! at the dead centres; a crank angle that was reduced to one turn belongs to one in each turn. Of all continuous
//! motions through the samples the smoothest is taken: the one with the least sum of squared differences
//! between each angle and the parabola through the three before it.

mod anchors;
mod branches;
mod doubt;
mod search;
mod spacing;
mod start;

use std::f64::consts::{PI, TAU};

use super::sensor::Sensor;
use crate::error::Error;
use crate::mechanism::{Candidates, Linkage};
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement, Motion};
use anchors::Anchors;
use branches::Branches;
use spacing::Spacing;
use start::Start;

/// Continuous crank angles, one for each sample, and what was decided on the way.
#[derive(Debug)]
pub(super) struct Unfolded {
    /// rad
    pub theta: Vec<f64>,
    pub warnings: Vec<String>,
}

/// The continuous crank angle of a measurement. The scene's `start` decides between motions that the samples do not
/// tell apart.
pub(super) fn unfold(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
    start: &Motion,
) -> Result<Unfolded, Error> {
    let (linkage, name) = (sensor.linkage, sensor.measured.name());
    if sensor.measured == Measured::Theta {
        return unwrap(linkage, measurement);
    }
    let branches = Branches::new(sensor);
    let candidates = candidates(sensor, &branches, measurement)?;
    let noise = noise(measurement.values());
    // At a dead centre the crank angle is known to about √(2 noise/x'').
    let of_x = 3.0 * (2.0 * noise / linkage.r).sqrt();
    let (blur, start_blur) = match sensor.measured {
        Measured::X => (of_x, of_x),
        _ => (0.0, 8.0 * noise),
    };
    let angles = |value: f64| branches.angles(value);
    let spacing = Spacing::new(&candidates, blur, linkage.limit_angles().is_empty());
    let mut anchors = Anchors::choose(measurement, &candidates, &spacing, angles);
    branches::begin_on_branch(sensor, measurement, &mut anchors);
    let taken = start::choose(search::paths(&anchors), start, start_blur, |theta| {
        anchors.first(measurement.times(), &candidates, theta)
    });
    let taken = taken.filter(|taken| taken.path.scale <= TOO_COARSE);
    let Some(Start {
        path,
        reason,
        contradicted,
    }) = taken
    else {
        return Err(Error::refused(
            format!(
                "the samples are too far apart: from one to the next the crank turns so far that the {name} does not say which way"
            ),
            "give at least 20 samples for each turn of the crank",
        ));
    };
    let theta = anchors.spread(measurement.times(), &candidates, &path.theta);
    branches::stays(sensor, measurement, &theta)?;
    let mut warnings = vec![format!(
        "{name} does not tell a motion from the one on the other strokes: {reason}"
    )];
    if contradicted {
        warnings.push(format!(
            "angle and speed of the scene belong to different motions: the one that begins at {} rad moves off against the scene's speed of {} rad/s, its mirror image with it; let the scene have angle and speed of the first sample",
            start.angle, start.speed
        ));
    }
    let doubts = doubt::doubts(&anchors, &path);
    if !doubts.is_empty() {
        let first = anchors.index[doubts[0]];
        let text = format!(
            "{} of the motion past or back from a dead centre cannot be told from the samples, the first near {} (t = {} s)",
            if doubts.len() == 1 {
                "one choice".to_owned()
            } else {
                format!("{} choices", doubts.len())
            },
            measurement.place(first),
            measurement.times()[first]
        );
        if doubts.len() > 7 && doubts.len() >= path.passages {
            return Err(Error::refused(text, "sample more often, or measure theta"));
        }
        warnings.push(format!(
            "{text}: the smoother motion is taken, and all after it depends on that"
        ));
    }
    Ok(Unfolded { theta, warnings })
}

/// Prediction errors beyond this, rad, are not those of a motion that was followed.
const TOO_COARSE: f64 = 0.3;

/// Part of the stroke, or rad, by which noise may take a value beyond what is possible.
const BEYOND: f64 = 0.06;

/// The crank angles of each sample.
fn candidates(
    &Sensor { linkage, measured }: &Sensor<'_>,
    branches: &Branches<'_>,
    measurement: &Measurement,
) -> Result<Vec<Candidates>, Error> {
    let values = measurement.values();
    let noise = noise(values);
    let excess = |value: f64| match measured {
        Measured::X => linkage.excess_of_x(value),
        _ => linkage.excess_of_gamma(value),
    };
    let size = match measured {
        Measured::X => linkage.r,
        _ => 1.0,
    };
    let rounding = measurement.resolution() + 1e-12 * size;
    let most = (8.0 * noise).min(BEYOND * size) + rounding;
    let nowhere = |value: f64| branches.of_one(value).angles().is_empty();
    let candidates = parallel::list(values.len(), |i| {
        let one = branches.of_one(values[i]);
        if one.angles().is_empty() || excess(values[i]) > most {
            return Candidates::default();
        }
        branches.beside(one, values[i])
    });
    let impossible = |sample: usize| {
        let value = values[sample];
        let what = format!(
            "{} = {} is impossible for this mechanism{}",
            measured.name(),
            measurement.shown(value),
            if nowhere(value) {
                " on its branch".to_owned()
            } else {
                format!(", by {}", measurement.shown(excess(value)))
            }
        );
        let help = match measured {
            Measured::X => {
                "the slider position x counts from the crank pivot, along the guide; `kinematics` shows its range"
            }
            _ => "gamma is the angle at the crank pin between crank and rod, from 0 to 180 deg",
        };
        (sample, what, help.to_owned())
    };
    let empty = (0..values.len()).filter(|sample| candidates[*sample].angles().is_empty());
    let list: Vec<_> = empty.take(20).map(impossible).collect();
    if !list.is_empty() {
        return Err(measurement.problems(list).into());
    }
    Ok(candidates)
}

/// Standard deviation of the noise of evenly spaced samples, from the median of their third differences, which a
/// smooth motion hardly adds to.
fn noise(values: &[f64]) -> f64 {
    let mut third = parallel::list(values.len().saturating_sub(3), |i| {
        (values[i + 3] - 3.0 * values[i + 2] + 3.0 * values[i + 1] - values[i]).abs()
    });
    let middle = third.len() / 2;
    if third.is_empty() {
        return 0.0;
    }
    1.4826 * *third.select_nth_unstable_by(middle, f64::total_cmp).1 / 20f64.sqrt()
}

/// A measured crank angle as it is, or continued over the turns if it was reduced to one.
fn unwrap(linkage: &Linkage, measurement: &Measurement) -> Result<Unfolded, Error> {
    let values = measurement.values();
    let (least, most) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(*v), b.max(*v))
        });
    let jumps = values.windows(2).any(|w| (w[1] - w[0]).abs() > PI);
    let mut warnings = Vec::new();
    let mut theta = values.to_vec();
    if jumps && most - least <= TAU * (1.0 + 1e-6) {
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
    }
    let unreachable = |(sample, theta): (usize, &f64)| {
        (!linkage.pose(*theta).exists()).then(|| {
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
    Ok(Unfolded { theta, warnings })
}
