//! Crank angles that samples stand for: a coarse path from which the smoother starts.
//!
//! A slider position or a crank-pin angle belongs to several crank angles, and at a dead centre the path may go on or turn
//! back. Several hypotheses are followed side by side (multiple-hypothesis tracking, Reid 1979), each by a Kalman filter whose
//! angular acceleration is a Wiener process; the likelier ones are kept, and noise and agility are those that make the best
//! hypothesis likeliest.

use std::f64::consts::TAU;

use super::kalman::Matrix;
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
    let far: Vec<usize> = (0..values.len())
        .filter(|i| excess(values[*i]) > OFF * sensor.size())
        .collect();
    // Single ones are outliers.
    if far.len() * 20 <= values.len() {
        return Ok(());
    }
    let list = far.into_iter().take(20).map(|i| {
        let what = format!(
            "{} = {} cannot be reached: it is {} beyond what the lengths of the scene allow",
            sensor.measured.name(),
            measurement.shown(values[i]),
            measurement.shown(excess(values[i]))
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

/// A path through all samples.
#[derive(Clone, Debug)]
struct Track {
    theta: Vec<f64>,
    /// ln of its likelihood.
    score: f64,
}

impl Track {
    /// Sense of rotation, of the first part of the path in which it turns by half a turn, or of all.
    fn sense(&self) -> f64 {
        let first = self.theta[0];
        let far = self
            .theta
            .iter()
            .find(|theta| (*theta - first).abs() > 0.25 * TAU);
        (far.unwrap_or(&self.theta[self.theta.len() - 1]) - first).signum()
    }

    /// Whether another path is one on the other strokes.
    fn mirrors(&self, other: &Track) -> bool {
        self.sense() != other.sense()
    }
}

/// Noise of the samples and agility of the crank.
#[derive(Clone, Copy, Debug)]
struct Setting {
    /// rad or m
    sigma: f64,
    /// Spectral density of the jerk of the crank angle, rad²/s⁵.
    jerk: f64,
}

/// A hypothesis: a path that ends here.
#[derive(Clone, Copy, Debug)]
struct Hypothesis {
    mean: [f64; 3],
    covariance: Matrix<3>,
    score: f64,
    /// Its last angle in the list of all.
    last: usize,
}

/// An angle of a path and the one before.
#[derive(Clone, Copy, Debug)]
struct Link {
    theta: f64,
    before: usize,
}

/// Follows hypotheses through samples.
#[derive(Clone, Copy, Debug)]
struct Tracker<'a> {
    sensor: &'a Sensor<'a>,
    times: &'a [f64],
    values: &'a [f64],
    /// Typical speed of the crank, rad/s.
    speed: f64,
}

/// Most hypotheses that are kept, and ln of the likelihood ratio beyond which one is dropped.
const MOST: usize = 12;
const DROPPED: f64 = 50.0;

/// The end of a path.
const NOTHING: usize = usize::MAX;

impl Tracker<'_> {
    /// Noise and agility that are tried.
    fn settings(&self, resolution: f64) -> Vec<Setting> {
        let size = self.sensor.size();
        let noises = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2].map(|part| (part * size).max(resolution));
        let agilities = [1e-2, 1e-1, 1.0, 10.0];
        let mut list = Vec::new();
        for sigma in noises {
            for agility in agilities {
                let jerk = agility * agility * self.speed.powi(5);
                list.push(Setting { sigma, jerk });
            }
        }
        list
    }

    /// The paths of all hypotheses that are left at the end, the likeliest first.
    fn tracks(&self, setting: &Setting) -> Vec<Track> {
        let mut links = Vec::with_capacity(2 * self.values.len());
        let ends = self.run(setting, self.values.len(), &mut links);
        let path = |end: &Hypothesis| {
            let mut theta = Vec::with_capacity(self.values.len());
            let mut at = end.last;
            while at != NOTHING {
                theta.push(links[at].theta);
                at = links[at].before;
            }
            theta.reverse();
            Track {
                theta,
                score: end.score,
            }
        };
        ends.iter().map(path).collect()
    }

    /// The hypotheses after some samples, the likeliest first.
    fn followed(&self, setting: &Setting, samples: usize) -> Vec<Hypothesis> {
        self.run(setting, samples, &mut Vec::with_capacity(2 * samples))
    }

    fn run(&self, setting: &Setting, samples: usize, links: &mut Vec<Link>) -> Vec<Hypothesis> {
        let mut now: Vec<Hypothesis> = Vec::new();
        let mut next: Vec<Hypothesis> = Vec::new();
        for i in 0..samples {
            next.clear();
            let sighted = self.sighted(i, setting.sigma);
            if i == 0 {
                next.extend(sighted.iter().map(|sight| self.begun(sight, links)));
            } else {
                let dt = self.times[i] - self.times[i - 1];
                for before in &now {
                    let predicted = predicted(before, dt, setting.jerk);
                    for sight in &sighted {
                        extend(&predicted, sight, links, &mut next);
                    }
                }
            }
            prune(&mut next);
            std::mem::swap(&mut now, &mut next);
        }
        now
    }

    /// The crank angles that a sample may stand for.
    fn sighted(&self, sample: usize, sigma: f64) -> Vec<Sight> {
        let value = self.values[sample];
        let linkage = self.sensor.linkage;
        let (candidates, excess) = match self.sensor.measured {
            Measured::X => (linkage.angles_of_x(value), linkage.excess_of_x(value)),
            _ => (
                linkage.angles_of_gamma(value),
                linkage.excess_of_gamma(value),
            ),
        };
        let sights = candidates.angles().iter().map(|theta| {
            let shown = self.sensor.shown(*theta);
            // Of a dead centre the curvature tells the width.
            let steep = shown.slope * shown.slope + shown.curvature.abs() * (sigma + excess);
            Sight {
                theta: *theta,
                variance: sigma * sigma / steep,
                score: -0.5 * steep.ln() - 0.5 * (excess / sigma).powi(2).min(50.0),
            }
        });
        sights.filter(|sight| sight.variance.is_finite()).collect()
    }

    fn begun(&self, sight: &Sight, links: &mut Vec<Link>) -> Hypothesis {
        links.push(Link {
            theta: sight.theta,
            before: NOTHING,
        });
        let speed = 2.0 * self.speed;
        Hypothesis {
            mean: [sight.theta, 0.0, 0.0],
            covariance: [
                [sight.variance, 0.0, 0.0],
                [0.0, speed * speed, 0.0],
                [0.0, 0.0, speed.powi(4)],
            ],
            score: sight.score,
            last: links.len() - 1,
        }
    }
}

