//! Choice among motions that have the same samples, by the marginal likelihood of each through the equation of motion,
//! and by the scene's initial angle and sense of speed.
//!
//! A slider position belongs to a motion and to its mirror image at the line from the crank pivot to the slider pin,
//! which takes the other strokes and is equally smooth. Only a plausible force, or the scene, tells the two apart.

use std::f64::consts::TAU;

use super::super::limit;
use super::super::measurement_model::{Scale, Sensor};
use super::alignment;
use super::branch_tracking::{self, CERTAIN_LOG_ODDS, CrankAngles};
use super::mirror_image::{DISTINCT_ROTATION, Imaged, departure, fork};
use super::unwrap;
use super::window::{Judged, Windows};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::parallel;
use crate::numeric::stop::Stop;
use crate::scene::{Measured, Measurement, Motion};

/// Bound of ln of the odds from the likelihoods of a motion and of its mirror image, and from the sense of a stated
/// speed: forces that no prior describes make the false motion likelier in one record of fifty (simulated ones of eight
/// kinds), and a stated sense counts as equally trustworthy.
const MOST_LOG_ODDS: f64 = 3.9;

/// ln of the odds above which a criterion is named in favour of a motion: 2 to 1.
const NAMED_LOG_ODDS: f64 = 0.7;

/// Returns the crank angles of all samples, continued over the turns.
///
/// # Errors
/// [`Error::Scene`] for values that the mechanism cannot take, [`Error::Refused`] for a motion that leaves the branch.
pub(in crate::inverse) fn crank_angles<'a>(
    sensor: &Sensor<'a>,
    measurement: &Measurement,
    equation: &Equation,
    motion: &Motion,
    stop: Option<&Stop>,
) -> Result<CrankAngles<'a>, Error> {
    if sensor.measured == Measured::Theta {
        return unwrap::unwrap(sensor, measurement);
    }
    if sensor.is_of_speed() {
        return unwrap::integrated(sensor, measurement, motion.angle);
    }
    branch_tracking::reachable(sensor, measurement)?;
    let sensors = alignment::sensors(*sensor, measurement);
    let motions = branch_tracking::motions(&sensors, measurement, equation)?;
    let windows = Windows {
        measurement,
        equation,
        motion,
        stop,
    };
    // A motion and its image are compared about the samples where they part and move, and so is each with the tracker's
    // likeliest: about the later part, for the other may be its image before.
    let first = &motions[0];
    let list = parallel::map(motions.iter(), |one| {
        let moves = departure(&one.angles).max(fork(&one.angles, &one.image));
        let own = windows.about(moves);
        let forks = [&one.angles, &one.image].map(|other| fork(&first.angles, other));
        let common = windows.about(forks[0].max(forks[1]));
        let is_first = std::ptr::eq(one, first);
        let compared = match is_first {
            true => Vec::new(),
            false => windows.judged(&[first, one], &common),
        };
        let better = compared.iter().map(|[a, b]| a.likelihood.max(b.likelihood));
        let likelihood = better.reduce(|first, one| one - first).unwrap_or(0.0);
        let judged = match compared[..] {
            [_, judged] if own == common => judged,
            _ => windows.judged(&[one], &own)[0],
        };
        let name = sensor.measured.name();
        Taken::of(one.clone(), judged, likelihood, motion, name)
    });
    best(list, measurement, motion)
}

/// Returns the likeliest of the motions with its warnings.
fn best<'a>(
    mut list: Vec<Taken<'a>>,
    measurement: &Measurement,
    motion: &Motion,
) -> Result<CrankAngles<'a>, Error> {
    let turned = |theta: &[f64]| (theta[theta.len() - 1] - theta[0]).abs();
    let by_tracker = list.first().map(|first| turned(&first.angles.theta));
    list.sort_by(|a, b| b.likelihood.total_cmp(&a.likelihood));
    let best = list.swap_remove(0);
    let angles = best.angles;
    if let Some(sample) = best.leaves {
        let theta = angles.theta[sample.saturating_sub(1)];
        let linkage = angles.sensor.linkage;
        return Err(limit::refusal(
            linkage,
            measurement,
            sample,
            theta,
            angles.error(),
        ));
    }
    let mut warnings = angles.warnings;
    let taken = turned(&angles.theta);
    let likely = list
        .iter()
        .filter(|other| best.likelihood - other.likelihood < CERTAIN_LOG_ODDS);
    let other = likely
        .map(|other| turned(&other.angles.theta))
        .chain(by_tracker)
        .find(|turned| (turned - taken).abs() > DISTINCT_ROTATION);
    if let Some(other) = other {
        warnings.push(format!(
            "whether the crank went on or turned back at a dead centre is not certain: {:.2} turns are taken, and {:.2} are hardly less likely",
            taken / TAU,
            other / TAU
        ));
    }
    if best.sense * motion.speed < 0.0 {
        warnings.push("the crank turns against the sense of the scene's [motion] speed".to_owned());
    }
    let scale = angles.sensor.scale;
    if scale != Scale::TRUE {
        let x = measurement.shown(scale.shift);
        warnings.push(format!(
            "the slider does not turn back at the dead centres of the scene: the positions are taken as {:.6} times the slider's, and {x} more; check the lengths of the scene, and zero and gain of the sensor, for the force rests on them",
            scale.stretch
        ));
    }
    Ok(CrankAngles { warnings, ..angles })
}

