//! Crank angles that samples stand for: a coarse path from which the smoother starts.
//!
//! A slider position or a crank-pin angle belongs to several crank angles, and at a dead centre the path may go on or turn
//! back. Several hypotheses are followed side by side (multiple-hypothesis tracking, Reid 1979), each by a Kalman filter whose
//! angular acceleration is a Wiener process; the likelier ones are kept, and noise and agility are those that make the best
//! hypothesis likeliest.

use std::f64::consts::TAU;

use super::hypotheses::{Track, Tracker};
use super::measurement_model::Sensor;
use super::unwrap;
use crate::error::Error;
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement, Motion};

/// Crank angles of samples.
#[derive(Clone, Debug)]
pub(super) struct CrankAngles {
    /// rad
    pub theta: Vec<f64>,
    /// Standard deviation of a measured value that made them likeliest, rad or m.
    pub sigma: f64,
    /// What the reader should know of them.
    pub warnings: Vec<String>,
}

/// The crank angles of all samples, continued over the turns.
///
/// # Errors
/// [`Error::Scene`] for values that the mechanism cannot take.
pub(super) fn crank_angles(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
    motion: &Motion,
) -> Result<CrankAngles, Error> {
    if sensor.measured == Measured::Theta {
        return unwrap::unwrap(sensor.linkage, measurement);
    }
    reachable(sensor, measurement)?;
    let tracker = Tracker {
        sensor,
        times: measurement.elapsed(),
        values: measurement.values(),
        speed: typical_speed(sensor, measurement),
    };
    let settings = tracker.settings(measurement.resolution());
    let early = measurement.len().min(EARLY);
    let scores = parallel::map(settings.iter(), |setting| {
        Some(tracker.followed(setting, early).first()?.score)
    });
    let best = (0..settings.len()).max_by(|a, b| {
        let score = |k: usize| scores[k].unwrap_or(f64::NEG_INFINITY);
        score(*a).total_cmp(&score(*b))
    });
    let tracks = tracker.tracks(&settings[best.unwrap_or(0)]);
    chosen(
        tracks,
        motion,
        measurement,
        settings[best.unwrap_or(0)].sigma,
    )
    .map(|mut taken| {
        taken
            .warnings
            .extend(elsewhere(sensor, measurement, motion, taken.theta[0]));
        taken
    })
}

/// What is said where the first sample may be at the scene's angle, and the likeliest motion begins at another.
fn elsewhere(
    sensor: &Sensor<'_>,
    measurement: &Measurement,
    motion: &Motion,
    taken: f64,
) -> Option<String> {
    let value = measurement.values()[0];
    let candidates = match sensor.measured {
        Measured::X => sensor.linkage.angles_of_x(value),
        _ => sensor.linkage.angles_of_gamma(value),
    };
    let off = |theta: f64| {
        let off = theta - motion.angle;
        (off - (off / TAU).round() * TAU).abs()
    };
    let fits = candidates.angles().iter().any(|theta| off(*theta) < NEAR);
    (motion.angle != 0.0 && fits && off(taken) > NEAR).then(|| {
        format!(
            "the scene's angle belongs to the first sample, {} = {}, but the likelier motion begins at {taken:.4} rad: it may be the one on the wrong strokes",
            sensor.measured.name(),
            measurement.shown(value)
        )
    })
}

/// Samples by which noise and agility are found.
const EARLY: usize = 2000;

/// Part of what can be reached by which a value may be off: lengths and zero of an instrument are hardly worse.
const OFF: f64 = 0.1;

/// Refuses values far from all that the mechanism can take.
fn reachable(sensor: &Sensor<'_>, measurement: &Measurement) -> Result<(), Error> {
    let values = measurement.values();
    let excess = |value: f64| match sensor.measured {
        Measured::X => sensor.linkage.excess_of_x(value),
        _ => sensor.linkage.excess_of_gamma(value),
    };
    let is_off = |i: &usize| excess(values[*i]) > OFF * sensor.size();
    let on_no_angle = |i: &usize| match sensor.measured {
        Measured::X => sensor.linkage.angles_of_x(values[*i]).angles().is_empty(),
        _ => sensor
            .linkage
            .angles_of_gamma(values[*i])
            .angles()
            .is_empty(),
    };
    // Single ones that are only off are outliers.
    let many = (0..values.len()).filter(is_off).count() * 20 > values.len();
    let far: Vec<usize> = (0..values.len())
        .filter(|i| many && is_off(i) || on_no_angle(i))
        .take(20)
        .collect();
    if far.is_empty() {
        return Ok(());
    }
    let list = far.into_iter().map(|i| {
        let why = match excess(values[i]) {
            0.0 => "it belongs to no crank angle of the branch of the scene".to_owned(),
            excess => format!(
                "it is {} beyond what the lengths of the scene allow",
                measurement.shown(excess)
            ),
        };
        let what = format!(
            "{} = {} cannot be reached: {why}",
            sensor.measured.name(),
            measurement.shown(values[i]),
        );
        let help =
            "check the lengths of the scene, the unit of the column, and from where it counts"
                .to_owned();
        (i, what, help)
    });
    Err(measurement.problems(list.collect()).into())
}