/// A crank angle that a sample may stand for.
#[derive(Clone, Copy, Debug)]
struct Sight {
    theta: f64,
    variance: f64,
    /// ln of the density of the measured value, per angle.
    score: f64,
}

/// A hypothesis a time later.
fn predicted(before: &Hypothesis, dt: f64, jerk: f64) -> Hypothesis {
    let [theta, omega, alpha] = before.mean;
    let transition = [[1.0, dt, 0.5 * dt * dt], [0.0, 1.0, dt], [0.0, 0.0, 1.0]];
    let q = |n: i32, divisor: f64| jerk * dt.powi(n) / divisor;
    let noise = [
        [q(5, 20.0), q(4, 8.0), q(3, 6.0)],
        [q(4, 8.0), q(3, 3.0), q(2, 2.0)],
        [q(3, 6.0), q(2, 2.0), q(1, 1.0)],
    ];
    Hypothesis {
        mean: [
            theta + dt * (omega + 0.5 * dt * alpha),
            omega + dt * alpha,
            alpha,
        ],
        covariance: super::kalman::congruent(&transition, &before.covariance, &noise),
        ..*before
    }
}

/// A hypothesis with a sample taken in, in the turns in which it may be.
fn extend(
    predicted: &Hypothesis,
    sight: &Sight,
    links: &mut Vec<Link>,
    list: &mut Vec<Hypothesis>,
) {
    let nearest = ((predicted.mean[0] - sight.theta) / TAU).round();
    let spread = predicted.covariance[0][0] + sight.variance;
    let reach = if spread.sqrt() > 0.1 * TAU { 1 } else { 0 };
    for turn in -reach..=reach {
        let theta = sight.theta + (nearest + f64::from(turn)) * TAU;
        let error = theta - predicted.mean[0];
        let mut found = *predicted;
        for i in 0..3 {
            let gain = predicted.covariance[i][0] / spread;
            found.mean[i] += gain * error;
            for j in 0..3 {
                found.covariance[i][j] -= gain * predicted.covariance[0][j];
            }
        }
        // Outliers count as such, by the tails of Student's distribution with four degrees of freedom.
        let off = error * error / spread;
        let tails = if off < 4.0 {
            0.5 * off
        } else {
            2.0 + 2.5 * (1.0 + (off - 4.0) / 4.0).ln()
        };
        found.score += sight.score - 0.5 * spread.ln() - tails;
        if off > 25.0 {
            // It moves the path no further than five standard deviations would.
            let part = 5.0 / off.sqrt();
            for i in 0..3 {
                found.mean[i] = predicted.mean[i] + part * (found.mean[i] - predicted.mean[i]);
            }
            found.covariance = predicted.covariance;
        }
        links.push(Link {
            theta: found.mean[0],
            before: predicted.last,
        });
        found.last = links.len() - 1;
        list.push(found);
    }
}

/// Keeps the likeliest hypotheses, and of those that agree the likeliest.
fn prune(list: &mut Vec<Hypothesis>) {
    list.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: usize = 0;
    for k in 0..list.len() {
        let now = list[k];
        let agrees = |other: &Hypothesis| {
            let [theta, omega, _] = std::array::from_fn(|i| {
                (other.mean[i] - now.mean[i]).powi(2) / now.covariance[i][i]
            });
            theta < 1.0 && omega < 1.0
        };
        let drop =
            now.score < list[0].score - DROPPED || list[..kept].iter().any(agrees) || kept == MOST;
        if !drop && now.score.is_finite() {
            list[kept] = now;
            kept += 1;
        }
    }
    list.truncate(kept);
}
