//! From what was measured to a continuous crank angle.
//!
//! A crank-pin angle or a slider position belongs to two crank angles of a turn (to more on some rockers), each on a
//! stroke of its own; strokes meet at folds, such as the dead centres. A motion comes to a fold where the measured value
//! turns back, and passes it or goes back. Either way the crank angle is continuous: what is taken is the motion that is
//! smooth there. A crank angle that was reduced to one turn belongs to one in each turn.

mod beginning;
mod branches;
mod evidence;
mod gaps;
mod noise;
mod record;
mod refined;
mod start;
mod steady;
mod strokes;
mod touching;
mod track;
mod trial;
mod turnings;
mod visit;
mod window;
mod wrapped;

use super::rounding::of_step;
use super::sensor::Sensor;
use crate::error::Error;
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement, Motion as Begin};
use record::Record;
use start::Start;
use strokes::Strokes;
use track::Track;
use trial::Trial;
use visit::Motion;

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
    start: &Begin,
) -> Result<Unfolded, Error> {
    if sensor.measured == Measured::Theta {
        return wrapped::unwrap(sensor.linkage, measurement);
    }
    let mut record = record(sensor, measurement);
    possible(sensor, measurement, &record)?;
    let strokes = Strokes::new(sensor);
    let mut turnings = turnings::turnings(&record);
    if sensor.measured == Measured::X {
        let motion = Motion {
            record,
            strokes: &strokes,
            turnings: &turnings,
        };
        record.noise = noise::noise_of_x(&motion);
        turnings = turnings::turnings(&record);
    }
    let few = record.values.len() < FEWEST * turnings.len();
    let motion = Motion {
        record,
        strokes: &strokes,
        turnings: &turnings,
    };
    let first = branches::begin_on_branch(&strokes, record.values[0]);
    let tracks = if few {
        Vec::new()
    } else {
        if let Some(trial) = Trial::in_vain(&motion) {
            let Trial { doubts, visits, .. } = trial;
            let what = format!("of {visits} choices that were looked at, {doubts}");
            return Err(cannot_be_told(&what, &place(measurement, trial.first)));
        }
        let passed = steady::passed(&motion);
        parallel::map(first.iter(), |stroke| Track::new(&motion, &passed, *stroke))
    };
    let blur = first
        .iter()
        .map(|stroke| motion.blur(record.values[0], *stroke, BLUR));
    let blur = blur.fold(0.0, f64::max);
    let Some(taken) = start::choose(record.times, tracks, start, blur) else {
        return Err(Error::refused(
            format!(
                "the samples are too far apart: from one to the next the crank turns so far that the {} does not say which way",
                sensor.measured.name()
            ),
            "give at least 20 samples for each turn of the crank",
        ));
    };
    branches::stays(sensor, measurement, &taken.track.theta)?;
    let warnings = warnings(sensor, measurement, &taken, start)?;
    Ok(Unfolded {
        theta: taken.track.theta,
        warnings,
    })
}

/// Fewest samples from one turning point to the next, on average.
const FEWEST: usize = 3;

/// Doubts that are too many, if they are this part of all choices.
const MANY: usize = 7;
const PART: usize = 2;

/// Standard deviations by which noise may change the first sample.
const BLUR: f64 = 12.0;

/// Part of the size of values that is their rounding.
const ROUNDING: f64 = 1e-14;

fn record<'a>(sensor: &Sensor<'_>, measurement: &'a Measurement) -> Record<'a> {
    let (times, values) = (measurement.elapsed(), measurement.values());
    let least = ROUNDING * sensor.size();
    let noise = match sensor.measured {
        Measured::Gamma => noise::noise_of_gamma(sensor.linkage, times, values),
        _ => noise::noise(times, values),
    };
    let printed = of_step(measurement.resolution());
    Record {
        times,
        values,
        noise: noise.max(least),
        rounding: noise::rounding(values).max(printed),
    }
}

/// What was decided, and what the samples do not tell.
fn warnings(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
    taken: &Start,
    start: &Begin,
) -> Result<Vec<String>, Error> {
    let name = sensor.measured.name();
    let mut warnings = Vec::new();
    warnings.extend(taken.reason.map(|reason| {
        format!("{name} does not tell a motion from the one on the other strokes: {reason}")
    }));
    if taken.contradicted {
        warnings.push(format!(
            "angle and speed of the scene belong to different motions: the one that begins at {} rad moves off against the scene's speed of {} rad/s, its mirror image with it; let the scene have angle and speed of the first sample",
            start.angle, start.speed
        ));
    }
    if taken.unsure {
        warnings.push(format!(
            "the motion begins so slowly, or so near an end of the range of {name}, that angle and speed of the scene do not tell it from its mirror image: which one cannot be told, and all of it depends on that"
        ));
    }
    let Track {
        theta,
        doubts,
        visits,
        ..
    } = &taken.track;
    if let Some(first) = doubts.first() {
        let count = match doubts.len() {
            1 => "one choice".to_owned(),
            count => format!("{count} choices"),
        };
        let place = format!(
            "{}, theta = {:.4} rad",
            place(measurement, *first),
            theta[*first]
        );
        if doubts.len() > MANY && PART * doubts.len() >= *visits {
            return Err(cannot_be_told(&count, &place));
        }
        warnings.push(format!(
            "{}: the smoother motion is taken, and all after it depends on that",
            doubt(&count, &place)
        ));
    }
    warnings.extend(gaps::too_far(measurement, theta));
    Ok(warnings)
}

fn place(measurement: &Measurement, sample: usize) -> String {
    format!(
        "{} (t = {} s",
        measurement.place(sample),
        measurement.times()[sample]
    )
}

fn doubt(choices: &str, place: &str) -> String {
    format!(
        "{choices} of the motion past or back from a dead centre cannot be told from the samples, the first near {place})"
    )
}

fn cannot_be_told(choices: &str, place: &str) -> Error {
    Error::refused(doubt(choices, place), "sample more often, or measure theta")
}

/// Part of the stroke, or rad, by which noise may take a value beyond what is possible.
const BEYOND: f64 = 0.06;

/// Refuses values that the mechanism cannot have.
fn possible(
    &Sensor { linkage, measured }: &Sensor<'_>,
    measurement: &Measurement,
    record: &Record<'_>,
) -> Result<(), Error> {
    let values = measurement.values();
    let size = Sensor { linkage, measured }.size();
    let excess = |value: f64| match measured {
        Measured::X => linkage.excess_of_x(value),
        _ => linkage.excess_of_gamma(value),
    };
    let nowhere = |value: f64| {
        let angles = match measured {
            Measured::X => linkage.angles_of_x(value),
            _ => linkage.angles_of_gamma(value),
        };
        angles.angles().is_empty()
    };
    let rounding = measurement.resolution() + 2.0 * record.rounding + 1e-12 * size;
    let most = (8.0 * record.noise).min(BEYOND * size) + rounding;
    let wrong = parallel::list(values.len(), |i| {
        excess(values[i]) > most || nowhere(values[i])
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
    let wrong = (0..values.len()).filter(|sample| wrong[*sample]);
    let list: Vec<_> = wrong.take(20).map(impossible).collect();
    if !list.is_empty() {
        return Err(measurement.problems(list).into());
    }
    Ok(())
}
