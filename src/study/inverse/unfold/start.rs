//! Which of several motions that fit the samples alike begins like the scene.

use super::noise::noise;
use super::track::{Track, in_turn};
use crate::scene::Motion;

/// The motion that is taken.
#[derive(Debug)]
pub(super) struct Start {
    pub track: Track,
    /// How it was chosen.
    pub reason: &'static str,
    /// Whether angle and speed of the scene belong to different motions.
    pub contradicted: bool,
    /// Whether neither is known of the motion well enough to tell it from its mirror image.
    pub unsure: bool,
}

/// The scene's angle belongs to a motion that begins this near to it, rad...
const NEAR: f64 = 0.1;

/// ... if each other one begins beyond this many times as far from it, or as an angle is meant that is given exactly, rad.
const FARTHER: f64 = 4.0;
const EXACT: f64 = 0.02;

/// Sums of squares within this factor do not decide: the mirror image of a smooth motion is smooth as well, if less so
/// where the direction of the wrist pin from the pivot changes fast.
const ALIKE: f64 = 1e4;

/// A motion that is one without any noise, rad.
const LITTLE: f64 = 1e-3;

/// Samples that tell the noise of the first ones, and how many times that is motion.
const EARLY: usize = 100;
const NOISE: f64 = 10.0;

const BY_ANGLE: &str = "the one that begins at the scene's angle is taken";
const BY_NEARER_ANGLE: &str = "the one that begins nearer to the scene's angle is taken";
const BY_SPEED: &str = "the one that begins with the sense of the scene's speed is taken";
const BY_NOTHING: &str =
    "the one that begins counter-clockwise is taken, as the scene has neither speed nor angle";

/// Chooses among motions, whose first angle is right to `blur`, rad.
///
/// A motion may begin slowly and reverse at once, so an angle of the scene that is plainly that of one motion counts
/// before the speed. Angle 0 does not, because scenes that say nothing have it.
pub(super) fn choose(
    times: &[f64],
    tracks: Vec<Track>,
    start: &Motion,
    blur: f64,
) -> Option<Start> {
    let mut tracks: Vec<(f64, Track)> = tracks
        .into_iter()
        .map(|track| (roughness(&track.theta), track))
        .collect();
    tracks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let least = tracks.first()?.0;
    tracks.retain(|(rough, _)| *rough <= ALIKE * least + 1e-6);
    let off = |i: usize| (in_turn(tracks[i].1.theta[0], start.angle) - start.angle).abs();
    let mut by_angle: Vec<usize> = (0..tracks.len()).collect();
    by_angle.sort_by(|a, b| off(*a).total_cmp(&off(*b)));
    let nearest = by_angle[0];
    let next = by_angle.get(1).map_or(f64::INFINITY, |i| off(*i));
    let plain = off(nearest) <= NEAR && next > FARTHER * (off(nearest) + EXACT + blur);
    let sign = if start.speed < 0.0 { -1.0 } else { 1.0 };
    // Next to a fold the motion may begin on either stroke, unseen.
    let unseen = if next - off(nearest) < 2.0 * blur {
        2.0 * blur
    } else {
        0.0
    };
    let first = tracks.iter().map(|(_, track)| match track.beginning {
        Some(beginning) if beginning.is_known() => beginning.speed,
        _ => first_motion(times, &track.theta, unseen),
    });
    let first: Vec<f64> = first.collect();
    let agrees = |i: &usize| sign * first[*i] >= 0.0;
    let by_speed = (0..tracks.len()).find(agrees).unwrap_or(0);
    let (taken, reason) = match (start.angle != 0.0, start.speed != 0.0) {
        (true, false) => (nearest, BY_NEARER_ANGLE),
        (true, true) if plain => (nearest, BY_ANGLE),
        (_, true) => (by_speed, BY_SPEED),
        (false, false) => (by_speed, BY_NOTHING),
    };
    let beginning = tracks[taken].1.beginning;
    let unsure = match reason {
        BY_SPEED => beginning.is_some_and(|beginning| beginning.is_either_way(start.speed)),
        BY_NEARER_ANGLE => next - off(nearest) < 2.0 * blur,
        _ => false,
    };
    let contradicted = start.speed != 0.0 && plain && !agrees(&nearest);
    let (_, track) = tracks.swap_remove(taken);
    Some(Start {
        track,
        reason,
        contradicted,
        unsure,
    })
}

/// Parts of a motion for its roughness.
const PARTS: usize = 200;

/// Sum of the squared third differences of a motion.
fn roughness(theta: &[f64]) -> f64 {
    let step = (theta.len() / PARTS).max(1);
    let parts: Vec<f64> = theta.iter().step_by(step).copied().collect();
    let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).powi(2);
    parts.windows(4).map(third).sum()
}

/// Where the motion goes first: by more than noise and what is `unseen`, or by a good part of all.
fn first_motion(times: &[f64], theta: &[f64], unseen: f64) -> f64 {
    let early = theta.len().min(EARLY);
    let noise = noise(&times[..early], &theta[..early]);
    let off = || theta.iter().map(|angle| angle - theta[0]);
    let most = off().fold(0.0f64, |most, off| most.max(off.abs()));
    let plain = (LITTLE + NOISE * noise + unseen).min(0.25 * most);
    off().find(|off| off.abs() > plain).unwrap_or(0.0)
}