/// Speed of a crank, rad/s, whose slider or rod goes as far as the samples do.
fn typical_speed(sensor: &Sensor<'_>, measurement: &Measurement) -> f64 {
    let (times, values) = (measurement.elapsed(), measurement.values());
    let way: f64 = values.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let duration = times[times.len() - 1] - times[0];
    (0.5 * TAU * way / (2.0 * sensor.size()) / duration).max(1e-3 / duration)
}

/// The path that is taken: of those that are about as likely, the one that begins like the scene.
///
/// A motion may begin slowly and reverse at once, so an angle of the scene that is plainly that of one path counts before
/// the speed. Angle 0 does not, because scenes that say nothing have it.
fn chosen(
    tracks: Vec<Track>,
    motion: &Motion,
    measurement: &Measurement,
    sigma: f64,
) -> Result<CrankAngles, Error> {
    let Some(likeliest) = tracks.first() else {
        return Err(Error::refused(
            format!(
                "no motion of the mechanism explains the samples of {}",
                measurement.measured().name()
            ),
            "check the lengths of the scene, and the unit and zero of the column",
        ));
    };
    let name = measurement.measured().name();
    let alike: Vec<&Track> = tracks
        .iter()
        .filter(|track| likeliest.score - track.score < CERTAIN)
        .collect();
    let off = |track: &Track| {
        let off = track.theta[0] - motion.angle;
        (off - (off / TAU).round() * TAU).abs()
    };
    let nearest = alike
        .iter()
        .copied()
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .unwrap_or(likeliest);
    let rival = alike
        .iter()
        .filter(|track| track.mirrors(nearest))
        .map(|track| off(track))
        .fold(f64::INFINITY, f64::min);
    let with_sense = alike
        .iter()
        .copied()
        .find(|track| track.sense() * motion.speed > 0.0);
    let by_angle = motion.angle != 0.0 && off(nearest) < NEAR && off(nearest) < 0.25 * rival;
    let taken = match with_sense {
        _ if by_angle => nearest,
        Some(track) => track,
        None if motion.speed == 0.0 && motion.angle != 0.0 => nearest,
        None => likeliest,
    };
    let mut warnings = Vec::new();
    if alike.iter().any(|track| track.mirrors(taken)) {
        warnings.push(match (by_angle, motion.speed != 0.0) {
            (true, _) => format!("{name} does not tell a motion from the one on the other strokes: the one that begins at the scene's angle is taken"),
            (_, true) => format!("{name} does not tell a motion from the one on the other strokes: the one with the sense of the scene's speed is taken"),
            _ => format!("{name} does not tell a motion from the one on the other strokes, and the scene has neither speed nor angle: which one it is cannot be told"),
        });
    }
    if motion.speed != 0.0 && taken.sense() * motion.speed < 0.0 {
        warnings.push("the crank turns against the sense of the scene's [motion] speed".to_owned());
    }
    let turns = |track: &Track| (track.theta[track.theta.len() - 1] - track.theta[0]).abs() / TAU;
    let doubtful = tracks
        .iter()
        .filter(|track| likeliest.score - track.score < DOUBTFUL)
        .find(|track| (turns(track) - turns(taken)).abs() > 0.5);
    if let Some(doubtful) = doubtful {
        warnings.push(format!(
            "whether the crank went on or turned back at a dead centre is not certain: {:.2} turns are taken, and {:.2} are hardly less likely",
            turns(taken),
            turns(doubtful)
        ));
    }
    Ok(CrankAngles {
        theta: taken.theta.clone(),
        sigma,
        warnings,
    })
}

/// The scene's angle belongs to a path that begins this near to it, rad, where others begin four times as far from it.
const NEAR: f64 = 0.2;

/// ln of a likelihood ratio below which the scene's sense of rotation decides.
const CERTAIN: f64 = 30.0;

/// ln of a likelihood ratio below which a path with other turns is named.
const DOUBTFUL: f64 = 7.0;
