//! Which of several motions that fit the samples alike begins like the scene.

use super::beginning::Beginning;
use super::noise::noise;
use super::track::{Track, in_turn};
use crate::scene::Motion;

/// The motion that is taken.
#[derive(Debug)]
pub(super) struct Start {
    pub track: Track,
    /// How it was chosen, if there was a choice.
    pub reason: Option<&'static str>,
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

/// Motions that begin less than so many blurs apart may be on either stroke: twice, and rounding.
const BLURRED: f64 = 2.02;

/// Sums of squares within this factor do not decide: the mirror image of a smooth motion is smooth as well, if less so
/// where the direction of the wrist pin from the pivot changes fast.
const ALIKE: f64 = 1e4;

/// A motion that is one without any noise, rad.
const LITTLE: f64 = 1e-3;

/// Samples that tell the noise of the first ones, and how many times that is motion.
const EARLY: usize = 100;
const NOISE: f64 = 10.0;

/// Part of the speed of the first motion that is as good as rest.
const SLOW: f64 = 0.01;

const BY_ANGLE: &str = "the one that begins at the scene's angle is taken";
const BY_NEARER_ANGLE: &str = "the one that begins nearer to the scene's angle is taken";
const BY_SPEED: &str = "the one that begins with the sense of the scene's speed is taken";
const BY_NOTHING: &str = "the one that begins counter-clockwise is taken, but which one it is cannot be told, as the scene has neither speed nor angle";

/// Chooses among motions, whose first angle is right to `blur`, rad.
///
/// A motion may begin slowly and reverse at once, so an angle of the scene that is plainly that of one motion counts
/// before the speed, and one that tells them apart before a speed that the samples do not tell from rest. Angle 0 does not,
/// because scenes that say nothing have it.
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
    let tracks: Vec<Track> = tracks.into_iter().map(|(_, track)| track).collect();
    let off = |i: usize| (in_turn(tracks[i].theta[0], start.angle) - start.angle).abs();
    let mut by_angle: Vec<usize> = (0..tracks.len()).collect();
    by_angle.sort_by(|a, b| off(*a).total_cmp(&off(*b)));
    let nearest = by_angle[0];
    let next = by_angle.get(1).map_or(f64::INFINITY, |i| off(*i));
    let farther_than = |blur: f64| next > FARTHER * (off(nearest) + EXACT + blur);
    let near = off(nearest) <= NEAR;
    let plain = near && farther_than(blur);
    let blurred = next - off(nearest) < BLURRED * blur;
    let sign = if start.speed < 0.0 { -1.0 } else { 1.0 };
    // Next to a fold the motion may begin on either stroke, unseen.
    let unseen = if blurred { BLURRED * blur } else { 0.0 };
    let first = |track: &Track| First::of(times, track, start.speed, unseen);
    let firsts: Vec<First> = tracks.iter().map(first).collect();
    let agrees = |i: &usize| sign * firsts[*i].motion >= 0.0;
    let agreeing: Vec<usize> = (0..tracks.len()).filter(agrees).collect();
    let by_speed = agreeing.first().copied().unwrap_or(0);
    // A speed tells what one motion alone begins with.
    let is_other = |i: &usize| !tracks[*i].is_like(&tracks[by_speed]);
    let told = !agreeing.is_empty() && !agreeing.iter().any(is_other);
    let hidden = firsts.iter().any(|first| first.hides_speed);
    let (taken, reason) = match (start.angle != 0.0, start.speed != 0.0) {
        (true, false) => (nearest, BY_NEARER_ANGLE),
        (true, true) if plain => (nearest, BY_ANGLE),
        (true, true) if near && !blurred && (hidden || !told) => (nearest, BY_NEARER_ANGLE),
        (_, true) => (by_speed, BY_SPEED),
        (false, false) => (by_speed, BY_NOTHING),
    };
    let by_both = near && !blurred && taken == nearest;
    let is_unsure = |beginning: Beginning| beginning.is_either_way(start.speed);
    let known = |beginning: Beginning| beginning.is_known();
    let beginning = tracks[taken].beginning;
    let disputed = taken != nearest && near && farther_than(0.0) && !beginning.is_some_and(known);
    let unsure = match reason {
        BY_SPEED => !by_both && (!told || disputed || beginning.is_some_and(is_unsure)),
        BY_NEARER_ANGLE => blurred,
        _ => false,
    };
    let several = tracks.iter().any(|track| !track.is_like(&tracks[taken]));
    Some(Start {
        reason: several.then_some(reason),
        contradicted: start.speed != 0.0 && plain && !agrees(&nearest),
        unsure: tracks.len() > 1 && unsure,
        track: tracks.into_iter().nth(taken)?,
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

/// How a motion begins.
#[derive(Clone, Copy, Debug)]
struct First {
    /// Its speed, rad/s, or where it goes, rad.
    motion: f64,
    /// Whether the speed of the scene is nothing against that, for all that the samples tell.
    hides_speed: bool,
}

impl First {
    fn of(times: &[f64], track: &Track, speed: f64, unseen: f64) -> First {
        if let Some(beginning) = track.beginning.filter(Beginning::is_known) {
            return First {
                motion: beginning.speed,
                hides_speed: beginning.hides(speed),
            };
        }
        let (motion, time) = first_motion(times, &track.theta, unseen);
        let hides = |beginning: Beginning| beginning.hides(speed);
        First {
            motion,
            hides_speed: speed.abs() * time < SLOW * motion.abs()
                || track.beginning.is_some_and(hides),
        }
    }
}

/// Where a motion goes first, rad: by more than noise and what is `unseen`, or by a good part of all; and the time until then, s.
fn first_motion(times: &[f64], theta: &[f64], unseen: f64) -> (f64, f64) {
    let early = theta.len().min(EARLY);
    let noise = noise(&times[..early], &theta[..early]);
    let off = || theta.iter().map(|angle| angle - theta[0]);
    let most = off().fold(0.0f64, |most, off| most.max(off.abs()));
    let plain = (LITTLE + NOISE * noise + unseen).min(0.25 * most);
    let first = off().zip(times).find(|(off, _)| off.abs() > plain);
    first.map_or((0.0, 0.0), |(off, time)| (off, time - times[0]))
}
