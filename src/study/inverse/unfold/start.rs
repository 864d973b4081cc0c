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
    let tracks = smoothest(tracks);
    let angle = ByAngle::of(&tracks, start.angle, blur)?;
    let speed = BySpeed::of(times, &tracks, start.speed);
    let (taken, reason) = match (start.angle != 0.0, start.speed != 0.0) {
        (true, false) => (angle.nearest, BY_NEARER_ANGLE),
        (true, true) if angle.is_plain() => (angle.nearest, BY_ANGLE),
        (true, true) if angle.is_told() && !speed.is_told_plainly() => {
            (angle.nearest, BY_NEARER_ANGLE)
        }
        (_, true) => (speed.first, BY_SPEED),
        (false, false) => (speed.first, BY_NOTHING),
    };
    let unsure = match reason {
        BY_SPEED => speed.leaves_open(&angle, tracks[taken].beginning),
        BY_NEARER_ANGLE => angle.is_blurred(),
        _ => false,
    };
    let several = tracks.iter().any(|track| !track.is_like(&tracks[taken]));
    Some(Start {
        reason: several.then_some(reason),
        contradicted: start.speed != 0.0 && angle.is_plain() && !speed.agrees(angle.nearest),
        unsure: tracks.len() > 1 && unsure,
        track: tracks.into_iter().nth(taken)?,
    })
}

/// The motions that are about as smooth as the smoothest one, which is the first of them.
fn smoothest(tracks: Vec<Track>) -> Vec<Track> {
    let rough = |track: Track| (roughness(&track.theta), track);
    let mut tracks: Vec<(f64, Track)> = tracks.into_iter().map(rough).collect();
    tracks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let least = tracks.first().map_or(0.0, |(rough, _)| *rough);
    tracks.retain(|(rough, _)| *rough <= ALIKE * least + 1e-6);
    tracks.into_iter().map(|(_, track)| track).collect()
}

/// What the angle of the scene tells.
#[derive(Clone, Copy, Debug)]
struct ByAngle {
    /// The motion that begins nearest to it.
    nearest: usize,
    /// How far from it that one begins, and the next one, rad.
    off: f64,
    next: f64,
    /// By how much noise may move a beginning, rad.
    blur: f64,
}

impl ByAngle {
    fn of(tracks: &[Track], angle: f64, blur: f64) -> Option<ByAngle> {
        let off = |track: &Track| (in_turn(track.theta[0], angle) - angle).abs();
        let mut by_angle: Vec<(f64, usize)> = tracks.iter().map(off).zip(0..).collect();
        by_angle.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (off, nearest) = *by_angle.first()?;
        let next = by_angle.get(1).map_or(f64::INFINITY, |(off, _)| *off);
        Some(ByAngle {
            nearest,
            off,
            next,
            blur,
        })
    }

    fn is_near(&self) -> bool {
        self.off <= NEAR
    }

    fn next_is_farther(&self, blur: f64) -> bool {
        self.next > FARTHER * (self.off + EXACT + blur)
    }

    /// Whether the angle is plainly that of one motion.
    fn is_plain(&self) -> bool {
        self.is_near() && self.next_is_farther(self.blur)
    }

    /// Whether the motions begin so near to each other that noise hides which one begins at the angle.
    fn is_blurred(&self) -> bool {
        self.next - self.off < BLURRED * self.blur
    }

    /// Whether the angle tells the motions apart.
    fn is_told(&self) -> bool {
        self.is_near() && !self.is_blurred()
    }
}

/// What the speed of the scene tells.
#[derive(Debug)]
struct BySpeed {
    /// rad/s
    speed: f64,
    /// How the motions begin.
    firsts: Vec<First>,
    /// The smoothest motion that begins with the sense of the speed.
    first: usize,
    /// Whether it is the only one.
    is_only: bool,
}

impl BySpeed {
    fn of(times: &[f64], tracks: &[Track], speed: f64) -> BySpeed {
        let firsts = tracks.iter().map(|track| First::of(times, track, speed));
        let mut found = BySpeed {
            speed,
            firsts: firsts.collect(),
            first: 0,
            is_only: false,
        };
        let agreeing: Vec<usize> = (0..tracks.len()).filter(|i| found.agrees(*i)).collect();
        if let Some(first) = agreeing.first() {
            found.first = *first;
            found.is_only = agreeing.iter().all(|i| tracks[*i].is_like(&tracks[*first]));
        }
        found
    }

    /// Whether a motion begins with the sense of the speed.
    fn agrees(&self, track: usize) -> bool {
        let sign = if self.speed < 0.0 { -1.0 } else { 1.0 };
        sign * self.firsts[track].motion >= 0.0
    }

    /// Whether one motion alone begins with the sense of the speed, which is more than the samples leave open.
    fn is_told_plainly(&self) -> bool {
        self.is_only && !self.firsts.iter().any(|first| first.hides_speed)
    }

    /// Whether the motion taken by the speed may be another one, for all that is known of how it begins.
    fn leaves_open(&self, angle: &ByAngle, beginning: Option<Beginning>) -> bool {
        let is_nearest = self.first == angle.nearest;
        if is_nearest && angle.is_told() {
            return false;
        }
        let is_known = beginning.is_some_and(|beginning| beginning.is_known());
        let opposed = !is_nearest && angle.is_near() && angle.next_is_farther(0.0);
        let either_way = |beginning: Beginning| beginning.is_either_way(self.speed);
        !self.is_only || opposed && !is_known || beginning.is_some_and(either_way)
    }
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
    fn of(times: &[f64], track: &Track, speed: f64) -> First {
        if let Some(beginning) = track.beginning.filter(Beginning::is_known) {
            return First {
                motion: beginning.speed,
                hides_speed: beginning.hides(speed),
            };
        }
        let (motion, time) = first_motion(times, &track.theta);
        let hides = |beginning: Beginning| beginning.hides(speed);
        First {
            motion,
            hides_speed: speed.abs() * time < SLOW * motion.abs()
                || track.beginning.is_some_and(hides),
        }
    }
}

/// Where a motion goes first, rad: by more than noise, or by a good part of all; and the time until then, s.
fn first_motion(times: &[f64], theta: &[f64]) -> (f64, f64) {
    let early = theta.len().min(EARLY);
    let noise = noise(&times[..early], &theta[..early]);
    let off = || theta.iter().map(|angle| angle - theta[0]);
    let most = off().fold(0.0f64, |most, off| most.max(off.abs()));
    let plain = (LITTLE + NOISE * noise).min(0.25 * most);
    let first = off().zip(times).find(|(off, _)| off.abs() > plain);
    first.map_or((0.0, 0.0), |(off, time)| (off, time - times[0]))
}