impl Judged {
    /// Returns ln of the density of the scene's angle: 1/δ for an error δ of unknown size (Jeffreys), beside that of a sample, rad.
    fn of_angle(&self, motion: &Motion, error: f64) -> f64 {
        let off = self.begin - motion.angle;
        let off = (off - (off / TAU).round() * TAU).abs();
        -(off + error).ln()
    }

    /// Returns ln of the probability of the sense of the scene's speed.
    fn of_speed(&self, motion: &Motion) -> f64 {
        if self.sense * motion.speed < 0.0 {
            -MOST_LOG_ODDS
        } else {
            0.0
        }
    }
}

/// Motion that is taken, of a motion and its mirror image.
#[derive(Debug)]
struct Taken<'a> {
    angles: CrankAngles<'a>,
    /// Sense of rotation (±1).
    sense: f64,
    /// Sample at which it leaves the branch of the scene.
    leaves: Option<usize>,
    /// ln of the larger likelihood of the two motions, over that of the first pair.
    likelihood: f64,
}

impl<'a> Taken<'a> {
    fn of(
        pair: Imaged<'a>,
        [own, mirrored]: [Judged; 2],
        likelihood: f64,
        motion: &Motion,
        name: &str,
    ) -> Taken<'a> {
        let Imaged {
            angles,
            image,
            leaves,
        } = pair;
        // The image of the first sample is on the other branch.
        if leaves == Some(0) {
            return Taken {
                angles,
                sense: own.sense,
                leaves: None,
                likelihood,
            };
        }
        let error = angles.error();
        let speaking = [
            (
                own.of_angle(motion, error) - mirrored.of_angle(motion, error),
                "the scene's angle",
            ),
            (
                own.of_speed(motion) - mirrored.of_speed(motion),
                "the sense of the scene's speed",
            ),
            (
                (own.likelihood - mirrored.likelihood).clamp(-MOST_LOG_ODDS, MOST_LOG_ODDS),
                "the likelihood of its forces",
            ),
        ];
        let odds: f64 = speaking.iter().map(|(odds, _)| odds).sum();
        let (mut taken, other, sense) = if odds < 0.0 {
            (image, angles, mirrored.sense)
        } else {
            (angles, image, own.sense)
        };
        let named = |sign: f64| {
            let plainly = speaking
                .iter()
                .filter(|(part, _)| sign * part * odds.signum() > NAMED_LOG_ODDS);
            let list: Vec<&str> = plainly.map(|(_, words)| *words).collect();
            match list.is_empty() {
                true => "nothing".to_owned(),
                false => list.join(" and "),
            }
        };
        let opposes = |(part, _): &(f64, _)| -part * odds.signum() > NAMED_LOG_ODDS;
        let is_doubtful = odds.abs() < CERTAIN_LOG_ODDS || speaking.iter().any(opposes);
        let doubt = is_doubtful.then(|| {
            let past = if odds > 0.0 && leaves.is_some() { ", past a limit," } else { "" };
            format!(
                "{name} alone does not tell a motion from its mirror image on the other strokes: the one that begins at {:.4} rad is taken (for it: {}); the one that begins at {:.4} rad{past} has other forces (for it: {})",
                taken.theta[0], named(1.0), other.theta[0], named(-1.0)
            )
        });
        taken.warnings.extend(doubt);
        Taken {
            angles: taken,
            sense,
            leaves: leaves.filter(|_| odds < 0.0),
            likelihood,
        }
    }
}
